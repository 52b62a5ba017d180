"""What may be given as a view, and as parameters."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike

from services.gateway.request import GraspParameters as Served
from shared.client import GraspParameters
from shared.client.question import grasp
from shared.client.view import arrays_of
from shared.errors import InvalidInput
from shared.wire.npz import read_npz
from tests.support.samples import sample_path

POINTS = np.arange(12.0).reshape(4, 3)
DEPTH = np.ones((4, 3), dtype=np.uint16)
K = np.diag([500.0, 500.0, 1.0])


def test_the_typed_parameters_are_those_that_the_backend_takes() -> None:
    beside_a_file = {"intrinsics", "depth_scale"}
    of_other_tools = {"format", "pose_of", "stamp"}  # the client reads the answer as it is
    assert set(GraspParameters.__annotations__) - beside_a_file == (
        set(Served.model_fields) - {"task"} - of_other_tools
    )


def test_an_array_of_points() -> None:
    assert list(arrays_of(POINTS, None, None)) == ["points"]
    assert list(arrays_of(POINTS.tolist(), None, None)) == ["points"]


def test_a_depth_image_is_what_has_intrinsics() -> None:
    held = arrays_of(DEPTH, K, 0.001)
    assert held["depth"] is DEPTH
    assert held["depth_scale"] == 0.001


def test_a_mapping_is_taken_as_it_is() -> None:
    view: dict[str, ArrayLike] = {"depth": DEPTH, "intrinsics": K, "depth_scale": 0.001}
    assert arrays_of(view, None, None) == view


@pytest.mark.parametrize(
    "view", [np.ones((480, 640)), np.ones(3), np.ones((2, 3, 3)), "mug.ply", [[1, 2], [3]], [None]]
)
def test_what_is_no_view(view: Any) -> None:
    with pytest.raises(InvalidInput, match="view"):
        arrays_of(view, None, None)


def test_arrays_and_parameters_go_different_ways() -> None:
    asked = grasp(DEPTH, "pouring", {"intrinsics": K, "depth_scale": 0.001, "seed": 3})
    assert set(read_npz(asked.body["content"], 10**6)) == {"depth", "intrinsics", "depth_scale"}
    assert asked.body["params"] == {"task": "pouring", "seed": "3"}


def test_a_path_is_a_file() -> None:
    path: Path = sample_path("bottle")
    asked = grasp(path, "pouring", {"depth_scale": 0.5})
    assert asked.body["files"]["file"] == ("bottle.npz", path.read_bytes())
    assert asked.body["data"] == {"task": "pouring", "depth_scale": "0.5"}
