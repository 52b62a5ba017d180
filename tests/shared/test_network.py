"""Connections to a stage are not kept for good."""

from __future__ import annotations

import asyncio
from itertools import groupby

import httpx
import pytest
from fastapi import FastAPI, Request

from shared.service.network import Network
from tests.support.serving import serving


def ports_seen(requests_per_connection: int, requests: int) -> list[int]:
    """Ask a server one request after the other; return the client's port of each."""
    app = FastAPI()

    @app.get("/port")
    async def port(request: Request) -> int:
        assert request.client is not None
        return request.client.port

    async def ask(url: str) -> list[int]:
        network = Network(requests_per_connection)
        async with httpx.AsyncClient(base_url=url, transport=network) as http:
            return [(await http.get("/port")).json() for _ in range(requests)]

    with serving(app) as url:
        return asyncio.run(ask(url))


@pytest.mark.parametrize("requests_per_connection", [1, 3])
def test_a_connection_serves_so_many_requests(requests_per_connection: int) -> None:
    runs = [len(list(run)) for _, run in groupby(ports_seen(requests_per_connection, 6))]
    assert runs == [requests_per_connection] * (6 // requests_per_connection)


def test_a_connection_is_used_again() -> None:
    assert len(set(ports_seen(100, 6))) == 1
