from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import orjson
import pytest

from services.matching.app import create_app
from services.matching.settings import MatchingSettings
from shared.schemas.grasp import RegionRequest, RegionResponse, SelectRequest, SelectResponse
from shared.wire import JSON, NPZ, decode, encode
from tests.services.matching.clouds import HEAD, as_primitive, surface_points
from tests.support.serving import Client, in_process


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with in_process(create_app(MatchingSettings())) as served:
        yield served


@pytest.mark.parametrize("media_type", [JSON, NPZ])
def test_both_routes(client: Client, media_type: str) -> None:
    headers = {"Content-Type": media_type, "Accept": media_type}
    points = surface_points(HEAD)
    region = client.request(
        "POST",
        "/region",
        content=encode(
            RegionRequest(points=points, primitives=(as_primitive(0, HEAD),), primitive_ids=(0,)),
            media_type,
        ),
        headers=headers,
    )
    found = decode(RegionResponse, region.content, media_type, 10**7)
    assert found.point_region.all()
    grasp = np.array([[*points[5], 0, 0, 0, 1, 0.02, 0.4]])
    selected = client.request(
        "POST",
        "/select",
        content=encode(
            SelectRequest(points=points, point_region=found.point_region, grasps=grasp), media_type
        ),
        headers=headers,
    )
    assert np.array_equal(decode(SelectResponse, selected.content, media_type, 10**7).grasps, grasp)


def test_an_error_is_an_envelope(client: Client) -> None:
    body = {"points": [[0, 0, 0]], "primitives": [], "primitive_ids": [3]}
    response = client.request(
        "POST", "/region", content=orjson.dumps(body), headers={"Content-Type": JSON}
    )
    assert response.status_code == 422
    assert response.json()["error"]["details"]["found"] == [3]
