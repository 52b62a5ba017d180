"""The pictures of the documentation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from experiments.catalogue import build
from experiments.pictures.margins import bars
from experiments.pictures.pixels import coloured, cut_out
from experiments.pictures.small import figure, save_figure
from experiments.pictures.tiles import CAPTION, SIZE, save_tiles
from shared.client import Sparge
from shared.schemas.task import Condition, RuleTrace
from tests.support.serving import Client


def size_of(path: Path) -> tuple[int, int]:
    with Image.open(path) as picture:
        return picture.size


def condition(predicate: str, part: int, measured: str, required: str, margin: float) -> Condition:
    return Condition(
        predicate=predicate,
        primitive_id=part,
        holds=margin >= 0,
        measured=measured,
        required=required,
        margin=margin,
        unit="m",
    )


def test_a_bar_says_on_which_side_of_its_bound_a_condition_is() -> None:
    trace = RuleTrace(
        rule="default/version2:pound",
        holds=False,
        bindings={"ID": 0, "ID_handle": 1},
        conditions=(
            condition("at_most(thickness(ID), 0.06)", 1, "0.03 m", "<= 0.06 m", 0.03),
            condition("at_least(length(ID)/width(ID), 1.4)", 0, "0.7", ">= 1.4", -0.7),
            condition("at_most(width(ID)/across(Tool), 2)", 1, "8", "<= 2", -6.0),
            condition("ID \\= Tool", 1, "part 1, part 0", "two different parts", 0.0),
        ),
    )
    found = bars(trace)
    assert [each.label for each in found] == [
        "thickness(part 1)",
        "length(part 0) / width(part 0)",
        "width(part 1) / across(part 0)",
    ]
    assert [each.ratio for each in found] == pytest.approx([2.0, 0.5, 0.25])
    assert found[0].says == "30 mm, required <= 60 mm"


def test_the_object_is_cut_out_of_its_image() -> None:
    mask = np.zeros((48, 64), dtype=bool)
    mask[10:14, 50:62] = True
    rows, columns = cut_out(mask)
    assert mask[rows, columns].sum() == mask.sum()
    assert rows.stop - rows.start == columns.stop - columns.start
    depth = np.where(mask, 0.8, 1.0)
    picture = coloured(depth, 60.0, mask, np.ones((48, 64, 3)), 32)
    assert picture.shape == (32, 32, 4)
    assert picture.min() >= 0
    assert picture.max() <= 1


def test_a_figure_is_written_as_a_small_picture(tmp_path: Path) -> None:
    drawn = figure(200, 100)
    assert save_figure(drawn, tmp_path / "new" / "a.webp") < 2_000
    assert size_of(tmp_path / "new" / "a.webp") == (200, 100)


def test_a_strip_of_the_gallery_is_what_the_backend_answers(
    backend: Client, tmp_path: Path
) -> None:
    thing = build("bottle1")
    size, ious = save_tiles(thing, Sparge(backend.request), tmp_path)
    assert len(ious) == len(thing.tasks) == 2
    assert min(ious) > 0.7
    assert size_of(tmp_path / "bottle1.webp") == (SIZE * 3, SIZE + CAPTION)
    assert size == (tmp_path / "bottle1.webp").stat().st_size
