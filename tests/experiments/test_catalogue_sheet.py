"""The contact sheet, and the table in docs/catalogue.md."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from experiments.catalogue import CATALOGUE, build
from experiments.catalogue.listing import object_table, refusal_table
from experiments.contact_sheet.shading import photograph, viewing_rotation
from experiments.contact_sheet.sheet import (
    HANDOVER_COLOUR,
    TASK_COLOUR,
    contact_sheet,
    part_colours,
)

DOCS = Path(__file__).parents[2] / "docs"


def test_a_photograph_shows_the_whole_object() -> None:
    picture = photograph(build("pan2"), part_colours(build("pan2")), 80)
    assert picture.shape == (80, 80, 4)
    seen = picture[..., 3] > 0
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    assert not seen[[0, -1]].any()
    assert not seen[:, [0, -1]].any()
    assert max(np.ptp(rows), np.ptp(columns)) > 68
    assert picture.min() >= 0
    assert picture.max() <= 1


def test_colours_tell_what_is_held() -> None:
    handle, blade = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
    knife = build("knife1")
    assert [part.name for part in knife.parts] == ["blade", "handle"]
    assert part_colours(knife) == [HANDOVER_COLOUR, TASK_COLOUR]
    picture = photograph(knife, [tuple(blade), tuple(handle)], 60)[..., :3]
    assert (picture[..., 0] > picture[..., 2]).sum() > 50
    assert (picture[..., 2] > picture[..., 0]).sum() > 50


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_view_is_a_rotation(name: str) -> None:
    turn = viewing_rotation(build(name))
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1)


def test_the_sheet_is_a_png_of_its_tiles_and_the_same_every_time() -> None:
    things = [build(name) for name in ("mug1", "scissors1", "can1")]
    one, other = (contact_sheet(things, columns=2, tile=60) for _ in range(2))
    assert one == other
    image = Image.open(BytesIO(one))
    assert image.width == 120
    assert image.height > 120


def test_the_tables_in_the_docs_are_the_catalogue() -> None:
    page = (DOCS / "catalogue.md").read_text(encoding="utf-8")
    assert object_table() in page
    assert refusal_table() in page
    assert (DOCS / "images" / "catalogue.png").stat().st_size < 1_500_000
