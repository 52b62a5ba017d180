"""`sparge annotate` as far as it goes without Ray."""

from __future__ import annotations

import importlib.util
from collections import Counter
from pathlib import Path

import pytest
from typer.testing import CliRunner

from services.annotate.drive import Summary
from services.annotate.inputs import find_inputs, name_of
from services.cli.annotate import describe
from services.cli.main import app
from shared.errors import InvalidInput


def test_without_the_extra_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    done = CliRunner().invoke(
        app, ["annotate", str(tmp_path), "--task", "pouring", "--out", str(tmp_path / "out")]
    )
    assert done.exit_code == 1
    assert "pip install 'sparge[annotate]'" in " ".join(done.stderr.split())
    assert not (tmp_path / "out").exists()


def test_the_last_line() -> None:
    assert describe(Summary(3, 2, Counter(malformed=1, no_object=2), 4)) == (
        "12 questions, 5 answered (2 from before), 7 rejected (1 malformed, 2 no_object, "
        "4 from before)"
    )
    assert describe(Summary(annotated=2)) == "2 questions, 2 answered, 0 rejected"


def test_files_are_found_in_an_order_that_does_not_change(tmp_path: Path) -> None:
    for name in ("b.npz", "a/z.PLY", "a.xyz", "a/b/c.pcd", "a/.x.npz", ".git/y.npz", "note.txt"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    (tmp_path / "link").symlink_to(tmp_path / "a")
    (tmp_path / "broken.png").symlink_to(tmp_path / "nowhere")
    assert [name_of(path, tmp_path) for path in find_inputs(tmp_path)] == [
        "a/b/c.pcd",
        "a/z.PLY",
        "a.xyz",
        "b.npz",
        "broken.png",
    ]


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="cannot read"):
        find_inputs(tmp_path / "nowhere")
