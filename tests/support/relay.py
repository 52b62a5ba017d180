"""A backend of this process behind a socket."""

from __future__ import annotations

import asyncio

from fastapi import FastAPI, Request
from fastapi.responses import Response

from tests.support.serving import Client

METHODS = ["GET", "POST", "DELETE"]


def relay(backend: Client) -> FastAPI:
    """Return an application that passes every request on as it is, and its answer back."""
    app = FastAPI()

    @app.api_route("/{path:path}", methods=METHODS)
    async def passed_on(request: Request) -> Response:
        answer = await asyncio.to_thread(
            backend.request,
            request.method,
            str(request.url.replace(scheme="", netloc="")),
            headers=dict(request.headers),
            content=await request.body(),
        )
        return Response(answer.content, answer.status_code, dict(answer.headers))

    return app
