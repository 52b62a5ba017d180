"""The measuring itself: small backends whose speed and faults are known."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Awaitable, Callable

import numpy as np
import pytest
from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse, PlainTextResponse, Response

from shared.errors import TooBusy
from shared.service.envelope import error_response
from tests.load.backend import tree_mb
from tests.load.traffic import Record, closed_loop, open_loop
from tests.support.serving import serving


def backend(answer: Callable[[int], Awaitable[Response]]) -> FastAPI:
    app, number = FastAPI(), iter(range(10**6))

    @app.post("/grasp")
    async def grasp(request: Request) -> Response:
        await request.body()
        return await answer(next(number))

    return app


async def after_50_ms(number: int) -> Response:
    await asyncio.sleep(0.05)
    return JSONResponse({"found": number % 2 == 0})


def test_clients_wait_for_their_answers() -> None:
    with serving(backend(after_50_ms)) as url:
        record = asyncio.run(closed_loop(url, clients=3, seconds=1.0))
    assert set(record.counts()) == {"found", "not found"}
    assert 1 < record.throughput <= 63
    assert record.percentiles_ms(50)[0] >= 50
    assert record.unexplained() == 0


def test_arrivals_do_not_wait() -> None:
    with serving(backend(after_50_ms)) as url:
        record = asyncio.run(open_loop(url, rate_per_s=40.0, seconds=1.0))
    expected = np.random.default_rng(0).poisson(40.0, 1000)
    assert expected.min() <= sum(record.counts().values()) <= expected.max()


def test_refusals_are_explained_and_nonsense_is_not() -> None:
    async def odd(number: int) -> Response:
        if number % 2:
            return error_response(TooBusy("later"), "id")
        return PlainTextResponse("Internal Server Error", status_code=500)

    with serving(backend(odd)) as url:
        record = asyncio.run(closed_loop(url, clients=2, seconds=0.5))
    counts = record.counts()
    assert set(counts) == {"too_busy", "status 500 without an envelope"}
    assert record.unexplained() == counts["status 500 without an envelope"] > 0
    assert record.answered == []


def test_a_backend_that_is_gone_is_unexplained() -> None:
    record = asyncio.run(closed_loop("http://127.0.0.1:9", clients=1, seconds=0.2))
    assert record.counts()["ConnectError"] == record.unexplained() > 0


def test_percentiles_are_those_of_answers() -> None:
    record = Record(seconds=2.0)
    for latency in range(1, 101):
        record.add("found", latency / 1e3)
    record.add("too_busy", 9.0)
    assert record.percentiles_ms(50, 99) == pytest.approx([50.5, 99.01])
    assert record.throughput == 50


def test_memory_is_that_of_all_processes() -> None:
    assert tree_mb(os.getpid()) > 20
