"""The drawing of docs/frames.md is drawn, and its table is that of the gripper files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from experiments.frames.__main__ import draw
from experiments.frames.hand import Hand
from experiments.frames.table import offsets
from shared.grippers import load_grippers
from shared.schemas.gripper import ParallelGripper
from shared.settings import PROJECT_ROOT


def test_it_is_drawn(tmp_path: Path) -> None:
    draw(tmp_path / "frames.png", dpi=40)
    drawn = np.asarray(Image.open(tmp_path / "frames.png").convert("L"))
    assert 0.02 < (drawn < 250).mean() < 0.5


def test_the_page_holds_the_table() -> None:
    assert offsets() in (PROJECT_ROOT / "docs" / "frames.md").read_text(encoding="utf-8")


def test_the_page_of_a_hand() -> None:
    """+z down the page: +y to the right."""
    panda = load_grippers()["panda"]
    assert isinstance(panda, ParallelGripper)
    hand = Hand(panda, 0.05, tcp=(1.0, 2.0))
    np.testing.assert_allclose(hand.place([[0.1, 0.0], [0.0, 0.1]]), [[1.1, 2.0], [1.0, 1.9]])
    assert hand.base == pytest.approx(-0.1034)
