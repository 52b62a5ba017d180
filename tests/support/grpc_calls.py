"""A gRPC server for tests, and calls to it from synchronous code."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterator
from typing import Any

import anyio.from_thread
import anyio.to_thread
import grpc
import httpx
from google.protobuf.message_factory import GetMessageClass

from services.grpc.app import serving
from services.grpc.service import DESCRIPTOR, SERVICE
from services.grpc.settings import GrpcSettings
from tests.support.serving import Client

_METHODS = DESCRIPTOR.methods_by_name


class Through(httpx.AsyncBaseTransport):
    """A transport to what a synchronous client speaks to, whatever loop that runs on."""

    def __init__(self, client: Client) -> None:
        self._client = client

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        send = functools.partial(
            self._client.request,
            request.method,
            str(request.url.copy_with(scheme=None, netloc=b"")),
            content=await request.aread(),
            headers=request.headers,
        )
        answer = await anyio.to_thread.run_sync(send)
        return httpx.Response(answer.status_code, headers=answer.headers, content=answer.content)


@contextlib.contextmanager
def grpc_port(transport: httpx.AsyncBaseTransport | None, **settings: Any) -> Iterator[int]:
    """Serve on a free port of the loopback, and give the port."""
    with anyio.from_thread.start_blocking_portal() as portal:
        server = serving(GrpcSettings(**settings), "127.0.0.1", 0, transport)
        with portal.wrap_async_context_manager(server) as port:
            yield port


@contextlib.contextmanager
def grpc_server(
    transport: httpx.AsyncBaseTransport | None, **settings: Any
) -> Iterator[grpc.Channel]:
    """Serve on a free port of the loopback, and give a channel to it."""
    with (
        grpc_port(transport, **settings) as port,
        grpc.insecure_channel(f"127.0.0.1:{port}") as channel,
    ):
        yield channel


def call(
    channel: grpc.Channel, name: str, message: Any, **options: Any
) -> tuple[Any, dict[str, Any]]:
    """Return the answer of a call and its trailing metadata.

    Raises
    ------
    grpc.RpcError
        As `grpc.UnaryUnaryMultiCallable`.
    """
    multi = channel.unary_unary(
        f"/{SERVICE}/{name}",
        request_serializer=type(message).SerializeToString,
        response_deserializer=GetMessageClass(_METHODS[name].output_type).FromString,
    )
    answer, done = multi.with_call(message, **{"timeout": 60, **options})
    return answer, dict(done.trailing_metadata() or ())


def failure(channel: grpc.Channel, name: str, message: Any, **options: Any) -> Any:
    """Return the `grpc.RpcError` that a call ends in; the test fails if it does not."""
    try:
        call(channel, name, message, **options)
    except grpc.RpcError as error:
        return error
    raise AssertionError(f"{name} did not fail")
