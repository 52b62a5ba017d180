"""What every request passes through first: an id, a size limit, a last line of defence.

Written against ASGI itself, so that it costs microseconds and also sees what
never reaches a route.
"""

from __future__ import annotations

import asyncio
import logging
import math
import time
from collections.abc import Callable

from opentelemetry import trace
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from shared.deadline import DEADLINE_HEADER, from_now
from shared.errors import (
    BodyTooSlow,
    InternalError,
    MalformedRequest,
    PayloadTooLarge,
    SpargeError,
)
from shared.service.envelope import error_response
from shared.service.exchange import ERROR_CODE, NOTHING_SENT, Exchange, exchange
from shared.service.request_id import REQUEST_ID_HEADER, identified, request_id
from shared.service.server_timing import SERVER_TIMING, server_timing
from shared.settings import ServiceSettings

_DRAIN_FACTOR, _DRAIN_SECONDS = 8, 10.0

Observe = Callable[[Exchange], None]
Guard = Callable[[Scope], None]
"""Raises the error of a request that may not pass."""

log = logging.getLogger("sparge")


class RequestContext:
    """ASGI middleware: request id, guard, deadline, limits of the body, no traceback ever."""

    def __init__(
        self, app: ASGIApp, *, settings: ServiceSettings, observe: Observe, guard: Guard
    ) -> None:
        self._app = app
        self._settings = settings
        self._guard = guard
        self._observe = observe

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        identifier = identified(headers.get(REQUEST_ID_HEADER, ""))
        token = request_id.set(identifier)
        trace.get_current_span().set_attribute("sparge.request_id", identifier)
        started, status, answering, bytes_out = time.perf_counter(), NOTHING_SENT, False, 0
        limited = _Limited(receive, headers, self._settings)

        async def send_with_id(message: Message) -> None:
            nonlocal status, answering, bytes_out
            if message["type"] == "http.response.start":
                status, answering = message["status"], True
                answer = MutableHeaders(scope=message)
                answer[REQUEST_ID_HEADER] = identifier
                total_ms = 1e3 * (time.perf_counter() - started)
                answer.setdefault(SERVER_TIMING, server_timing({"total": total_ms}))
            else:
                bytes_out += len(message.get("body", b""))
            await send(message)

        try:
            self._guard(scope)
            await limited.check_declared_length()
            with from_now(_seconds_left(headers)):
                await self._app(scope, limited, send_with_id)
        except Exception as error:
            if not isinstance(error, SpargeError):
                log.exception("unhandled error in request %s", identifier)
                error = InternalError("an internal error; the log has it under this request id")
            scope[ERROR_CODE] = error.code
            if not answering:
                await error_response(error, identifier, scope)(scope, receive, send_with_id)
        finally:
            seconds = time.perf_counter() - started
            self._observe(exchange(scope, status, seconds, limited.seen, bytes_out))
            request_id.reset(token)


def _seconds_left(headers: Headers) -> float:
    """Return the time that the request says it has."""
    text = headers.get(DEADLINE_HEADER)
    if text is None:
        return math.inf
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not seconds >= 0:
        raise MalformedRequest(
            f"{DEADLINE_HEADER} must say how many seconds are left; found {text[:40]!r}",
            field=DEADLINE_HEADER,
        )
    return seconds


class _Limited:
    """A receive channel that counts the body and the time it takes."""

    def __init__(self, receive: Receive, headers: Headers, settings: ServiceSettings) -> None:
        self._receive = receive
        self._headers = headers
        self._limit = settings.max_body_bytes
        self._time_s = settings.body_time_s
        self._until = time.monotonic() + settings.body_time_s
        self.seen = 0
        self._whole = False

    async def check_declared_length(self) -> None:
        declared = self._headers.get("content-length", "")
        if declared.isdigit() and int(declared) > self._limit:
            if "expect" not in self._headers:
                await self._drain()
            raise self._too_large(int(declared))

    async def __call__(self) -> Message:
        if self._whole:  # from here on it only tells that the client is gone
            return await self._receive()
        try:
            async with asyncio.timeout(max(self._until - time.monotonic(), 0.0)):
                message = await self._receive()
        except TimeoutError:
            raise BodyTooSlow(
                f"the body did not arrive within {self._time_s:g} s", allowed=self._time_s
            ) from None
        self._whole = not message.get("more_body", False)
        if message["type"] == "http.request":
            self.seen += len(message.get("body", b""))
            if self.seen > self._limit:
                if message.get("more_body"):
                    await self._drain()
                raise self._too_large(self.seen)
        return message

    async def _drain(self) -> None:
        """Take the rest of the body and forget it, within bounds.

        A client that is cut off in mid-upload sees a broken connection instead
        of the answer.
        """
        seen = 0
        try:
            async with asyncio.timeout(_DRAIN_SECONDS):
                while seen < _DRAIN_FACTOR * self._limit:
                    message = await self._receive()
                    seen += len(message.get("body", b""))
                    if message["type"] != "http.request" or not message.get("more_body"):
                        return
        except TimeoutError:
            return

    def _too_large(self, found: int) -> PayloadTooLarge:
        return PayloadTooLarge(
            f"the body is larger than the {self._limit} bytes accepted here",
            found=found,
            allowed=self._limit,
        )
