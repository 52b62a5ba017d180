"""Serving one `Route`: JSON or npz in, JSON or npz out."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TypeVar

from fastapi import FastAPI, Request
from fastapi.responses import Response
from starlette.concurrency import run_in_threadpool

from shared.schemas.route import Route
from shared.settings import ServiceSettings
from shared.wire import JSON, NPZ, Message, decode, encode
from shared.wire.codec import validate

In = TypeVar("In", bound=Message)
Out = TypeVar("Out", bound=Message)


def serve(
    app: FastAPI,
    route: Route[In, Out],
    answer: Callable[[In], Awaitable[Out]],
    settings: ServiceSettings,
) -> None:
    """Add `route` to `app`; bodies are parsed and written in a worker thread."""

    async def endpoint(request: Request) -> Response:
        if route.method == "POST":
            message = await run_in_threadpool(
                decode,
                route.request,
                await request.body(),
                request.headers.get("content-type", JSON),
                settings.max_unpacked_bytes,
            )
        else:
            known = route.request.model_fields
            query = {name: text for name, text in request.query_params.items() if name in known}
            message = validate(route.request, {**query, **request.path_params})
        return await respond(await answer(message), request)

    app.add_api_route(
        route.path,
        endpoint,
        methods=[route.method],
        summary=route.summary,
        name=f"{route.method} {route.path}",
        operation_id=f"{route.method.lower()}{route.path.replace('/', '_')}",
        response_class=Response,
    )


async def respond(message: Message, request: Request) -> Response:
    """Return `message` in the form that the request accepts: npz when it says so, else JSON."""
    media_type = NPZ if NPZ in request.headers.get("accept", JSON) else JSON
    return Response(await run_in_threadpool(encode, message, media_type), media_type=media_type)
