"""The examples of docs/ros2.md, run against a stand-in for ROS and the real backend."""

from __future__ import annotations

import array
import base64
import importlib.util
import sys
from collections.abc import Iterator
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from fastapi import FastAPI, Request, Response
from starlette.concurrency import run_in_threadpool

from shared.client import Sparge
from shared.settings import PROJECT_ROOT
from tests.support import ros
from tests.support.asking import cup
from tests.support.ros_clouds import cloud_message
from tests.support.ros_messages import require_message
from tests.support.serving import Client, serving

EXAMPLES = PROJECT_ROOT / "docs" / "examples"
CUP = np.array(cup())


@pytest.fixture(scope="module")
def table() -> np.ndarray:
    """A table that the cup stands on: the camera looks down along +z, 0.7 m above it."""
    x, y = np.meshgrid(np.linspace(-0.25, 0.25, 80), np.linspace(-0.25, 0.25, 80))
    flat = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 0.7)])
    around, height = np.meshgrid(np.linspace(0, 2 * np.pi, 60), np.linspace(0.60, 0.70, 30))
    side = [0.03 * np.cos(around), 0.03 * np.sin(around), height]
    disc = np.random.default_rng(1).uniform(-0.03, 0.03, (600, 2))
    disc = disc[np.hypot(*disc.T) < 0.03]
    top = np.column_stack([disc, np.full(len(disc), 0.60)])
    return np.vstack([flat, np.stack(side, -1).reshape(-1, 3), top])


@pytest.fixture
def example(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    for name, module in ros.modules().items():
        monkeypatch.setitem(sys.modules, name, module)
    return loaded("sparge_node")


def loaded(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def node(example: ModuleType, backend: Client) -> Any:
    return example.SpargeNode(Sparge(backend.request))


def cloud(example: ModuleType, points: np.ndarray, **layout: Any) -> Any:
    """Return the message that a driver would publish."""
    said = cloud_message(points, **layout)
    field = sys.modules["sensor_msgs.msg"].PointField
    message = example.PointCloud2(
        fields=[field(**each) for each in said["fields"]],
        data=array.array("B", base64.b64decode(said["data"])),
        **{name: said[name] for name in ("height", "width", "point_step", "row_step")},
        **{name: said[name] for name in ("is_bigendian", "is_dense")},
    )
    message.header.frame_id = "camera_optical"
    message.header.stamp.sec = 12
    return message


def call(example: ModuleType, node: Any) -> Any:
    return node.callbacks["~/grasp"](example.Trigger.Request(), example.Trigger.Response())


def test_it_answers_with_poses_in_the_frame_of_the_cloud(
    example: ModuleType, node: Any, table: np.ndarray, backend: Client
) -> None:
    seen = cloud(example, table)
    node.callbacks["points"](seen)
    answer = call(example, node)
    assert answer.success, answer.message
    assert "handover" in answer.message
    (published,) = node.published["~/grasps"]
    assert published.header is seen.header
    asked = {"points": table.astype(np.float32).tolist(), "task": "handover"}
    expected = backend.request("POST", "/grasp", json=asked).json()["grasps"]
    assert len(published.poses) == len(expected) > 0
    for pose, grasp in zip(published.poses, expected, strict=True):
        found = [pose.position.x, pose.position.y, pose.position.z]
        np.testing.assert_allclose(found, grasp["pose"]["position"], atol=1e-9)
        turn = pose.orientation
        assert np.linalg.norm([turn.x, turn.y, turn.z, turn.w]) == pytest.approx(1)
    (before,) = node.published["~/pregrasp"]
    assert before.pose.position.z == pytest.approx(expected[0]["pregrasp"]["position"][2])


def test_it_says_why_there_is_nothing(example: ModuleType, node: Any, table: np.ndarray) -> None:
    early = call(example, node)
    assert (early.success, early.message) == (False, "no cloud has come in yet")
    node.callbacks["points"](cloud(example, table))
    node.parameters["task"] = "juggling"  # as `ros2 param set` does
    unknown = call(example, node)
    assert not unknown.success
    assert unknown.message.startswith("unknown_task")
    assert node.logged == [unknown.message]
    node.parameters["task"] = "hammering"
    unfit = call(example, node)
    assert not unfit.success
    assert ": " in unfit.message
    assert node.published["~/grasps"][-1].poses == []
    assert node.published["~/pregrasp"] == []


@pytest.mark.parametrize("layout", [{}, {"big_endian": True}, {"height": 20, "padding": 5}])
def test_points_of_every_layout(example: ModuleType, layout: dict[str, Any]) -> None:
    found = example.points_of(cloud(example, CUP, **layout))
    np.testing.assert_array_equal(found, CUP.astype(np.float32))


@pytest.fixture
def url(backend: Client) -> Iterator[str]:
    """The same backend, over a socket."""
    app = FastAPI()

    @app.post("/grasp")
    async def passed_on(request: Request) -> Response:
        body = await request.body()
        query, headers = dict(request.query_params), {"Content-Type": "application/json"}
        found = await run_in_threadpool(
            backend.request, "POST", "/grasp", params=query, content=body, headers=headers
        )
        return Response(found.content, found.status_code, media_type="application/json")

    with serving(app) as served:
        yield served


def test_without_the_client(example: ModuleType, node: Any, table: np.ndarray, url: str) -> None:
    ask = loaded("ask_sparge").ask_sparge
    seen = cloud(example, table, height=2, padding=3)
    found = ask(seen, "handover", url)
    require_message("geometry_msgs/PoseArray", {name: found[name] for name in ("header", "poses")})
    assert found["header"] == {"stamp": {"sec": 12, "nanosec": 0}, "frame_id": "camera_optical"}
    node.callbacks["points"](seen)
    call(example, node)
    (published,) = node.published["~/grasps"]
    assert len(found["poses"]) == len(published.poses) > 0
    for pose, other in zip(found["poses"], published.poses, strict=True):
        assert pose["position"]["x"] == pytest.approx(other.position.x)
    of_hand = ask(seen, "handover", url, pose_of="panda_hand", max_grasps=1)
    assert of_hand["pose_of"] == "panda_hand"
    with pytest.raises(RuntimeError, match="no task 'juggling'"):
        ask(seen, "juggling", url)


def test_main_spins_and_stops(example: ModuleType) -> None:
    example.main()


def test_the_stand_in_refuses_what_ros_would(example: ModuleType) -> None:
    pose = example.Pose()
    with pytest.raises(AssertionError, match="must be of type float"):
        pose.position.x = 1
    with pytest.raises(AssertionError, match="no field"):
        pose.place = 1.0
    with pytest.raises(AssertionError, match="must be a"):
        example.PoseArray().poses = [pose.position]
