"""The typed client: a `Route` and a message in, a message or an error of the tree out.

It is given an `httpx.AsyncClient` and does not know whether that speaks over a
socket or calls an application in this process. In-process transports know no
timeouts, so the deadline is kept here.
"""

from __future__ import annotations

import asyncio
from typing import TypeVar

import httpx
import orjson

from shared.errors import (
    DeadlineExceeded,
    MethodNotAllowed,
    NoSuchPath,
    SpargeError,
    StageUnavailable,
    error_from_envelope,
)
from shared.schemas.route import Route
from shared.service.app import Health
from shared.service.request_id import REQUEST_ID_HEADER, request_id
from shared.wire import NPZ, Message, decode, encode

In = TypeVar("In", bound=Message)
Out = TypeVar("Out", bound=Message)

_MAX_ANSWER_BYTES = 512 * 2**20


class StageClient:
    """Calls one service.

    Parameters
    ----------
    service : str
        Its name, for messages.
    http : httpx.AsyncClient
        With the base URL and the transport; closed by whoever made it.
    """

    def __init__(self, service: str, http: httpx.AsyncClient) -> None:
        self.service = service
        self._http = http

    async def call(self, route: Route[In, Out], request: In, timeout_s: float) -> Out:
        """Send `request`, return the answer.

        Raises
        ------
        SpargeError
            What the service answered with, for errors of the input.
        StageUnavailable
            It cannot be reached, failed, or answered nonsense.
        DeadlineExceeded
            No answer within `timeout_s` seconds.
        """
        path = route.path
        for name in type(request).model_fields:
            path = path.replace(f"{{{name}}}", str(getattr(request, name)))
        posts = route.method == "POST"
        try:
            async with asyncio.timeout(max(timeout_s, 0.0)):
                response = await self._http.request(
                    route.method,
                    path,
                    content=encode(request, NPZ) if posts else None,
                    headers={
                        "Accept": NPZ,
                        REQUEST_ID_HEADER: request_id.get(),
                        **({"Content-Type": NPZ} if posts else {}),
                    },
                )
        except (TimeoutError, httpx.TimeoutException):
            raise DeadlineExceeded(
                f"the stage {self.service} did not answer in time", stage=self.service
            ) from None
        except httpx.TransportError as error:
            raise self._unavailable(f"cannot be reached ({type(error).__name__})") from None
        if response.status_code != 200:
            raise self._error(response)
        try:
            media_type = response.headers.get("content-type", "")
            return decode(route.response, response.content, media_type, _MAX_ANSWER_BYTES)
        except SpargeError as error:
            raise self._unavailable(f"answered nonsense: {error.message}") from None

    async def health(self, timeout_s: float) -> Health:
        """Ask `/health/ready`; a service that does not answer has status `failed`."""
        try:
            async with asyncio.timeout(timeout_s):
                response = await self._http.get("/health/ready")
            return Health.model_validate_json(response.content)
        except (TimeoutError, httpx.HTTPError, ValueError) as error:
            message = str(error) or type(error).__name__
            return Health(status="failed", service=self.service, details={"error": message})

    def _error(self, response: httpx.Response) -> SpargeError:
        try:
            error = error_from_envelope(response.status_code, orjson.loads(response.content))
        except orjson.JSONDecodeError:
            error = None
        if error is None or isinstance(error, NoSuchPath | MethodNotAllowed):
            return self._unavailable(f"answered {response.status_code}; is its URL right?")
        if error.status >= 500 and not isinstance(error, StageUnavailable | DeadlineExceeded):
            return self._unavailable(f"failed: {error.message}")
        error.details.setdefault("stage", self.service)
        return error

    def _unavailable(self, why: str) -> StageUnavailable:
        return StageUnavailable(f"the stage {self.service} {why}", stage=self.service)
