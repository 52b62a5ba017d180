"""What a call becomes over HTTP, and what cannot be asked."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest

from services.gateway.request import GraspParameters, _typed
from services.grpc import request
from services.grpc.generated import sparge_pb2 as pb
from shared.errors import InvalidInput
from shared.schemas.execution import ExecuteRequest
from shared.schemas.primitive import PRESETS
from shared.wire import JSON, NPZ, decode
from shared.wire.npz import read_npz
from tests.services.grpc.test_messages import OF_HTTP
from tests.support.grpc_as_http import execute_request

BODY = [1, 1, 0.03, 0.03, 0.05, 0, 0, 0.6, 0, 0, 0, 1]
ROWS = np.arange(12.0).reshape(4, 3)


def test_what_is_not_set_is_left_to_the_gateway() -> None:
    asked = request.grasp(pb.GraspRequest(task="pouring"))
    assert (asked.params, asked.content, asked.accept) == ({"task": "pouring"}, b"{}", JSON)
    assert request.grasp(pb.GraspRequest()).params == {}


def test_every_parameter_arrives_as_it_was_set() -> None:
    message = pb.GraspRequest(
        task="pouring",
        reasoning=pb.REASONING_V1,
        rule_set=pb.RULE_SET_THESIS,
        input=pb.INPUT_OBJECT,
        viewpoint=pb.Vector3(x=0.1, y=-2, z=3e-7),
        target=pb.Vector3(x=1, y=2, z=1 / 3),
        gripper="tiago",
        max_grasps=0,
        seed=2**32 - 1,
        method=pb.METHOD_EMS,
        recovery=pb.EmsParameters(**PRESETS["simulation"].model_dump()),
        explain=False,
        frame_id="map",
        rejected=7,
        rehearsal=pb.REHEARSING_ALWAYS,
    )
    read = GraspParameters.model_validate(_typed(request.grasp_parameters(message)))
    assert read == GraspParameters(
        task="pouring",
        reasoning="v1",
        rule_set="thesis",
        input="object",
        viewpoint=(0.1, -2, 3e-7),
        target=(1, 2, 1 / 3),
        gripper="tiago",
        max_grasps=0,
        seed=2**32 - 1,
        method="ems",
        recovery=PRESETS["simulation"],
        explain=False,
        frame_id="map",
        rejected=7,
        rehearsal="always",
    )
    mine = {each.name for each, _ in message.ListFields()} | {"explain", "max_grasps"}
    assert mine == GraspParameters.model_fields.keys() - OF_HTTP


@pytest.mark.parametrize("kind", ["float32", "float64"])
def test_points_stay_as_precise_as_they_were(kind: str) -> None:
    rows = ROWS.astype(np.dtype(kind).newbyteorder("<"))
    message = pb.GraspRequest(points=pb.PointCloud(**{kind: rows.tobytes()}), per_point=True)
    asked = request.grasp(message)
    assert (asked.content_type, asked.accept) == (NPZ, NPZ)
    held = read_npz(asked.content or b"", 10**6)["points"]
    assert held.dtype == rows.dtype
    np.testing.assert_array_equal(held, rows)


def test_a_depth_image_with_its_camera() -> None:
    pixels = np.arange(6, dtype="<u2").reshape(2, 3)
    image = pb.DepthImage(height=2, width=3, uint16=pixels.tobytes(), depth_scale=0.001)
    image.intrinsics.extend(np.eye(3).ravel())
    held = read_npz(request.grasp(pb.GraspRequest(depth=image)).content or b"", 10**6)
    np.testing.assert_array_equal(held["depth"], pixels)
    np.testing.assert_array_equal(held["intrinsics"], np.eye(3))
    assert held["depth_scale"] == 0.001


def test_a_file_travels_as_it_is() -> None:
    file = pb.CloudFile(name="scan.ply", content=b"ply", intrinsics=range(9), depth_scale=0.5)
    asked = request.grasp(pb.GraspRequest(task="pouring", file=file))
    assert asked.files == {"file": ("scan.ply", b"ply")}
    assert asked.params["depth_scale"] == "0.5"
    assert asked.params["intrinsics"].startswith("[[0.0, 1.0, 2.0]")


REFUSED: dict[str, tuple[Callable[[], pb.GraspRequest], str]] = {
    "rows that are cut off": (
        lambda: pb.GraspRequest(points=pb.PointCloud(float32=bytes(13))),
        "points.float32 has 13 bytes, allowed are whole rows of 12",
    ),
    "an image without pixels": (
        lambda: pb.GraspRequest(depth=pb.DepthImage(height=1, width=1)),
        "depth needs pixels",
    ),
    "half a pixel": (
        lambda: pb.GraspRequest(depth=pb.DepthImage(height=1, width=1, uint16=b"\0")),
        "depth.uint16 has 1 bytes",
    ),
    "an image of another size": (
        lambda: pb.GraspRequest(depth=pb.DepthImage(height=2**31, width=2**31, uint16=b"\0\0")),
        "depth.uint16 holds 1 pixels",
    ),
    "a matrix of another size": (
        lambda: pb.GraspRequest(
            depth=pb.DepthImage(height=1, width=1, uint16=b"\0\0", intrinsics=[1, 2])
        ),
        "depth.intrinsics has 2 entries, allowed are 9",
    ),
    "an enumeration's value from the future": (
        lambda: pb.GraspRequest(reasoning=9),  # type: ignore[arg-type]  # open enumerations
        r"reasoning is 9, allowed are v1 \(1\), v2 \(2\)",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_asked_is_told(name: str) -> None:
    make, told = REFUSED[name]
    with pytest.raises(InvalidInput, match=told) as caught:
        request.grasp(make())
    assert caught.value.details["field"]


def test_an_execution_arrives_whole() -> None:
    corners = np.array(list(itertools.product((0, 0.1), repeat=3)), dtype="<f8")
    faces = np.array([[0, 1, 2], [1, 2, 3]], dtype=np.int32)
    asked = execute_request(
        {
            "pose": {"position": [0, 0, 0.6], "quaternion": [0, 0, 0, 1]},
            "width": 0.05,
            "mass": 0.3,
            "primitives": [BODY],
            "plane": {"normal": [0, 0, 1], "offset": 0.5, "inliers": 7, "residual_mm": 0.5},
            "up": [0, 0, 1],
            "gripper": "robotiq_2f85",
            "actor": "hand",
            "strict": True,
            "brisk": True,
            "heading": [1, 0, -0.5],
            "viewpoint": [0, 0.1, 2],
            "believed": "reflected",
            "seed": 3,
            "animate": True,
            "motion": True,
        }
    )
    asked.vertices.float64 = corners.tobytes()
    asked.points.float64 = corners[:5].tobytes()
    asked.faces.indices.extend(faces.ravel())
    asked.object_pose.CopyFrom(asked.pose)
    asked.highlight.extend([True, False])
    assert {each.name for each, _ in asked.ListFields()} == set(ExecuteRequest.model_fields)
    read = decode(ExecuteRequest, request.execute(asked).content or b"", NPZ, 10**6)
    assert read == ExecuteRequest.model_validate(
        {
            "pose": {"position": [0, 0, 0.6], "quaternion": [0, 0, 0, 1]},
            "width": 0.05,
            "mass": 0.3,
            "primitives": [BODY],
            "points": corners[:5],
            "vertices": corners,
            "faces": faces,
            "object_pose": {"position": [0, 0, 0.6], "quaternion": [0, 0, 0, 1]},
            "plane": {"normal": [0, 0, 1], "offset": 0.5, "inliers": 7, "residual_mm": 0.5},
            "up": [0, 0, 1],
            "gripper": "robotiq_2f85",
            "actor": "hand",
            "strict": True,
            "brisk": True,
            "heading": [1, 0, -0.5],
            "viewpoint": [0, 0.1, 2],
            "believed": "reflected",
            "seed": 3,
            "animate": True,
            "motion": True,
            "highlight": [True, False],
        }
    )


def test_faces_are_rows_of_three() -> None:
    with pytest.raises(InvalidInput, match="whole rows of 3"):
        request.execute(pb.ExecuteRequest(faces=pb.Faces(indices=[0, 1])))
