"""The gRPC server: the service, health and reflection, in front of a gateway."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import signal
import socket
from collections.abc import AsyncIterator

import grpc
import httpx
from fastapi import FastAPI
from grpc_health.v1 import health, health_pb2_grpc
from grpc_reflection.v1alpha import reflection

from services.grpc.backend import Gateway
from services.grpc.health import following
from services.grpc.service import SERVICE, handlers
from services.grpc.settings import GrpcSettings
from shared.errors import InvalidInput
from shared.loopback import is_loopback
from shared.service.exchange import IN_PROCESS

log = logging.getLogger("uvicorn.error")
"""Where services say that they start and stop."""


@contextlib.asynccontextmanager
async def serving(
    settings: GrpcSettings,
    host: str,
    port: int,
    transport: httpx.AsyncBaseTransport | None = None,
) -> AsyncIterator[int]:
    """Serve while the body runs; gives the port.

    Parameters
    ----------
    host, port : str, int
        Where to listen; port 0 takes a free one.
    transport : httpx.AsyncBaseTransport, optional
        To a gateway of this process; without it the one at `settings.url` is asked.

    Raises
    ------
    ValueError
        Neither a URL nor a transport.
    InvalidInput
        Other machines would reach a gateway that wants no keys, or the address is taken.
    StageUnavailable
        Whether the gateway wants keys cannot be known, as it does not answer.
    """
    if transport is None and not settings.url:
        raise ValueError("the gRPC server does not know where the gateway is; set SPARGE_GRPC_URL")
    base_url = settings.url if transport is None else "http://127.0.0.1"
    async with contextlib.AsyncExitStack() as stack:
        http = await stack.enter_async_context(
            httpx.AsyncClient(base_url=base_url or "", transport=transport, timeout=None)
        )
        gateway = Gateway(http, settings.timeout_s)
        await _require_guarded(host, gateway, settings)
        servicer = await stack.enter_async_context(following(gateway, settings.health_s))
        server = _server(settings)
        server.add_generic_rpc_handlers((handlers(gateway),))
        health_pb2_grpc.add_HealthServicer_to_server(servicer, server)
        reflection.enable_server_reflection(
            (SERVICE, health.SERVICE_NAME, reflection.SERVICE_NAME), server
        )
        bound = _listen(server, host, port)
        await server.start()
        log.info("gRPC on %s:%d", host, bound)
        try:
            yield bound
        finally:
            await servicer.enter_graceful_shutdown()
            await server.stop(settings.stop_s)
            log.info("gRPC stopped")


def require_free(host: str, port: int) -> None:
    """Return if `port` of `host` can be listened on; a server that cannot start says so too late.

    Raises
    ------
    InvalidInput
        It is taken, or no address of this machine.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        socket.create_server((host.strip("[]"), port), family=family).close()
    except OSError as error:
        raise InvalidInput(f"cannot listen on {host}:{port}: {error.strerror or error}") from None


def beside(gateway: FastAPI, settings: GrpcSettings, host: str, port: int) -> FastAPI:
    """Return `gateway`, which serves gRPC as well for as long as it is served itself.

    What `serving` raises then ends its start.
    """
    alone = gateway.router.lifespan_context
    transport = httpx.ASGITransport(gateway, raise_app_exceptions=False, client=IN_PROCESS)

    @contextlib.asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        async with alone(app), serving(settings, host, port, transport):
            yield

    gateway.router.lifespan_context = lifespan
    return gateway


async def serve_until_stopped(
    settings: GrpcSettings,
    host: str,
    port: int,
    transport: httpx.AsyncBaseTransport | None = None,
) -> None:
    """Serve until SIGTERM or SIGINT; what is open then may end within `settings.stop_s`.

    Raises what `serving` raises.
    """
    stopping = asyncio.Event()
    loop = asyncio.get_running_loop()
    for sent in (signal.SIGTERM, signal.SIGINT):
        loop.add_signal_handler(sent, stopping.set)
    async with serving(settings, host, port, transport):
        await stopping.wait()


def _server(settings: GrpcSettings) -> grpc.aio.Server:
    return grpc.aio.server(
        options=(
            ("grpc.max_receive_message_length", settings.max_message_bytes),
            ("grpc.max_send_message_length", -1),
            ("grpc.so_reuseport", 0),  # two servers on one port would share the calls
        ),
        maximum_concurrent_rpcs=settings.max_calls,
    )


def _listen(server: grpc.aio.Server, host: str, port: int) -> int:
    address = f"[{host}]:{port}" if ":" in host and not host.startswith("[") else f"{host}:{port}"
    try:
        bound = server.add_insecure_port(address)
    except RuntimeError as error:
        raise InvalidInput(f"cannot listen on {address}: {error}") from None
    return bound


async def _require_guarded(host: str, gateway: Gateway, settings: GrpcSettings) -> None:
    if settings.insecure or is_loopback(host) or await gateway.wants_keys():
        return
    raise InvalidInput(
        f"the gateway wants no API keys, so gRPC is served on the loopback only, not on {host}. "
        "Give the gateway keys (SECURITY.md); or say --insecure to let anybody who reaches "
        "this port use and change it"
    )
