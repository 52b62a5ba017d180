"""The typed client: a `Route` and a message in, a message or an error of the tree out.

It is given an `httpx.AsyncClient` and does not know what that speaks over. Its
transport may know no timeouts, so the deadline is kept here.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import httpx
import orjson
from opentelemetry import trace

from shared.deadline import DEADLINE_HEADER, remaining_s
from shared.errors import (
    DeadlineExceeded,
    MethodNotAllowed,
    NoSuchPath,
    SpargeError,
    StageUnavailable,
    Unauthorized,
    error_from_envelope,
)
from shared.schemas.route import Route
from shared.service.app import Health
from shared.service.request_id import REQUEST_ID_HEADER, request_id
from shared.service.tracing import answered, calling, inject
from shared.wire import NPZ, Message, decode, encode

In = TypeVar("In", bound=Message)
Out = TypeVar("Out", bound=Message)

MAX_ANSWER_BYTES = 512 * 2**20
UNPACKED = {"Accept-Encoding": "identity"}
"""A packed answer could unpack to anything; ours are not text that packs well."""


class Answer(Protocol):
    """What is looked at of an HTTP answer, as in `httpx.Response`."""

    @property
    def status_code(self) -> int: ...

    @property
    def headers(self) -> Mapping[str, str]: ...

    @property
    def content(self) -> bytes: ...


class Stage(Protocol):
    """One service, wherever it runs: `StageClient`, or `LocalStage` in the same process."""

    async def call(self, route: Route[In, Out], request: In, timeout_s: float) -> Out:
        """Return the answer, or raise the error."""

    async def health(self, timeout_s: float) -> Health:
        """Return whether it can work."""

    async def close(self) -> None:
        """Let go of what the calls need."""


@dataclass(frozen=True)
class _Taken:
    """An answer that was taken in whole, and is no larger than allowed."""

    url: str
    status_code: int
    headers: httpx.Headers
    content: bytes


class StageClient:
    """Calls one service.

    Parameters
    ----------
    service : str
        Its name, for messages.
    http : httpx.AsyncClient
        With the base URL and the transport; closed by whoever made it, or by `close`.
    tracer : Tracer, optional
        Makes a span of each call; without it, the one of the process if there is one.
    """

    def __init__(
        self, service: str, http: httpx.AsyncClient, tracer: trace.Tracer | None = None
    ) -> None:
        self.service = service
        self._http = http
        self._tracer = tracer or trace.get_tracer("sparge")

    async def call(self, route: Route[In, Out], request: In, timeout_s: float) -> Out:
        """Send `request`, return the answer; the stage is told how much time there is.

        Raises
        ------
        SpargeError
            What the service answered with, for errors of the input.
        StageUnavailable
            It cannot be reached, failed, or answered nonsense.
        DeadlineExceeded
            No answer within `timeout_s` seconds, or by the deadline of the request that is
            being answered.
        """
        left_s = time_left(self.service, timeout_s)
        try:
            with calling(self._tracer, route, self._http.base_url) as span:
                asked = compose(route, request)  # within the span: its headers name it
                asked["headers"][DEADLINE_HEADER] = f"{left_s:.3f}"
                async with asyncio.timeout(left_s):
                    answer = await self._ask(**asked)
                answered(span, answer.url, answer.status_code)
        except (TimeoutError, httpx.TimeoutException):
            raise out_of_time(self.service) from None
        except httpx.RequestError as error:
            raise unavailable(self.service, f"cannot be reached ({type(error).__name__})") from None
        try:
            return read(self.service, route, answer)
        except Unauthorized:
            raise unavailable(self.service, "does not take the secret that it is sent") from None

    async def health(self, timeout_s: float) -> Health:
        """Ask `/health/ready`; a service that does not answer has status `failed`."""
        try:
            async with asyncio.timeout(timeout_s):
                answer = await self._ask("GET", "/health/ready")
            return Health.model_validate_json(answer.content)
        except (TimeoutError, httpx.HTTPError, ValueError, StageUnavailable) as error:
            message = str(error) or type(error).__name__
            return Health(status="failed", service=self.service, details={"error": message})

    async def close(self) -> None:
        """Close the connections."""
        await self._http.aclose()

    async def _ask(
        self, method: str, url: str, headers: Mapping[str, str] | None = None, **options: Any
    ) -> _Taken:
        """Send a request and take the answer, but no more than `MAX_ANSWER_BYTES` of it."""
        sent = self._http.stream(method, url, headers={**UNPACKED, **(headers or {})}, **options)
        async with sent as response:
            if response.headers.get("content-encoding", "identity") != "identity":
                raise unavailable(self.service, "answered nonsense: packed, unasked")
            pieces, size = [], 0
            async for piece in response.aiter_bytes():
                pieces.append(piece)
                size += len(piece)
                if size > MAX_ANSWER_BYTES:
                    raise unavailable(
                        self.service, f"answered nonsense: more than {MAX_ANSWER_BYTES} bytes"
                    )
        url = str(response.request.url)
        return _Taken(url, response.status_code, response.headers, b"".join(pieces))


def compose(route: Route[In, Out], request: In) -> dict[str, Any]:
    """Return the arguments of an httpx client's `request` that ask `route`."""
    path = route.path
    for name in type(request).model_fields:
        if (place := f"{{{name}}}") in path:
            path = path.replace(place, str(getattr(request, name)))
    headers = inject({"Accept": NPZ, REQUEST_ID_HEADER: request_id.get()})
    if route.method != "POST":
        fields = request.model_dump(mode="json", exclude_none=True)
        params = {name: text for name, text in fields.items() if f"{{{name}}}" not in route.path}
        return {"method": route.method, "url": path, "headers": headers, "params": params}
    return {
        "method": route.method,
        "url": path,
        "headers": {**headers, "Content-Type": NPZ},
        "content": encode(request, NPZ),
    }


