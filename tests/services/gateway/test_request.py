"""Three kinds of body and three places for parameters make the same request."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest

from services.gateway.request import GraspRequest, from_form, from_json, from_npz
from shared.errors import InvalidInput, MalformedRequest, SpargeError
from shared.wire.files import read_cloud_file
from shared.wire.npz import write_npz

LIMIT = 10**7
CLOUD = np.array([[0.0, 0.0, 1.0], [0.1, 0.0, 1.0], [0.0, 0.1, 1.1]])
RECOVERY = (
    '{"outlier_ratio": 0.9, "max_iterations": 20, "tolerance": 0.001, "relative_tolerance": 0.5,'
    ' "max_switches": 3, "adaptive_upper_bound": true, "eps": 0.02, "min_points": 80}'
)
QUERY = {
    "task": "pouring",
    "viewpoint": "[0, 0, 0.5]",
    "seed": "3",
    "explain": "false",
    "recovery": RECOVERY,
}


def xyz(points: np.ndarray) -> bytes:
    stream = io.StringIO()
    np.savetxt(stream, points)
    return stream.getvalue().encode()


def test_all_bodies_agree() -> None:
    by_json = from_json(
        b'{"points": [[0,0,1],[0.1,0,1],[0,0.1,1.1]], "task": "pouring", "seed": 3,'
        b' "viewpoint": [0, 0, 0.5], "explain": false, "recovery": ' + RECOVERY.encode() + b"}",
        {},
    )
    by_npz = from_npz(write_npz({"points": CLOUD}), QUERY, LIMIT)
    by_form = from_form("cloud.xyz", xyz(CLOUD), QUERY, {}, read_cloud_file)
    assert by_json == by_npz
    assert by_json == by_form
    assert list(by_json.parameters.viewpoint) == [0, 0, 0.5]
    assert list(by_json.view.viewpoint) == [0, 0, 0.5]
    assert not by_json.parameters.explain
    recovery = by_json.parameters.recovery
    assert recovery is not None
    assert recovery.model_dump_json() == RECOVERY.replace(" ", "")


def test_defaults_are_the_contracts() -> None:
    parameters = from_npz(write_npz({"points": CLOUD}), {"task": "pouring"}, LIMIT).parameters
    assert parameters.model_dump() == {
        "task": "pouring",
        "reasoning": "v2",
        "rule_set": None,
        "input": "scene",
        "viewpoint": (0, 0, 0),
        "target": None,
        "gripper": "panda",
        "max_grasps": 10,
        "seed": 0,
        "method": None,
        "recovery": None,
        "explain": True,
        "rehearsal": None,
        "rejected": 0,
        "frame_id": "camera",
        "format": "sparge",
        "pose_of": None,
        "stamp": None,
    }


def test_the_query_wins_over_the_body() -> None:
    request = from_json(b'{"points": [[0,0,1]], "task": "pouring"}', {"task": "cutting"})
    assert request.parameters.task == "cutting"


def test_a_depth_image_with_its_scale_and_other_arrays() -> None:
    arrays: dict[str, Any] = {
        "depth": np.full((4, 5), 900, dtype=np.uint16),
        "intrinsics": np.diag([600.0, 600.0, 1.0]),
        "depth_scale": np.float64(1e-3),
        "colors": np.zeros((4, 5, 3), dtype=np.uint8),
        "label": np.zeros((4, 5), dtype=np.uint8),
    }
    view = from_npz(write_npz(arrays), {"task": "pouring"}, LIMIT).view
    assert view.depth is not None
    assert view.depth.dtype == np.uint16
    assert view.depth_scale == 1e-3


@pytest.mark.parametrize(
    ("query", "told"),
    [
        ({}, "task: Field required"),
        ({"task": ""}, "task"),
        ({"task": "x" * 65}, "task"),
        ({"task": "pouring", "reasoning": "v3"}, "reasoning"),
        ({"task": "pouring", "max_grasps": "101"}, "max_grasps"),
        ({"task": "pouring", "max_grasps": "many"}, "max_grasps"),
        ({"task": "pouring", "seed": "-1"}, "seed"),
        ({"task": "pouring", "viewpoint": "[0, 0]"}, "viewpoint"),
        ({"task": "pouring", "target": "[0, 0, null]"}, "target"),
        ({"task": "pouring", "resoning": "v1"}, "resoning"),
        ({"task": "pouring", "input": "room"}, "input"),
        ({"task": "pouring", "recovery": "[1]"}, "recovery"),
        ({"task": "pouring", "recovery": '{"eps": 0.02}'}, "recovery.max_switches: Field required"),
        ({"task": "pouring", "recovery": RECOVERY.replace("0.9", "1.0")}, "outlier_ratio"),
        ({"task": "pouring", "recovery": RECOVERY.replace("eps", "epsilon")}, "recovery.epsilon"),
        ({"task": "pouring", "method": "sq"}, "method"),
        ({"task": "pouring", "method": "parts", "recovery": RECOVERY}, "method is parts"),
    ],
)
def test_bad_parameters_are_named(query: dict[str, str], told: str) -> None:
    with pytest.raises(InvalidInput, match=told):
        from_npz(write_npz({"points": CLOUD}), query, LIMIT)


@pytest.mark.parametrize(("name", "text"), [("viewpoint", "0 0 0"), ("recovery", "eps=0.02")])
def test_a_value_that_is_not_json(name: str, text: str) -> None:
    with pytest.raises(MalformedRequest, match=f"{name} must be JSON"):
        from_npz(write_npz({"points": CLOUD}), {"task": "a", name: text}, LIMIT)


@pytest.mark.parametrize(
    "arrays",
    [
        {},
        {"points": CLOUD, "depth": np.zeros((2, 2))},
        {"points": CLOUD[:, :2]},
        {"points": CLOUD.astype(complex)},
        {"points": np.array(["a", "b", "c"])},
        {"depth": np.zeros((2, 2), dtype=np.uint16)},
        {"depth": np.zeros((2, 2), dtype=np.uint16), "intrinsics": np.eye(3)},
        {"depth": np.zeros((2, 2)), "intrinsics": np.zeros((3, 3))},
        {"depth": np.zeros((2, 2)), "intrinsics": np.eye(3), "depth_scale": np.zeros(2)},
        {"depth": np.zeros((2, 2, 3)), "intrinsics": np.eye(3)},
    ],
)
def test_bad_arrays_are_invalid(arrays: dict[str, np.ndarray]) -> None:
    with pytest.raises(SpargeError) as caught:
        from_npz(write_npz(arrays), {"task": "pouring"}, LIMIT)
    assert caught.value.status == 422


def test_requests_compare_by_content() -> None:
    one = from_npz(write_npz({"points": CLOUD}), {"task": "pouring"}, LIMIT)
    other = from_npz(write_npz({"points": CLOUD + 1e-6}), {"task": "pouring"}, LIMIT)
    assert isinstance(one, GraspRequest)
    assert one != other
