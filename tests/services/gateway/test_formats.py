"""`?format=` and PointCloud2 bodies over HTTP: the same grasps in other words."""

from __future__ import annotations

import json
from typing import Any, get_args

import numpy as np
import pytest

from services.gateway.formats.graspnet import grasps_from_graspnet
from shared.schemas.formats import Format
from shared.wire.npz import read_npz, write_npz
from tests.services.gateway.test_grasp import BOTTLE, arrays, bottle_points, timeless
from tests.support.asking import cup
from tests.support.ros_clouds import cloud_message
from tests.support.ros_messages import require_message
from tests.support.serving import Client

NPZ = "application/x-npz"
CUP = np.array(cup())
STAMP = '{"sec": 12, "nanosec": 34}'


def ask(
    backend: Client, accept: str = "application/json", body: bytes = BOTTLE, /, **query: str
) -> Any:
    return backend.request(
        "POST",
        "/grasp",
        params={"task": "pouring", **query},
        content=body,
        headers={"Content-Type": NPZ, "Accept": accept},
    )


def answer(backend: Client, **query: str) -> dict[str, Any]:
    response = ask(backend, **query)
    assert response.status_code == 200, response.text
    found: dict[str, Any] = response.json()
    return found


def test_the_default_is_the_answer_as_ever(backend: Client) -> None:
    plain = answer(backend)
    assert timeless(answer(backend, format="sparge")) == timeless(plain)
    assert "pose_of" not in plain
    assert "format" not in plain


def test_moveit_gives_its_message_and_says_of_which_link(backend: Client) -> None:
    plain = answer(backend)
    for query, link in (({}, "panda_link8"), ({"pose_of": "panda_hand"}, "panda_hand")):
        found = answer(backend, format="moveit", stamp=STAMP, frame_id="cam", **query)
        assert found["pose_of"] == link
        assert len(found["grasps"]) == len(plain["grasps"])
        for number, (grasp, ours) in enumerate(zip(found["grasps"], plain["grasps"], strict=True)):
            require_message("moveit_msgs/Grasp", grasp)
            assert grasp["id"] == f"pouring_{number}"
            header = {"stamp": {"sec": 12, "nanosec": 34}, "frame_id": "cam"}
            assert grasp["grasp_pose"]["header"] == header
            assert grasp["grasp_quality"] == ours["score"]
            position = list(grasp["grasp_pose"]["pose"]["position"].values())
            behind = np.subtract(ours["pose"]["position"], position)
            approach = list(grasp["pre_grasp_approach"]["direction"]["vector"].values())
            np.testing.assert_allclose(behind, 0.1034 * np.array(approach), atol=1e-9)
            pregrasp = np.subtract(ours["pose"]["position"], ours["pregrasp"]["position"])
            np.testing.assert_allclose(pregrasp, 0.1 * np.array(approach), atol=1e-9)


def test_pose_array_gives_the_poses(backend: Client) -> None:
    plain = answer(backend)
    found = answer(backend, format="pose_array", stamp=STAMP)
    require_message("geometry_msgs/PoseArray", {k: found[k] for k in ("header", "poses")})
    assert found["header"] == {"stamp": {"sec": 12, "nanosec": 34}, "frame_id": "camera"}
    assert found["pose_of"] == "tcp"
    for name, values in (("score", found["scores"]), ("width", found["widths"])):
        assert values == [grasp[name] for grasp in plain["grasps"]]
    for pose, grasp in zip(found["poses"], plain["grasps"], strict=True):
        assert list(pose["position"].values()) == grasp["pose"]["position"]
        assert list(pose["orientation"].values()) == grasp["pose"]["quaternion"]
    assert answer(backend, format="pose_array")["header"]["stamp"] == {"sec": 0, "nanosec": 0}


def test_graspnet_as_json_and_npz(backend: Client) -> None:
    plain = arrays(backend)
    rows = np.array(answer(backend, format="graspnet")["grasps"])
    assert rows.shape == (len(plain["grasps"]), 17)
    np.testing.assert_allclose(grasps_from_graspnet(rows), plain["grasps"], atol=1e-12)
    held = read_npz(ask(backend, NPZ, format="graspnet").content, 10**8)
    np.testing.assert_array_equal(held["grasps"], rows)
    np.testing.assert_array_equal(held["point_region"], plain["point_region"])
    report = json.loads(held["report"].tobytes())
    assert report["columns"][:4] == ["score", "width", "height", "depth"]


def test_an_archive_holds_the_poses_of_its_report(backend: Client) -> None:
    held = read_npz(ask(backend, NPZ, format="pose_array", pose_of="panda_hand").content, 10**8)
    report = json.loads(held["report"].tobytes())
    for row, pose in zip(held["grasps"], report["poses"], strict=True):
        assert list(pose["position"].values()) == row[:3].tolist()


