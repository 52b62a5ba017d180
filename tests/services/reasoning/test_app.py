"""The service over HTTP: every route, in JSON and npz, and its errors."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import orjson
import pytest

from services.reasoning.app import create_app
from services.reasoning.settings import ReasoningSettings
from shared.schemas.task import DecideRequest, DecideResponse
from shared.wire import JSON, NPZ, decode, encode
from tests.services.reasoning.objects import PAN
from tests.support.serving import Client, in_process

COOKING = {"task": "cooking", "primitives": []}
STIRRING = {"name": "stirring", "requires": ["grasp"], "grasp": ["grasp"]}


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    settings = ReasoningSettings(knowledge_dir=tmp_path_factory.mktemp("knowledge"))
    with in_process(create_app(settings)) as served:
        yield served


def error_of(client: Client, method: str, path: str, body: Any = None) -> tuple[int, Any]:
    content = None if body is None else orjson.dumps(body)
    response = client.request(method, path, content=content, headers={"Content-Type": JSON})
    return response.status_code, response.json()["error"]


@pytest.mark.parametrize("media_type", [JSON, NPZ])
def test_decide(client: Client, media_type: str) -> None:
    request = DecideRequest(task="cooking", primitives=PAN, rule_set="thesis")
    response = client.request(
        "POST",
        "/decide",
        content=encode(request, media_type),
        headers={"Content-Type": media_type, "Accept": media_type},
    )
    assert response.status_code == 200
    answer = decode(DecideResponse, response.content, media_type, 10**6)
    assert answer.region is not None
    assert answer.region.primitive_ids == (1,)


def test_the_life_of_a_task(client: Client) -> None:
    added = client.request("POST", "/tasks", json=STIRRING)
    assert added.status_code == 200
    assert added.json() in client.request("GET", "/tasks").json()["tasks"]
    status, error = error_of(client, "POST", "/tasks", STIRRING)
    assert (status, error["code"]) == (409, "conflict")
    assert client.request("DELETE", "/tasks/stirring").json() == added.json()
    status, error = error_of(client, "DELETE", "/tasks/stirring")
    assert (status, error["code"]) == (404, "not_found")
    status, error = error_of(client, "DELETE", "/tasks/cooking")
    assert (status, error["code"]) == (409, "conflict")


def test_affordances(client: Client) -> None:
    listed = client.request("GET", "/affordances").json()["affordances"]
    assert "wrap_grasp" in [each["name"] for each in listed]


@pytest.mark.parametrize(
    ("path", "body", "status", "code"),
    [
        ("/decide", {"task": "dancing", "primitives": []}, 422, "unknown_task"),
        ("/decide", {"task": "", "primitives": []}, 422, "invalid_input"),
        ("/decide", {"task": " ", "primitives": []}, 422, "invalid_input"),
        ("/decide", {"task": "cooking"}, 422, "invalid_input"),
        ("/decide", {**COOKING, "rule_set": "../x"}, 422, "invalid_input"),
        ("/decide", {**COOKING, "reasoning": "v3"}, 422, "invalid_input"),
        ("/decide", {"task": 7, "primitives": []}, 422, "invalid_input"),
        ("/tasks", {**STIRRING, "name": "Stirring"}, 422, "invalid_input"),
        ("/tasks", {**STIRRING, "name": "../../etc/x"}, 422, "invalid_input"),
        ("/tasks", {**STIRRING, "grasp": ["fly"]}, 422, "invalid_input"),
        ("/tasks", {"name": "stirring"}, 422, "invalid_input"),
    ],
)
def test_bad_input(client: Client, path: str, body: Any, status: int, code: str) -> None:
    found, error = error_of(client, "POST", path, body)
    assert (found, error["code"]) == (status, code)
    assert error["message"]


def test_unusable_rules_keep_the_service_from_getting_ready(tmp_path: Path) -> None:
    (tmp_path / "knowledge.journal").write_text("nonsense\n")
    settings = ReasoningSettings(knowledge_dir=tmp_path)
    with pytest.raises(Exception, match="not a journal"), in_process(create_app(settings)):
        pass
