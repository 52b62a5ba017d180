"""The contract of every route of every stage, in this process and over a socket."""

from __future__ import annotations

from typing import Any

import pytest

from shared.schemas.route import Route
from shared.wire import JSON, NPZ, Message, encode
from tests.contract.conftest import LISTED, POSTED, TRANSPORTS, Stages

Examples = dict[Route[Any, Any], Message]

every_transport = pytest.mark.parametrize("transport", TRANSPORTS)
every_route = pytest.mark.parametrize("route", [*POSTED, *LISTED], ids=lambda route: route.path)
posted_routes = pytest.mark.parametrize("route", POSTED, ids=lambda route: route.path)


@every_transport
@every_route
def test_json_and_npz_give_the_same_answer_every_time(
    stages: Stages, examples: Examples, route: Route[Any, Any], transport: str
) -> None:
    first = stages.ask(route, examples[route], transport=transport, media_type=NPZ)
    again = stages.ask(route, examples[route], transport=transport, media_type=JSON)
    assert isinstance(first, route.response)
    assert first == again


@every_transport
@posted_routes
@pytest.mark.parametrize(
    ("body", "media_type", "status", "code"),
    [
        (b"", JSON, 400, "malformed"),
        (b"{", JSON, 400, "malformed"),
        (b"[]", JSON, 400, "malformed"),
        (b"PK\x03\x04 no archive", NPZ, 400, "malformed"),
        (b"{}", JSON, 422, "invalid_input"),
        (b'{"no_such_field": 1}', JSON, 422, "invalid_input"),
        (b"a,b", "text/csv", 415, "unsupported_media_type"),
    ],
)
def test_bad_bodies_get_the_envelope(
    stages: Stages,
    route: Route[Any, Any],
    transport: str,
    body: bytes,
    media_type: str,
    status: int,
    code: str,
) -> None:
    client = stages.start(route.service, transport)
    response = client.request(
        "POST", route.path, content=body, headers={"Content-Type": media_type}
    )
    assert response.status_code == status, response.text
    error = response.json()["error"]
    assert error["code"] == code
    assert error["message"]
    assert error["request_id"] == response.headers["x-request-id"]


@posted_routes
def test_a_truncated_archive_is_malformed(
    stages: Stages, examples: Examples, route: Route[Any, Any]
) -> None:
    body = encode(examples[route], NPZ)
    response = stages.start(route.service, "in_process").request(
        "POST", route.path, content=body[: len(body) // 2], headers={"Content-Type": NPZ}
    )
    assert response.status_code == 400
    assert response.json()["error"]["code"] == "malformed"


@pytest.mark.parametrize("service", sorted({route.service for route in POSTED}))
def test_operations_endpoints(stages: Stages, service: str) -> None:
    client = stages.start(service, "in_process")
    assert client.request("GET", "/health/live").json() == {
        "status": "alive",
        "service": service,
        "details": {},
    }
    assert client.request("GET", "/health/ready").json()["status"] == "ready"
    assert client.request("GET", "/version").json()["service"] == service
    assert "sparge_requests_total" in client.request("GET", "/metrics").text
    assert client.request("GET", "/docs").status_code == 200