@pytest.mark.parametrize("name", ["moveit", "graspnet", "pose_array"])
def test_an_empty_answer_says_why(backend: Client, name: str) -> None:
    found = answer(backend, format=name, task="turning", reasoning="v1")
    assert found["found"] is False
    assert found["reason"]["code"] == "no_part_matches"
    assert found["poses" if name == "pose_array" else "grasps"] == []
    only_region = answer(backend, format=name, max_grasps="0")
    assert only_region["reason"]["code"] == "no_grasps_requested"


@pytest.mark.parametrize(
    ("query", "told"),
    [
        ({"format": "MoveIt"}, ["format", *get_args(Format)]),
        ({"format": "moveit", "pose_of": "panda_link7"}, ["panda_link8", "panda_hand", "tcp"]),
        ({"format": "moveit", "pose_of": "tool 0"}, ["pose_of"]),
        ({"format": "graspnet", "pose_of": "panda_hand"}, ["format=moveit"]),
        ({"pose_of": "panda_hand"}, ["format=moveit"]),
        ({"format": "graspnet", "gripper": "onrobot_vgc10"}, ["suction", "moveit"]),
        ({"stamp": '{"sec": 1, "nanosec": -1}'}, ["stamp.nanosec"]),
    ],
)
def test_what_does_not_go_together_is_told(
    backend: Client, query: dict[str, str], told: list[str]
) -> None:
    response = ask(backend, **query)
    assert (response.status_code, response.json()["error"]["code"]) == (422, "invalid_input")
    for word in told:
        assert word in response.json()["error"]["message"]


def test_a_stamp_that_is_no_json(backend: Client) -> None:
    error = ask(backend, stamp="12.5s").json()["error"]
    assert error["code"] == "malformed"
    assert '"nanosec"' in error["message"]


def post(backend: Client, message: dict[str, Any], accept: str = "application/json") -> Any:
    return backend.request("POST", "/grasp", json=message, headers={"Accept": accept})


def test_a_point_cloud2_is_answered_like_its_points(backend: Client) -> None:
    question = {"task": "handover", "input": "object"}
    points = {"points": CUP.astype(np.float32).tolist(), "frame_id": "camera_optical", **question}
    plain = post(backend, points)
    assert plain.status_code == 200, plain.text
    for layout in ({}, {"big_endian": True}, {"height": 20, "padding": 3, "as_list": True}):
        found = post(backend, {**cloud_message(CUP, **layout), **question})
        assert found.status_code == 200, found.text
        assert timeless(found.json()) == timeless(plain.json())


def test_frame_and_time_are_those_of_the_cloud(backend: Client) -> None:
    message = {**cloud_message(CUP), "task": "handover", "input": "object", "format": "pose_array"}
    header = post(backend, message).json()["header"]
    assert header == message["header"]
    overridden = post(backend, {**message, "frame_id": "map", "stamp": {"sec": 1}}).json()["header"]
    assert overridden == {"stamp": {"sec": 1, "nanosec": 0}, "frame_id": "map"}
    nameless = post(backend, {**message, "header": {"frame_id": ""}}).json()["header"]
    assert nameless == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "camera"}


def test_the_arrays_speak_about_every_point_of_an_organised_cloud(backend: Client) -> None:
    """Rows with padding, no return where the camera saw none: row-major, nothing left out."""
    seen = bottle_points().reshape(480, 640, 3)[::2, ::2].reshape(-1, 3).astype(np.float32)
    seen[::7] = np.nan
    message = {**cloud_message(seen, height=240, padding=8), "task": "pouring"}
    response = post(backend, message, NPZ)
    assert response.status_code == 200, response.text
    held = read_npz(response.content, 10**8)
    by_points = ask(backend, NPZ, write_npz({"points": seen}))
    expected = read_npz(by_points.content, 10**8)
    assert held["point_primitive"].shape == (240 * 320,)
    for name in ("point_primitive", "point_region", "grasps"):
        np.testing.assert_array_equal(held[name], expected[name])
    assert held["point_region"].any()
    assert not held["point_region"][::7].any()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"row_step": 1}, "row_step is 1"),
        ({"height": 3}, "data holds"),
        ({"fields": []}, "x, y, z"),
        ({"points": [[0, 0, 1]]}, "points as well"),
        ({"datta": 1}, "datta"),
    ],
)
def test_a_cloud_that_is_not_sound_is_told(
    backend: Client, change: dict[str, Any], told: str
) -> None:
    response = post(backend, {**cloud_message(CUP), "task": "handover", **change})
    assert (response.status_code, response.json()["error"]["code"]) == (422, "invalid_input")
    assert told in response.json()["error"]["message"]
