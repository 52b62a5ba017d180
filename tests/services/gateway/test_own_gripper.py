"""A gripper of the user's own, by file: listed and asked for like any other."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.support.samples import sample_path
from tests.support.serving import Client, in_process

NARROW = """name = "my_hand"
description = "two long fingers"
max_opening = 0.10
finger_width = 0.015
finger_thickness = 0.010
finger_length = 0.070
tip_beyond_tcp = 0.010
palm_size = [0.05, 0.14, 0.08]
force = 40
"""
CUP = """kind = "suction"
name = "my_cup"
description = "a small bellows cup"
cup_diameter = 0.016
cup_length = 0.040
compliance = 0.003
palm_size = [0.04, 0.04, 0.10]
force = 10
"""


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    from services.wiring import create_app

    folder: Path = tmp_path_factory.mktemp("grippers")
    (folder / "my_hand.toml").write_text(NARROW)
    (folder / "my_cup.toml").write_text(CUP)
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("SPARGE_GRIPPERS_DIR", str(folder))
        knowledge = str(tmp_path_factory.mktemp("knowledge"))
        environment.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", knowledge)
        with in_process(create_app()) as served:
            yield served


@pytest.mark.parametrize("gripper", ["my_hand", "my_cup"])
def test_grasps_of_the_users_gripper(own: Client, gripper: str) -> None:
    listed = {each["name"] for each in own.request("GET", "/grippers").json()["grippers"]}
    assert {"my_hand", "my_cup", "panda"} <= listed
    response = own.request(
        "POST",
        "/grasp",
        params={"task": "pouring", "gripper": gripper},
        content=sample_path("bottle").read_bytes(),
        headers={"Content-Type": "application/x-npz"},
    )
    assert response.status_code == 200, response.text
    answer = response.json()
    assert answer["gripper"] == gripper
    assert answer["grasps"], answer["reason"]
    widths = np.array([grasp["width"] for grasp in answer["grasps"]])
    assert (widths == 0).all() if gripper == "my_cup" else ((widths > 0) & (widths < 0.1)).all()


def test_a_gripper_whose_links_nobody_wrote_down_has_poses_of_its_tcp_alone(own: Client) -> None:
    question = {"task": "pouring", "gripper": "my_hand", "format": "moveit"}
    body = sample_path("bottle").read_bytes()

    def ask(**more: str) -> Any:
        return own.request(
            "POST",
            "/grasp",
            params={**question, **more},
            content=body,
            headers={"Content-Type": "application/x-npz"},
        )

    refused = ask()
    assert refused.status_code == 422
    assert "pose_of=tcp" in refused.json()["error"]["message"]
    grasps = ask(pose_of="tcp").json()["grasps"]
    assert grasps
    assert grasps[0]["pre_grasp_posture"]["points"] == []
    assert ask(format="pose_array").json()["pose_of"] == "tcp"
    assert ask(format="graspnet").json()["grasps"]
