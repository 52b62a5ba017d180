"""grpc.health.v1: serving while the gateway is ready."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator

from grpc_health.v1 import health, health_pb2

from services.grpc.backend import Gateway
from services.grpc.service import SERVICE

WATCHED = ("", SERVICE)
"""The server as a whole, and the service by name."""
_Status = health_pb2.HealthCheckResponse


@contextlib.asynccontextmanager
async def following(gateway: Gateway, period_s: float) -> AsyncIterator[health.aio.HealthServicer]:
    """Give a servicer that says what the gateway's `/health/ready` said last.

    From the end of the body on it says NOT_SERVING, so that no new calls come.
    """
    servicer = health.aio.HealthServicer()
    await _say(servicer, ready=False)

    async def follow() -> None:
        while True:
            await _say(servicer, ready=await gateway.ready())
            await asyncio.sleep(period_s)

    task = asyncio.create_task(follow())
    try:
        yield servicer
    finally:
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task


async def _say(servicer: health.aio.HealthServicer, *, ready: bool) -> None:
    status = _Status.SERVING if ready else _Status.NOT_SERVING
    for name in WATCHED:
        await servicer.set(name, status)
