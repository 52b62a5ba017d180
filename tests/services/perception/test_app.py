"""The service answers over HTTP as the stage does."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from services.perception.app import create_app
from services.perception.perceive import Perception
from services.perception.settings import PerceptionSettings
from shared.schemas.scene import PERCEIVE, PerceiveRequest
from shared.wire import JSON, NPZ, decode, encode
from tests.services.perception.scenes import small_view
from tests.support.serving import Client, in_process


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with in_process(create_app(PerceptionSettings(max_points=100_000))) as served:
        yield served


@pytest.mark.parametrize("media_type", [JSON, NPZ])
def test_the_answer_is_the_stages(client: Client, media_type: str) -> None:
    request = small_view().request()
    response = client.request(
        "POST",
        PERCEIVE.path,
        content=encode(request, media_type),
        headers={"Content-Type": media_type, "Accept": media_type},
    )
    assert response.status_code == 200
    answer = decode(PERCEIVE.response, response.content, media_type, 10**8)
    assert answer == Perception().perceive(request)


@pytest.mark.parametrize(
    ("points", "status", "code"),
    [
        (np.full((50, 3), np.nan), 422, "empty_cloud"),
        (np.ones((50, 3)), 422, "degenerate_cloud"),
        (np.random.default_rng(0).random((50, 3)) * 1e3, 422, "wrong_units"),
        (np.zeros((100_001, 3)), 413, "too_large"),
    ],
)
def test_errors_keep_their_code(client: Client, points: np.ndarray, status: int, code: str) -> None:
    response = client.request(
        "POST",
        PERCEIVE.path,
        content=encode(PerceiveRequest(points=points), NPZ),
        headers={"Content-Type": NPZ},
    )
    assert response.status_code == status
    assert response.json()["error"]["code"] == code
    assert client.request("GET", "/health/ready").status_code == 200
