"""The gateway behind the gRPC server, asked over HTTP: through a socket or in this process."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Mapping

import httpx
import orjson

from services.grpc.request import HttpRequest, get
from services.grpc.status import Failure
from shared.deadline import DEADLINE_HEADER
from shared.errors import DeadlineExceeded, SpargeError, StageUnavailable
from shared.service.request_id import REQUEST_ID_HEADER

_HEALTH_TIMEOUT_S = 3.0


class Gateway:
    """Sends requests to the gateway.

    Parameters
    ----------
    http : httpx.AsyncClient
        With the base URL and the transport; closed by whoever made it.
    timeout_s : float
        How long an answer may take where the request does not say.
    """

    def __init__(self, http: httpx.AsyncClient, timeout_s: float) -> None:
        self._http = http
        self._timeout_s = timeout_s

    async def ask(
        self,
        request: HttpRequest,
        request_id: str,
        headers: Mapping[str, str],
        left_s: float | None = None,
    ) -> httpx.Response:
        """Return the gateway's answer of status 200.

        Parameters
        ----------
        headers : mapping
            Of the caller: its key, its trace.
        left_s : float, optional
            How much time there is; the gateway is told.

        Raises
        ------
        Failure
            What the gateway answered with, or why it gave no answer.
        """
        sent = {**headers, REQUEST_ID_HEADER: request_id, "Accept": request.accept}
        if request.content_type is not None:
            sent["Content-Type"] = request.content_type
        if left_s is not None:
            sent[DEADLINE_HEADER] = f"{max(left_s, 0.0):.3f}"
        try:
            async with asyncio.timeout(self._timeout_s if left_s is None else left_s):
                answer = await self._http.request(
                    request.method,
                    request.url,
                    params=request.params,
                    content=request.content,
                    files=request.files,
                    headers=sent,
                )
        except TimeoutError:
            late = DeadlineExceeded("the gateway did not answer in time", stage="gateway")
            raise Failure.of(late, request_id) from None
        except httpx.RequestError as error:
            raise _unavailable(f"cannot be reached ({type(error).__name__})", request_id) from None
        if answer.status_code != 200:
            raise _failure(answer, request_id)
        return answer

    async def ready(self) -> bool:
        """Tell whether `/health/ready` answers 200."""
        try:
            await self.ask(get("/health/ready"), "health", {}, _HEALTH_TIMEOUT_S)
        except Failure:
            return False
        return True

    async def wants_keys(self) -> bool:
        """Tell whether a request without an API key is refused.

        Raises
        ------
        SpargeError
            The gateway gives no answer.
        """
        try:
            await self.ask(get("/version"), "keys", {}, _HEALTH_TIMEOUT_S)
        except Failure as refused:
            if refused.http_status == 401:
                return True
            raise StageUnavailable(refused.message, stage="gateway") from None
        return False


def _failure(answer: httpx.Response, request_id: str) -> Failure:
    """Return the failure that an answer is, as its envelope says it."""
    try:
        said = orjson.loads(answer.content)["error"]
        retry_after = answer.headers.get("retry-after")
        return Failure(
            http_status=answer.status_code,
            code=str(said["code"]),
            message=str(said["message"]),
            details=dict(said["details"]),
            request_id=str(said["request_id"]),
            retry_after_s=None if retry_after is None else math.ceil(float(retry_after)),
        )
    except (KeyError, TypeError, ValueError):
        return _unavailable(f"answered {answer.status_code}; is its URL right?", request_id)


def _unavailable(why: str, request_id: str) -> Failure:
    error: SpargeError = StageUnavailable(f"the gateway {why}", stage="gateway")
    return Failure.of(error, request_id)
