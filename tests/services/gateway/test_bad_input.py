"""What the world may send to POST /grasp: each gets its error, and the next one works."""

from __future__ import annotations

import io
import json
import threading
import time
import zipfile

import httpx
import numpy as np
import pytest

from services.gateway.settings import GatewaySettings
from services.wiring import create_app
from shared.errors import StageUnavailable
from shared.wire.npz import write_npz
from tests.support.samples import sample_path
from tests.support.serving import Client, in_process, serving

NPZ = "application/x-npz"


def grasp(backend: Client, body: bytes, media_type: str = NPZ, **query: str) -> httpx.Response:
    return backend.request(
        "POST",
        "/grasp",
        params={"task": "cooking", **query},
        content=body,
        headers={"Content-Type": media_type},
    )


def points(rows: np.ndarray) -> bytes:
    return write_npz({"points": rows})


def bomb() -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("points.npy", b"\0" * 300_000_000)
    return stream.getvalue()


def pickled() -> bytes:
    stream = io.BytesIO()
    np.savez(stream, points=np.array([[{"x": 1}]], dtype=object))
    return stream.getvalue()


def sample() -> bytes:
    return sample_path("saucepan").read_bytes()


def empty_table() -> np.ndarray:
    """A table top one metre below the camera, seen from above, with 0.5 mm of noise."""
    rng = np.random.default_rng(0)
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, 150), np.linspace(-0.4, 0.4, 120))
    return np.column_stack([x.ravel(), y.ravel(), 1.0 + 5e-4 * rng.normal(size=x.size)])


CLOUD = np.random.default_rng(0).normal(size=(500, 3)) * 0.02 + [0, 0, 0.8]

BAD = {
    "empty cloud": (points(np.empty((0, 3))), {}, 422, "empty_cloud"),
    "one point": (points(np.array([[0, 0, 1.0]])), {}, 422, "empty_cloud"),
    "one point of an object": (
        points(np.array([[0, 0, 1.0]])),
        {"input": "object"},
        422,
        "empty_cloud",
    ),
    "all NaN": (points(np.full((100, 3), np.nan)), {}, 422, "empty_cloud"),
    "all infinite": (points(np.full((100, 3), np.inf)), {}, 422, "empty_cloud"),
    "a table and nothing on it": (points(empty_table()), {}, 422, "no_object"),
    "all points on a plane": (points(empty_table() * [1, 1, 0] + [0, 0, 1]), {}, 422, "no_object"),
    "an object without volume": (
        points(empty_table() * [1, 1, 0] + [0, 0, 1]),
        {"input": "object"},
        422,
        "degenerate_cloud",
    ),
    "an object on a line": (
        points(np.outer(np.linspace(0.5, 1, 300), [0.1, 0.2, 1.0])),
        {"input": "object"},
        422,
        "degenerate_cloud",
    ),
    "the wrong shape": (points(np.zeros((10, 2))), {}, 422, "invalid_input"),
    "the wrong dtype": (points(np.zeros((10, 3), dtype=complex)), {}, 422, "invalid_input"),
    "pickled": (pickled(), {}, 400, "malformed"),
    "truncated": (sample()[:5000], {}, 400, "malformed"),
    "a bomb": (bomb(), {}, 413, "too_large"),
    "millimetres": (points(CLOUD * 1000), {"input": "object"}, 422, "wrong_units"),
    "a scene in millimetres": (points(empty_table() * 1000), {}, 422, "wrong_units"),
    "an unknown task": (sample(), {"task": "juggling"}, 422, "unknown_task"),
    "an unknown gripper": (sample(), {"gripper": "tentacle"}, 422, "unknown_gripper"),
    "50 MB": (b"\0" * 50_000_000, {}, 413, "too_large"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_told_and_nothing_is_lost(backend: Client, name: str) -> None:
    body, query, status, code = BAD[name]
    threads = threading.active_count()
    response = grasp(backend, body, **query)
    assert (response.status_code, response.json()["error"]["code"]) == (status, code), response.text
    assert "Traceback" not in response.text
    assert threading.active_count() <= threads + 2, "only the pool's idle workers may be new"
    assert backend.request("GET", "/health/ready").status_code == 200


def test_it_still_answers_after_all_that(backend: Client) -> None:
    for name in BAD:
        body, query, _, _ = BAD[name]
        assert grasp(backend, body, **query).status_code >= 400
    assert grasp(backend, sample()).status_code == 200


def test_nan_in_json_is_malformed(backend: Client) -> None:
    body = json.dumps({"points": [[float("nan"), 0, 1]] * 20}).encode()
    response = grasp(backend, body, "application/json")
    assert (response.status_code, response.json()["error"]["code"]) == (400, "malformed")


def test_some_invalid_points_are_dropped_and_counted(backend: Client) -> None:
    rows = CLOUD.copy()
    rows[::10] = np.nan
    rows[5] = np.inf
    response = grasp(backend, points(rows), input="object")
    assert response.status_code == 200, response.text
    assert response.json()["scene"]["dropped"]["invalid"] == 51


def test_an_unknown_task_lists_the_known_ones(backend: Client) -> None:
    error = grasp(backend, sample(), task="juggling").json()["error"]
    assert {"cooking", "pouring", "handover"} <= set(error["details"]["known"])
    assert "pouring" in error["message"]


def test_millimetres_are_named_in_the_message(backend: Client) -> None:
    message = grasp(backend, points(CLOUD * 1000), input="object").json()["error"]["message"]
    assert "millimetres" in message


def test_a_form_without_a_file(backend: Client) -> None:
    response = backend.request("POST", "/grasp", data={"task": "cooking"}, files={"other": b"x"})
    assert response.status_code == 422
    assert "file" in response.json()["error"]["message"]


def test_a_missing_stage_is_named() -> None:
    settings = GatewaySettings(primitive_recovery_url="http://127.0.0.1:9")
    with (
        pytest.raises(StageUnavailable, match="primitive_recovery: All connection attempts failed"),
        in_process(create_app(settings)),
    ):
        pass


def test_a_request_to_a_missing_stage_names_it() -> None:
    settings = GatewaySettings(primitive_recovery_url="http://127.0.0.1:9")
    with serving(create_app(settings)) as url, httpx.Client(base_url=url, timeout=30) as client:
        for _ in range(600):
            response = client.post(
                "/grasp",
                params={"task": "cooking"},
                content=sample(),
                headers={"Content-Type": NPZ},
            )
            error = response.json()["error"]
            assert (response.status_code, error["code"]) == (503, "stage_unavailable")
            assert response.headers["retry-after"]
            if error["details"]["stage"] == "primitive_recovery":
                break
            time.sleep(0.1)  # the other stages are still warming up
        assert "primitive_recovery cannot be reached" in error["message"]
        assert client.get("/tasks").status_code == 200, "what does not need it works"