def read(service: str, route: Route[In, Out], answer: Answer) -> Out:
    """Return the message of an answer, or raise the error that it is."""
    check(service, answer)
    try:
        media_type = answer.headers.get("content-type", "")
        return decode(route.response, answer.content, media_type, MAX_ANSWER_BYTES)
    except SpargeError as error:
        raise unavailable(service, f"answered nonsense: {error.message}") from None


def check(service: str, answer: Answer) -> None:
    """Raise the error that an answer is, unless it is none."""
    if answer.status_code == 200:
        return
    try:
        error = error_from_envelope(answer.status_code, orjson.loads(answer.content))
    except orjson.JSONDecodeError:
        error = None
    if error is None or isinstance(error, NoSuchPath | MethodNotAllowed):
        raise unavailable(service, f"answered {answer.status_code}; is its URL right?")
    raise as_of_stage(service, error)


def as_of_stage(service: str, error: SpargeError) -> SpargeError:
    """Return what a stage's error is to whoever called it; one of the input stays what it is."""
    if error.status >= 500 and not isinstance(error, StageUnavailable | DeadlineExceeded):
        return unavailable(service, f"failed: {error.message}")
    error.details.setdefault("stage", service)
    return error


def time_left(service: str, timeout_s: float) -> float:
    """Return how many seconds a call may take, by `timeout_s` and the request's own deadline.

    Raises
    ------
    DeadlineExceeded
        None are left.
    """
    left_s = min(timeout_s, remaining_s())
    if left_s <= 0:
        raise DeadlineExceeded(f"no time was left for the stage {service}", stage=service)
    return left_s


def out_of_time(service: str) -> DeadlineExceeded:
    """Return the error of a service that takes too long."""
    return DeadlineExceeded(f"the stage {service} did not answer in time", stage=service)


def unavailable(service: str, why: str) -> StageUnavailable:
    """Return the error of a service that cannot answer."""
    return StageUnavailable(f"the stage {service} {why}", stage=service)
