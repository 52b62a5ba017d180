"""The service over HTTP: every route, in JSON and npz, and its errors."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import orjson
import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

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


RULE = {
    "name": "by_ratio",
    "task": "slicing",
    "part": "handle",
    "conditions": [
        {"condition": "min_ratio", "of": ["handle"], "value": 2},
        {"condition": "different", "of": ["handle", "blade"]},
    ],
}
junk = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(-(2**70), 2**70),
        st.floats(allow_nan=False, allow_infinity=False),
        st.text(max_size=12),
        st.sampled_from(["halt", "handle", "min_ratio", "shape", "cuboid", "grasp", "_", "'"]),
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=6), inner, max_size=3)
    ),
    max_leaves=8,
)


@hypothesis_settings(
    max_examples=150,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(data=st.data())
def test_whatever_is_sent_is_taken_or_refused(client: Client, data: st.DataObject) -> None:
    """A sound rule with one thing in it replaced: never an error of ours, and nothing is left."""
    body = orjson.loads(orjson.dumps(RULE))
    inside = data.draw(st.sampled_from([body, body["conditions"][0], body["conditions"][1]]))
    inside[data.draw(st.sampled_from([*inside, "task", "affordance", "prolog"]))] = data.draw(junk)
    try:
        content = orjson.dumps(body)
    except orjson.JSONEncodeError:  # an integer beyond 64 bits, a lone surrogate
        return
    response = client.request("POST", "/rules", content=content, headers={"Content-Type": JSON})
    assert response.status_code in (200, 409, 422), response.text
    if response.status_code == 200:
        gone = client.request("DELETE", f"/rules/{response.json()['name']}")
        assert gone.json() == response.json()
    else:
        assert response.json()["error"]["message"]
    assert client.request("GET", "/rules").json()["rules"] == []
