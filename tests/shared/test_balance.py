from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Awaitable, Callable
from typing import Any

import httpx
import pytest

from shared.service.balance import KEEP_S, BalancedTransport


class Replicas(httpx.AsyncBaseTransport):
    """Addresses that answer, some of them not; remembers who was asked."""

    def __init__(self, down: tuple[str, ...] = ()) -> None:
        self.down = set(down)
        self.asked: Counter[str] = Counter()
        self.held: dict[str, asyncio.Event] = {}
        self.seen: list[httpx.Request] = []

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        address = request.url.host
        if address in self.down:
            raise httpx.ConnectError("refused")
        self.asked[address] += 1
        self.seen.append(request)
        if address in self.held:
            await self.held[address].wait()
        return httpx.Response(200, request=request)


class World:
    def __init__(self, *addresses: str, down: tuple[str, ...] = ()) -> None:
        self.addresses = list(addresses)
        self.replicas = Replicas(down)
        self.now = 0.0
        self.resolved = 0
        transport = BalancedTransport(self.replicas, self.resolve, lambda: self.now)
        self.http = httpx.AsyncClient(transport=transport, base_url="http://stage:8000")

    async def resolve(self, host: str, port: int) -> list[str]:
        assert (host, port) == ("stage", 8000)
        self.resolved += 1
        return list(self.addresses)


def run(test: Callable[[], Awaitable[Any]]) -> None:
    async def bounded() -> None:
        async with asyncio.timeout(10):
            await test()

    asyncio.run(bounded())


def test_replicas_share_the_load() -> None:
    async def test() -> None:
        world = World("10.0.0.1", "10.0.0.2", "10.0.0.3")
        for _ in range(9):
            await world.http.get("/x")
        assert world.replicas.asked == {f"10.0.0.{n}": 3 for n in (1, 2, 3)}
        assert world.resolved == 1

    run(test)


def test_a_slow_replica_gets_less() -> None:
    async def test() -> None:
        world = World("10.0.0.1", "10.0.0.2")
        world.replicas.held["10.0.0.1"] = asyncio.Event()
        slow = asyncio.create_task(world.http.get("/x"))
        await asyncio.sleep(0)
        while not world.replicas.asked["10.0.0.1"]:
            await asyncio.sleep(0)
        for _ in range(5):
            await world.http.get("/x")
        assert world.replicas.asked == {"10.0.0.1": 1, "10.0.0.2": 5}
        world.replicas.held["10.0.0.1"].set()
        await slow

    run(test)


def test_the_name_that_was_asked_for_stays_in_the_request() -> None:
    async def test() -> None:
        world = World("fd00::1")
        await world.http.post("/x", content=b"body", headers={"X-Request-ID": "7"})
        (seen,) = world.replicas.seen
        assert seen.headers["host"] == "stage:8000"
        assert seen.headers["x-request-id"] == "7"
        assert str(seen.url) == "http://[fd00::1]:8000/x"
        assert await seen.aread() == b"body"

    run(test)


def test_who_cannot_be_reached_is_passed_over_and_tried_again_later() -> None:
    async def test() -> None:
        world = World("10.0.0.1", "10.0.0.2", down=("10.0.0.1",))
        for _ in range(4):
            assert (await world.http.get("/x")).status_code == 200
        assert world.replicas.asked == {"10.0.0.2": 4}
        world.replicas.down.clear()
        world.now += 3.0
        for _ in range(4):
            await world.http.get("/x")
        assert world.replicas.asked["10.0.0.1"] >= 2

    run(test)


def test_what_has_moved_is_found_at_once_and_what_is_new_soon() -> None:
    async def test() -> None:
        world = World("10.0.0.1")
        await world.http.get("/x")
        world.replicas.down.add("10.0.0.1")
        world.addresses = ["10.0.0.9"]
        await world.http.get("/x")
        assert world.replicas.asked["10.0.0.9"] == 1
        world.addresses = ["10.0.0.9", "10.0.0.10"]
        world.now += KEEP_S
        for _ in range(2):
            await world.http.get("/x")
        assert world.replicas.asked["10.0.0.10"] == 1

    run(test)


def test_an_error_when_nobody_answers_or_is_known() -> None:
    async def test() -> None:
        world = World("10.0.0.1", down=("10.0.0.1",))
        with pytest.raises(httpx.ConnectError, match="refused"):
            await world.http.get("/x")
        world = World()
        with pytest.raises(httpx.ConnectError, match="no address"):
            await world.http.get("/x")

    run(test)


def test_what_was_sent_is_not_sent_again() -> None:
    class Breaking(Replicas):
        async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
            await super().handle_async_request(request)
            raise httpx.ReadError("gone")

    async def test() -> None:
        world = World("10.0.0.1", "10.0.0.2")
        breaking = Breaking()
        http = httpx.AsyncClient(
            transport=BalancedTransport(breaking, world.resolve), base_url="http://stage:8000"
        )
        with pytest.raises(httpx.ReadError):
            await http.post("/x")
        assert breaking.asked.total() == 1

    run(test)


def test_a_name_that_the_system_does_not_know() -> None:
    async def test() -> None:
        async with httpx.AsyncClient(transport=BalancedTransport(Replicas())) as http:
            with pytest.raises(httpx.ConnectError):
                await http.get("http://no-such-stage.invalid/x")

    run(test)
