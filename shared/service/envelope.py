"""One error envelope for everything that can go wrong."""

from __future__ import annotations

from collections.abc import Callable

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, Response
from pydantic import BaseModel
from starlette.exceptions import HTTPException
from starlette.types import Scope

from shared.errors import (
    InvalidInput,
    JsonObject,
    MalformedRequest,
    MethodNotAllowed,
    NoSuchPath,
    SpargeError,
)
from shared.service.exchange import ERROR_CODE
from shared.service.request_id import request_id


class ErrorBody(BaseModel):
    """What went wrong."""

    code: str
    message: str
    details: dict[str, object]
    request_id: str


class ErrorEnvelope(BaseModel):
    """The body of every error answer of every service."""

    error: ErrorBody


ErrorBodyOf = Callable[[SpargeError, str, str], JsonObject]
"""Error, request id, path -> the JSON body of the answer."""


def error_response(error: SpargeError, request_id: str, scope: Scope | None = None) -> Response:
    """Return the answer for `error`, to the request of an ASGI scope.

    Its body is the contract's envelope, unless the application speaks another protocol on
    that path (`error_body` of `create_base`).
    """
    retry_after_s = error.details.get("retry_after_s", error.retry_after_s)
    headers = {} if retry_after_s is None else {"Retry-After": str(retry_after_s)}
    if error.status == 401:
        headers["WWW-Authenticate"] = "Bearer"
    body_of: ErrorBodyOf | None = scope["app"].state.error_body if scope else None
    if scope is None or body_of is None:
        body = error.envelope(request_id)
    else:
        body = body_of(error, request_id, scope["path"])
    return JSONResponse(body, status_code=error.status, headers=headers)


def install_error_handlers(app: FastAPI) -> None:
    """Answer every error that a route raises with the envelope."""

    @app.exception_handler(SpargeError)
    async def known(request: Request, error: SpargeError) -> Response:
        return _answered(request, error)

    @app.exception_handler(RequestValidationError)
    async def unvalidated(request: Request, error: RequestValidationError) -> Response:
        problems = [
            {"field": ".".join(map(str, each["loc"])), "problem": each["msg"]}
            for each in error.errors()
        ]
        shown = "; ".join(f"{each['field']}: {each['problem']}" for each in problems[:5])
        return _answered(
            request, InvalidInput(f"the request is not valid: {shown}", fields=problems)
        )

    @app.exception_handler(HTTPException)
    async def plain(request: Request, error: HTTPException) -> Response:
        place = f"{request.method} {request.url.path}"
        translated: SpargeError
        if error.status_code == 404:
            translated = NoSuchPath(f"there is no {place} here", path=request.url.path)
        elif error.status_code == 405:
            translated = MethodNotAllowed(f"{place} is not possible", method=request.method)
        else:
            translated = MalformedRequest(str(error.detail))
        return _answered(request, translated)


def _answered(request: Request, error: SpargeError) -> Response:
    request.scope[ERROR_CODE] = error.code
    return error_response(error, request_id.get(), request.scope)
