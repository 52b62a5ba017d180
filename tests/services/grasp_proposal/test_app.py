from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import orjson
import pytest

from services.grasp_proposal.app import create_app
from services.grasp_proposal.settings import GraspProposalSettings
from shared.schemas.grasp import ProposeResponse
from shared.wire import JSON, NPZ, decode, encode
from tests.services.grasp_proposal.scenes import box
from tests.support.serving import Client, in_process

BAR = box((0.025, 0.15, 0.008))


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with in_process(create_app(GraspProposalSettings(max_grasps=7))) as served:
        yield served


@pytest.mark.parametrize("media_type", [JSON, NPZ])
def test_propose(client: Client, media_type: str) -> None:
    response = client.request(
        "POST",
        "/propose",
        content=encode(BAR.request(samples=60), media_type),
        headers={"Content-Type": media_type, "Accept": media_type},
    )
    assert response.status_code == 200
    answer = decode(ProposeResponse, response.content, media_type, 10**7)
    assert 0 < len(answer.grasps) <= 7
    assert answer.grasps.dtype == np.float64


def test_grippers(client: Client) -> None:
    listed = client.request("GET", "/grippers").json()["grippers"]
    assert {"panda", "tiago"} <= {gripper["name"] for gripper in listed}


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ({"points": [[0, 0, 0]] * 20, "gripper": "claw"}, "unknown_gripper"),
        ({"points": [[0, 0, 0]]}, "empty_cloud"),
        ({"points": [[0, 0]]}, "invalid_input"),
        ({"points": [[0, 0, 0]] * 20, "samples": 0}, "invalid_input"),
        ({"points": [[0, 0, 0]] * 20, "focus": [True]}, "invalid_input"),
    ],
)
def test_errors_are_envelopes(client: Client, body: dict[str, object], code: str) -> None:
    response = client.request(
        "POST", "/propose", content=orjson.dumps(body), headers={"Content-Type": JSON}
    )
    assert response.status_code == 422
    assert response.json()["error"]["code"] == code
