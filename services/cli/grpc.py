"""`sparge grpc`: the gateway's answers over gRPC."""

from __future__ import annotations

import asyncio
import os
from typing import Annotated

import typer

from services.cli.options import HostOption, InsecureOption, LogLevelOption, PortOption


def grpc(
    host: HostOption = "127.0.0.1",
    port: PortOption = 50051,
    url: Annotated[
        str | None, typer.Option(help="Ask the gateway here instead of starting a backend")
    ] = None,
    log_level: LogLevelOption = None,
    insecure: InsecureOption = False,
) -> None:
    """Serve the backend over gRPC (proto/sparge.proto), with health and reflection.

    Other addresses than the loopback are served only where the gateway wants API keys.
    """
    from services.gateway.access import require_guarded
    from services.gateway.settings import GatewaySettings
    from services.grpc.app import serve_until_stopped
    from services.grpc.settings import GrpcSettings
    from services.wiring import in_this_process
    from shared.service.logs import log_as_a_server

    if log_level is not None:
        os.environ["SPARGE_LOG_LEVEL"] = log_level.value
    log_as_a_server()
    settings = GrpcSettings()
    given = {"url": url or settings.url, "insecure": insecure or settings.insecure}
    settings = settings.model_copy(update=given)

    if not settings.url:  # known before anything is started
        gateway = GatewaySettings()
        open_to_all = settings.insecure or gateway.insecure
        require_guarded(host, gateway.model_copy(update={"insecure": open_to_all}))

    async def serve() -> None:
        if settings.url:
            await serve_until_stopped(settings, host, port)
            return
        async with in_this_process() as transport:
            await serve_until_stopped(settings, host, port, transport)

    asyncio.run(serve())
