from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from services.execution.checks import MAX_FACES, check_request
from shared.errors import InvalidInput, PayloadTooLarge, SpargeError, UnknownGripper, WrongUnits
from shared.grippers import load_grippers
from shared.schemas.execution import ExecuteRequest
from shared.schemas.grasp import Pose
from tests.services.execution.scenes import STANDING_SUPERQUADRIC, box, from_above, request

BOX = box((0.02, 0.03, 0.04), (0.0, 0.0, 0.04))
DOWN = from_above()
GRIPPERS = load_grippers()


def checked(asked: ExecuteRequest) -> str:
    return check_request(asked, GRIPPERS).name


def replaced(**parameters: float) -> tuple[float, ...]:
    names = ("e1", "e2", "a1", "a2", "a3", "tx", "ty", "tz", "qx", "qy", "qz", "qw")
    changed = dict(zip(names, STANDING_SUPERQUADRIC, strict=True)) | parameters
    return tuple(changed.values())


def test_a_sensible_request_passes() -> None:
    checked(request((0, 0, 0.05), DOWN, BOX))
    checked(request((0, 0, 0.05), DOWN, primitives=(STANDING_SUPERQUADRIC,)))


@pytest.mark.parametrize(
    ("changes", "kind", "says"),
    [
        ({"gripper": "soft"}, UnknownGripper, "known are"),
        ({"gripper": "tiago", "actor": "arm"}, UnknownGripper, "only 'panda' has"),
        (
            {"object_pose": Pose(position=(0, 1e5, 0), quaternion=(0, 0, 0, 1))},
            InvalidInput,
            "object_pose.position",
        ),
        (
            {"pose": Pose(position=(1e5, 0, 0), quaternion=(0, 0, 0, 1))},
            InvalidInput,
            "pose.position",
        ),
        ({"vertices": BOX[0] * 1000}, WrongUnits, "millimetres"),
        ({"vertices": BOX[0] * 30}, InvalidInput, "2.4 m, allowed are 0.004..1.5"),
        ({"vertices": BOX[0] * 1e-3}, InvalidInput, "allowed are 0.004..1.5"),
        ({"vertices": BOX[0] * 1e308}, InvalidInput, "vertices"),
        ({"faces": np.zeros((MAX_FACES + 1, 3), dtype=np.int32)}, PayloadTooLarge, "simplify"),
    ],
)
def test_what_is_wrong_with_a_request(
    changes: dict[str, Any], kind: type[SpargeError], says: str
) -> None:
    with pytest.raises(kind, match=re.escape(says)):
        checked(request((0, 0, 0.05), DOWN, BOX, **changes))


@pytest.mark.parametrize(
    ("parameters", "says"),
    [
        ({"e1": 0.0}, "exponents"),
        ({"e2": 2.5}, "exponents"),
        ({"a2": 0.0}, "semi-axes"),
        ({"a1": -0.02}, "semi-axes"),
        ({"a3": 20.0}, "millimetres"),
        ({"a3": 1.0}, "span 2 m"),
        ({"qw": 0.0}, "length 0"),
        ({"tx": 1e9}, "coordinate"),
        ({"tx": 5.0}, "primitives span 5 m"),
    ],
)
def test_what_is_wrong_with_a_primitive(parameters: dict[str, float], says: str) -> None:
    primitives = (STANDING_SUPERQUADRIC, replaced(**parameters))
    with pytest.raises(InvalidInput, match=re.escape(says)):
        checked(request((0, 0, 0.05), DOWN, primitives=primitives))


def test_any_gripper_may_fly() -> None:
    asked = request((0, 0, 0.05), DOWN, BOX, gripper="tiago")
    assert checked(asked) == "tiago"
    assert checked(asked.model_copy(update={"actor": "hand"})) == "tiago"


def test_a_vertex_that_no_face_uses_does_not_count() -> None:
    vertices = np.vstack([BOX[0], [[500.0, 0.0, 0.0]]])
    checked(request((0, 0, 0.05), DOWN, (vertices, BOX[1])))
