"""The Open Inference Protocol over HTTP: the answers of POST /grasp, errors as V2 has them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from services.gateway.keys import Scope, add_key
from services.gateway.kserve.tensors import pack, pack_text
from tests.services.gateway.test_access import bearer, gateway
from tests.services.gateway.test_grasp import arrays, timeless
from tests.support.asking import cup
from tests.support.gateways import all_elsewhere
from tests.support.samples import sample_view
from tests.support.serving import Client, in_process

INFER = "/v2/models/sparge/infer"
LENGTH = "Inference-Header-Content-Length"
CUP = np.array(cup())


def tensor(name: str, datatype: str, array: Any, **more: Any) -> dict[str, Any]:
    held = np.asarray(array)
    data = {} if more else {"data": held.ravel().tolist()}
    return {"name": name, "datatype": datatype, "shape": list(held.shape), **data, **more}


def question(**changes: Any) -> dict[str, Any]:
    asked = {
        "id": "42",
        "parameters": {"task": "handover", "input": "object", "max_grasps": 3},
        "inputs": [tensor("points", "FP64", CUP)],
    }
    return {**asked, **changes}


def post(backend: Client, body: dict[str, Any] | bytes, **headers: str) -> Any:
    content = body if isinstance(body, bytes) else json.dumps(body).encode()
    return backend.request("POST", INFER, content=content, headers=headers)


def outputs(response: Any) -> dict[str, Any]:
    """Return the outputs as arrays, JSON or bytes; the test fails on any but 200."""
    assert response.status_code == 200, response.text
    length = int(response.headers.get(LENGTH, len(response.content)))
    said, behind = json.loads(response.content[:length]), response.content[length:]
    dtypes = {"FP64": "<f8", "INT16": "<i2", "BOOL": "?"}
    held: dict[str, Any] = {}
    for each in said["outputs"]:
        size = (each.get("parameters") or {}).get("binary_data_size")
        raw, behind = (None, behind) if size is None else (behind[:size], behind[size:])
        if each["datatype"] == "BYTES":
            held[each["name"]] = each["data"][0] if raw is None else raw[4:].decode()
            continue
        flat = each["data"] if raw is None else np.frombuffer(raw, dtypes[each["datatype"]])
        held[each["name"]] = np.array(flat).reshape(each["shape"])
    assert not behind
    return held


def test_json_tensors_give_what_post_grasp_gives(backend: Client) -> None:
    response = post(backend, question())
    found = outputs(response)
    assert response.json()["id"] == "42"
    assert response.json()["model_name"] == "sparge"
    body = {"points": CUP.tolist(), "task": "handover", "input": "object", "max_grasps": 3}
    plain = backend.request("POST", "/grasp", json=body).json()
    assert timeless(json.loads(found["report"])) == timeless(plain)
    assert found["grasps"].shape == (3, 9)
    assert [row[8] for row in found["grasps"]] == [grasp["score"] for grasp in plain["grasps"]]
    assert found["point_primitive"].shape == found["point_region"].shape == (len(CUP),)
    assert found["primitives"].tolist() == [each["parameters"] for each in plain["primitives"]]


def test_bytes_behind_the_json_give_the_same(backend: Client) -> None:
    view = sample_view("bottle")
    raw = {
        "depth": pack(view["depth"]),
        "intrinsics": pack(view["intrinsics"].astype(np.float64)),
        "task": pack_text(b"pouring"),
    }
    size = {name: {"parameters": {"binary_data_size": len(each)}} for name, each in raw.items()}
    header = json.dumps(
        {
            "parameters": {"binary_data_output": True},
            "inputs": [
                tensor("depth", "UINT16", view["depth"], **size["depth"]),
                tensor("intrinsics", "FP64", view["intrinsics"], **size["intrinsics"]),
                tensor("depth_scale", "FP64", [view["depth_scale"]]),
                tensor("task", "BYTES", [0], **size["task"]),
            ],
            "outputs": [
                *({"name": name} for name in ("point_region", "grasps", "point_primitive")),
                {"name": "report", "parameters": {"binary_data": False}},
            ],
        }
    ).encode()
    response = post(backend, header + b"".join(raw.values()), **{LENGTH: str(len(header))})
    assert response.headers["content-type"] == "application/octet-stream"
    found, plain = outputs(response), arrays(backend)
    assert list(found) == ["point_region", "grasps", "point_primitive", "report"]
    for name in ("point_region", "grasps", "point_primitive"):
        np.testing.assert_array_equal(found[name], plain[name])
        assert found[name].dtype == plain[name].dtype
    assert json.loads(found["report"])["task"] == "pouring"


def test_a_part_that_is_not_found_is_an_answer(backend: Client) -> None:
    parameters = {"task": "turning", "reasoning": "v1", "input": "object"}
    found = outputs(post(backend, question(parameters=parameters)))
    assert found["grasps"].shape == (0, 9)
    assert json.loads(found["report"])["found"] is False


@pytest.mark.parametrize(
    ("changes", "status", "code", "told"),
    [
        ({"parameters": {"task": "juggling", "input": "object"}}, 422, "unknown_task", "pouring"),
        ({"parameters": {}}, 422, "invalid_input", "task: Field required"),
        ({"parameters": {"task": "x", "griper": "y"}}, 422, "invalid_input", "griper"),
        ({"parameters": {"task": "x", "format": "moveit"}}, 422, "invalid_input", "tensors"),
        ({"parameters": {"task": "x", "viewpoint": "0"}}, 422, "invalid_input", "viewpoint"),
        ({"parameters": {"binary_data_output": 1}}, 422, "invalid_input", "true or false"),
        ({"inputs": []}, 422, "invalid_input", "inputs"),
        ({"inputs": [tensor("cloud", "FP32", CUP)]}, 422, "invalid_input", "points, depth"),
        ({"inputs": [tensor("points", "FP32", CUP)] * 2}, 422, "invalid_input", "twice"),
        ({"inputs": [tensor("points", "FP33", CUP)]}, 422, "invalid_input", "datatype"),
        ({"inputs": [tensor("points", "FP32", CUP[:, :2])]}, 422, "invalid_input", "(N, 3)"),
        ({"inputs": [tensor("points", "FP32", CUP[:0])]}, 422, "empty_cloud", ""),
        ({"inputs": [tensor("task", "BYTES", ["a", "b"])]}, 422, "invalid_input", "one element"),
        ({"inputs": [tensor("depth_scale", "FP32", [])]}, 422, "invalid_input", "one number"),
        ({"outputs": [{"name": "logits"}]}, 422, "invalid_input", "grasps, point_primitive"),
        ({"model": "x"}, 422, "invalid_input", "model"),
    ],
)
def test_errors_are_texts_with_the_envelope_beside_them(
    backend: Client, changes: dict[str, Any], status: int, code: str, told: str
) -> None:
    response = post(backend, question(**changes))
    error = response.json()
    assert (response.status_code, error["code"]) == (status, code), error
    assert isinstance(error["error"], str)
    assert told in error["error"]
    assert error["request_id"] == response.headers["x-request-id"]
    assert isinstance(error["details"], dict)


@pytest.mark.parametrize(
    ("body", "headers", "status", "code"),
    [
        (b"", {}, 400, "malformed"),
        (b"[]", {}, 400, "malformed"),
        (b"{}", {LENGTH: "3"}, 400, "malformed"),
        (b"{}", {LENGTH: "-1"}, 400, "malformed"),
        (b"{}", {LENGTH: "two"}, 400, "malformed"),
        (b"{}", {LENGTH: "1"}, 400, "malformed"),
        (b"{}", {"Content-Encoding": "gzip"}, 415, "unsupported_media_type"),
        (b"{}", {"X-Request-Timeout": "0"}, 504, "deadline_exceeded"),
        (b"\0" * 34_000_000, {}, 413, "too_large"),
    ],
)
def test_bodies_that_are_none(
    backend: Client, body: bytes, headers: dict[str, str], status: int, code: str
) -> None:
    response = post(backend, body, **headers)
    error = response.json()
    assert (response.status_code, error["code"]) == (status, code), error
    assert isinstance(error["error"], str)


def test_other_models_and_methods(backend: Client) -> None:
    for method, path, status in (
        ("GET", "/v2/models/resnet", 404),
        ("POST", "/v2/models/resnet/infer", 404),
        ("GET", INFER, 405),
    ):
        response = backend.request(method, path)
        assert response.status_code == status
        assert isinstance(response.json()["error"], str)
    assert isinstance(backend.request("GET", "/v2x").json()["error"], dict), "not below /v2"


def test_metadata_names_what_is_taken_and_given(backend: Client) -> None:
    server = backend.request("GET", "/v2").json()
    assert (server["name"], server["extensions"]) == ("sparge", ["binary_tensor_data"])
    model = backend.request("GET", "/v2/models/sparge").json()
    assert model["name"] == "sparge"
    given = {each["name"]: each for each in model["outputs"]}
    answered = post(backend, question()).json()["outputs"]
    assert [each["name"] for each in answered] == list(given)
    for each in answered:
        assert each["datatype"] == given[each["name"]]["datatype"]
        shape = zip(given[each["name"]]["shape"], each["shape"], strict=True)
        assert all(told in (-1, found) for told, found in shape)
    assert {each["name"] for each in model["inputs"]} >= {"points", "depth", "task"}


def test_health(backend: Client) -> None:
    assert backend.request("GET", "/v2/health/live").json() == {"live": True}
    assert backend.request("GET", "/v2/health/ready").json() == {"ready": True}
    ready = backend.request("GET", "/v2/models/sparge/ready")
    assert (ready.status_code, ready.json()) == (200, {"name": "sparge", "ready": True})


def test_health_of_a_gateway_without_its_stages() -> None:
    from services.gateway.app import create_app

    transport = httpx.MockTransport(lambda _: httpx.Response(503))
    app = create_app(all_elsewhere(), network=lambda: transport)

    async def ask() -> list[tuple[int, Any]]:
        asgi = httpx.ASGITransport(app=app)
        async with httpx.AsyncClient(transport=asgi, base_url="http://127.0.0.1") as http:
            paths = ("/v2/health/live", "/v2/health/ready", "/v2/models/sparge/ready")
            answers = [await http.get(path) for path in paths]
        return [(each.status_code, each.json()) for each in answers]

    import anyio

    assert anyio.run(ask) == [
        (200, {"live": True}),
        (503, {"ready": False}),
        (503, {"name": "sparge", "ready": False}),
    ]


def test_keys_open_it_as_they_open_post_grasp(tmp_path: Path) -> None:
    keys = tmp_path / "keys.json"
    reader = add_key(keys, "reader", (Scope.READ,))
    robot = add_key(keys, "robot", (Scope.GRASP,))
    slow = add_key(keys, "slow", (Scope.GRASP,), rate_per_s=0.01)
    with in_process(gateway(api_keys_file=keys, rate_burst=1)) as client:
        assert client.request("GET", "/v2/health/live").status_code == 200
        assert client.request("GET", "/v2/models/sparge/ready").status_code == 200
        refused = client.request("POST", INFER)
        assert (refused.status_code, refused.json()["code"]) == (401, "unauthorized")
        assert isinstance(refused.json()["error"], str)
        assert client.request("GET", "/v2").status_code == 401
        assert client.request("GET", "/v2/models/sparge", headers=bearer(reader)).status_code == 200
        told = {
            key: client.request("POST", INFER, headers=bearer(key)).json()["code"]
            for key in (reader, robot, slow)
        }
        assert told == {reader: "forbidden", robot: "malformed", slow: "malformed"}
        again = client.request("POST", INFER, headers=bearer(slow))
    assert (again.status_code, again.json()["code"]) == (429, "rate_limited")
    assert int(again.headers["retry-after"]) > 0


def test_a_full_queue_sends_away_as_it_does_from_post_grasp() -> None:
    app = gateway(max_running=1, max_waiting=0)
    app.state.admission.running = 1  # somebody is being served
    with in_process(app) as client:
        refused = post(client, question())
    assert (refused.status_code, refused.json()["code"]) == (429, "too_busy")
    assert refused.json()["details"]["stage"] == "gateway"
    assert int(refused.headers["retry-after"]) > 0


@pytest.fixture(autouse=True)
def _no_settings_of_the_shell(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("SPARGE_STAGE_SECRET", "SPARGE_GATEWAY_API_KEYS_FILE", "SPARGE_GATEWAY_INSECURE"):
        monkeypatch.delenv(name, raising=False)
