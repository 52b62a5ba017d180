"""Serving one `Route`: JSON or npz in, JSON or npz out."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TypeVar

from fastapi import FastAPI, Request
from fastapi.responses import Response
from starlette.concurrency import run_in_threadpool

from shared.schemas.route import Route
from shared.service.admission import Admission
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
    """Add `route` to `app`, answered on the event loop: what waits for others or is quick.

    Bodies are parsed and written in a worker thread.
    """

    async def endpoint(request: Request) -> Response:
        body = await request.body()
        message = await run_in_threadpool(_read, route, request, body, settings)
        return await respond(await answer(message), request)

    _add(app, route, endpoint)


def serve_work(
    app: FastAPI,
    route: Route[In, Out],
    work: Callable[[In], Out],
    settings: ServiceSettings,
    admission: Admission,
    require_ready: Callable[[], None],
) -> None:
    """Add `route` to `app`, answered by `work` in a thread of its own when it is its turn.

    Parsing and writing are part of the work: what waits holds the bytes of its body, no more.
    """

    async def endpoint(request: Request) -> Response:
        require_ready()
        body = await request.body()

        def answer() -> Response:
            return _write(work(_read(route, request, body, settings)), request)

        return await admission.in_thread(answer)

    _add(app, route, endpoint)


async def respond(message: Message, request: Request) -> Response:
    """Return `message` in the form that the request accepts: npz when it says so, else JSON."""
    return await run_in_threadpool(_write, message, request)


def _read(route: Route[In, Out], request: Request, body: bytes, settings: ServiceSettings) -> In:
    if route.method == "POST":
        media_type = request.headers.get("content-type", JSON)
        return decode(route.request, body, media_type, settings.max_unpacked_bytes)
    known = route.request.model_fields
    query = {name: text for name, text in request.query_params.items() if name in known}
    return validate(route.request, {**query, **request.path_params})


def _write(message: Message, request: Request) -> Response:
    media_type = NPZ if NPZ in request.headers.get("accept", JSON) else JSON
    return Response(encode(message, media_type), media_type=media_type)


def _add(
    app: FastAPI, route: Route[In, Out], endpoint: Callable[[Request], Awaitable[Response]]
) -> None:
    app.add_api_route(
        route.path,
        endpoint,
        methods=[route.method],
        summary=route.summary,
        name=f"{route.method} {route.path}",
        operation_id=f"{route.method.lower()}{route.path.replace('/', '_')}",
        response_class=Response,
    )
