"""Hostile uploads over HTTP: each gets the error that it deserves, soon and for little memory."""

from __future__ import annotations

import json
import tempfile
import time
import tracemalloc
from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import pytest

from services.gateway.app import create_app
from shared.errors import EmptyCloud
from tests.support.asking import failed
from tests.support.gateways import all_elsewhere
from tests.support.hostile_files import ALLOWED, Hostile, hostile_files
from tests.support.serving import serving

MIB = 2**20
LIMIT_S = 20.0
GATEWAY_BYTES = 64 * MIB
"""The gateway may take so much for one of them: the body, twice, and what it unpacks to."""
SETTINGS: dict[str, Any] = {
    "max_body_bytes": 8 * MIB,
    "max_unpacked_bytes": ALLOWED,
    "file_memory_bytes": 96 * MIB,
    "file_time_s": 5.0,
}


class NoPoints(httpx.AsyncBaseTransport):
    """Perception's answer to a cloud without a single finite point."""

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        return httpx.Response(422, json=EmptyCloud("no finite points").envelope("-"))


@pytest.fixture(scope="module")
def gateway() -> Iterator[httpx.Client]:
    app = create_app(all_elsewhere(**SETTINGS), network=NoPoints)
    with serving(app) as url, httpx.Client(base_url=url, timeout=60) as client:
        yield client


def upload(gateway: httpx.Client, name: str, data: bytes) -> httpx.Response:
    return gateway.post(
        "/grasp",
        data={
            "task": "cooking",
            "intrinsics": json.dumps(np.eye(3).tolist()),
            "depth_scale": "0.001",
        },
        files={"file": (name, data)},
    )


def test_an_upload_that_cannot_be_kept_is_told_and_the_next_is_taken(
    gateway: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    large = b"1 2\n" * 2**19
    with monkeypatch.context() as patch:
        patch.setattr(tempfile, "tempdir", "/proc/full")
        response = upload(gateway, "a.xyz", large)
        assert upload(gateway, "a.xyz", large[:1000]).status_code == 400, "small ones are kept here"
    failed(response, 503, "stage_unavailable", "gateway")
    assert upload(gateway, "a.xyz", large).status_code == 400


@pytest.mark.parametrize(
    "hostile", list(hostile_files()), ids=lambda each: f"{each.extension[1:]}-{each.name}"
)
def test_it_gets_its_error_in_bounded_time_and_memory(
    gateway: httpx.Client, hostile: Hostile
) -> None:
    data = hostile.make()
    assert len(data) < SETTINGS["max_body_bytes"], "the reader decides, not the size"
    tracemalloc.start()
    started = time.monotonic()
    try:
        response = upload(gateway, f"a{hostile.extension}", data)
        taken = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    error = response.json()["error"]
    assert response.status_code == hostile.status, error
    assert error["code"] not in ("unreadable_file", "internal"), "no bound had to end it"
    assert time.monotonic() - started < LIMIT_S
    assert taken < GATEWAY_BYTES
