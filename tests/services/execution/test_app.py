from __future__ import annotations

from collections.abc import Iterator

import orjson
import pytest

from services.execution.app import create_app
from services.execution.settings import ExecutionSettings
from shared.schemas.execution import ExecuteResponse
from shared.wire import JSON, NPZ, decode, encode
from tests.services.execution.scenes import (
    CAMERA_FROM_WORLD,
    STANDING_SUPERQUADRIC,
    box,
    cylinder,
    from_above,
    from_side,
    request,
)
from tests.support.serving import Client, in_process


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with in_process(create_app(ExecutionSettings())) as served:
        yield served


@pytest.mark.parametrize("media_type", [JSON, NPZ])
def test_a_mesh_over_the_wire(client: Client, media_type: str) -> None:
    asked = request((0, 0, 0.09), from_side(), cylinder(), seen_from=CAMERA_FROM_WORLD)
    response = client.request(
        "POST",
        "/execute",
        content=encode(asked, media_type),
        headers={"Content-Type": media_type, "Accept": media_type},
    )
    assert response.status_code == 200
    answer = decode(ExecuteResponse, response.content, media_type, 10**6)
    assert (answer.success, answer.outcome) == (True, "lifted")


def test_a_film_over_the_wire(client: Client) -> None:
    block = box((0.05, 0.05, 0.03), (0, 0, 0.03))
    asked = request((0, 0, 0.045), from_above(), block, width=0.03, animate=True)
    answers = []
    for media_type in (JSON, NPZ):
        response = client.request(
            "POST",
            "/execute",
            content=encode(asked, media_type),
            headers={"Content-Type": media_type, "Accept": media_type},
        )
        assert response.status_code == 200
        answers.append(decode(ExecuteResponse, response.content, media_type, 10**7))
    assert answers[0].animation is not None
    assert answers[0] == answers[1]


GOOD = orjson.loads(
    encode(request((0, 0, 0.1), from_side(), primitives=(STANDING_SUPERQUADRIC,)), JSON)
)
TRIANGLE = [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"gripper": "soft"}, "unknown_gripper"),
        ({"primitives": []}, "invalid_input"),
        ({"primitives": [[0.0] * 12]}, "invalid_input"),
        ({"vertices": [[0, 0, 0]], "faces": []}, "invalid_input"),
        (
            {"vertices": [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]], "faces": [[0, 1, 2]]},
            "degenerate_cloud",
        ),
        ({"up": None}, "invalid_input"),
        ({"width": -0.1}, "invalid_input"),
    ],
)
def test_bad_input_is_an_envelope(client: Client, change: dict[str, object], code: str) -> None:
    response = client.request(
        "POST", "/execute", content=orjson.dumps(GOOD | change), headers={"Content-Type": JSON}
    )
    assert response.status_code == 422
    assert response.json()["error"]["code"] == code
