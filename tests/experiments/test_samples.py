"""The bundled views are what the generator makes, and what the gateway can read."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.samples.views import FOLDER, SAMPLES, make_view
from shared.schemas.scene import View
from shared.wire.files import read_cloud_file
from shared.wire.npz import read_npz

MAX_UNPACKED = 2**22
MAX_FILE_BYTES = 150_000


@pytest.mark.parametrize("name", ["hammer"])
def test_a_view_is_made_again_from_its_recipe(name: str) -> None:
    """Ray casting may differ in the last bit from one processor to the next, not more."""
    view, truth = make_view(SAMPLES[name])
    bundled = read_npz((FOLDER / f"{name}.npz").read_bytes(), MAX_UNPACKED)
    labels = read_npz((FOLDER / f"{name}.labels.npz").read_bytes(), MAX_UNPACKED)
    assert bundled.keys() == view.keys()
    assert labels.keys() == truth.keys()
    assert (bundled["depth"] == view["depth"]).mean() > 0.999
    assert (labels["label"] == truth["label"]).mean() > 0.999
    for key in ("intrinsics", "depth_scale"):
        np.testing.assert_array_equal(bundled[key], view[key])
    np.testing.assert_array_equal(labels["tasks"], truth["tasks"])
    np.testing.assert_allclose(labels["camera_from_object"], truth["camera_from_object"])


def test_the_same_recipe_makes_the_same_view() -> None:
    one, other = make_view(SAMPLES["bottle"]), make_view(SAMPLES["bottle"])
    for first, second in zip(one, other, strict=True):
        for key, value in first.items():
            np.testing.assert_array_equal(value, second[key])


def test_nothing_else_is_bundled() -> None:
    expected = {f"{name}{suffix}" for name in SAMPLES for suffix in (".npz", ".labels.npz")}
    assert {path.name for path in FOLDER.glob("*.npz")} == expected


@pytest.mark.parametrize("name", SAMPLES)
def test_views_are_small_and_readable(name: str) -> None:
    data = (FOLDER / f"{name}.npz").read_bytes()
    assert len(data) < MAX_FILE_BYTES
    view = View(**read_cloud_file(f"{name}.npz", data).fields())
    assert view.depth is not None
    assert view.depth.dtype == np.uint16
    assert view.depth.shape == (480, 640)


@pytest.mark.parametrize("name", SAMPLES)
def test_every_task_has_points_to_hold(name: str) -> None:
    depth = read_npz((FOLDER / f"{name}.npz").read_bytes(), MAX_UNPACKED)["depth"]
    truth = read_npz((FOLDER / f"{name}.labels.npz").read_bytes(), MAX_UNPACKED)
    for index, task in enumerate(truth["tasks"]):
        assert (truth["label"] == 2 + index).sum() > 300, task
    assert not truth["label"][depth == 0].any()
