"""Spreading requests over the replicas of a service that share a name.

A name server lists the addresses of all replicas, but a connection goes to one of them and is
kept, and the system's resolver sorts the list the same way every time: without more, one
replica does all the work.
"""

from __future__ import annotations

import asyncio
import itertools
import socket
import time
from collections import Counter
from collections.abc import Awaitable, Callable
from typing import NamedTuple

import httpx

Resolve = Callable[[str, int], Awaitable[list[str]]]

KEEP_S = 5.0
"""How long addresses are used before they are asked for again."""
_AVOID_S = 2.0


class _Known(NamedTuple):
    addresses: list[str]
    until: float


class BalancedTransport(httpx.AsyncBaseTransport):
    """Sends each request to the address of its host that has the fewest under way.

    An address that cannot be reached is tried last for two seconds, and the request goes to the
    next one: nothing was sent yet. A request that has been sent is not sent again.

    Parameters
    ----------
    inner : httpx.AsyncBaseTransport
        Keeps connections by address.
    resolve : callable, optional
        Host and port -> addresses; raises OSError.
    clock : callable, optional
        Seconds since some fixed time.
    """

    def __init__(
        self,
        inner: httpx.AsyncBaseTransport,
        resolve: Resolve | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._inner, self._clock = inner, clock
        self._resolve = resolve or _ask_the_system
        self._known: dict[tuple[str, int], _Known] = {}
        self._under_way: Counter[str] = Counter()
        self._last_used: dict[str, int] = {}
        self._avoided_until: dict[str, float] = {}
        self._number = itertools.count()

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        """Send `request`; its headers keep the name that was asked for.

        Raises
        ------
        httpx.ConnectError
            The name is not known, or none of its addresses can be reached.
        """
        host, port = request.url.host, request.url.port or _PORTS[request.url.scheme]
        tried: set[str] = set()
        failure = httpx.ConnectError(f"{host} has no address", request=request)
        for is_fresh in (False, True):  # what has moved is found by asking anew
            addresses = await self._addresses(host, port, request, is_fresh=is_fresh)
            while untried := [each for each in addresses if each not in tried]:
                address = min(untried, key=self._burden)
                tried.add(address)
                try:
                    return await self._send(request, host, address)
                except (httpx.ConnectError, httpx.ConnectTimeout) as error:
                    self._avoided_until[address] = self._clock() + _AVOID_S
                    failure = httpx.ConnectError(str(error), request=request)
        raise failure

    async def aclose(self) -> None:
        """Close all connections."""
        await self._inner.aclose()

    async def _send(self, request: httpx.Request, host: str, address: str) -> httpx.Response:
        self._last_used[address] = next(self._number)
        self._under_way[address] += 1
        try:
            return await self._inner.handle_async_request(
                httpx.Request(
                    request.method,
                    request.url.copy_with(host=address),
                    headers=request.headers,
                    stream=request.stream,
                    extensions={**request.extensions, "sni_hostname": host},
                )
            )
        finally:
            self._under_way[address] -= 1

    def _burden(self, address: str) -> tuple[bool, int, int]:
        """Return what is least for the address to use next."""
        avoided = self._avoided_until.get(address, 0.0) > self._clock()
        return avoided, self._under_way[address], self._last_used.get(address, -1)

    async def _addresses(
        self, host: str, port: int, request: httpx.Request, *, is_fresh: bool
    ) -> list[str]:
        known = self._known.get((host, port))
        if known is None or is_fresh or self._clock() >= known.until:
            try:
                found = await self._resolve(host, port)
            except OSError as error:
                raise httpx.ConnectError(f"{host}: {error}", request=request) from None
            known = _Known(found, self._clock() + KEEP_S)
            self._known[host, port] = known
        return known.addresses


_PORTS = {"http": 80, "https": 443}


async def _ask_the_system(host: str, port: int) -> list[str]:
    loop = asyncio.get_running_loop()
    found = await loop.getaddrinfo(host, port, type=socket.SOCK_STREAM)
    return list(dict.fromkeys(str(address[0]) for *_, address in found))
