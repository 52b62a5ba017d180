"""The service of proto/sparge.proto: every call is a question to the gateway."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Awaitable, Callable
from typing import Any

import grpc
from google.protobuf.message_factory import GetMessageClass

from services.grpc.backend import Gateway
from services.grpc.calls import CALLS, Call, read_answer
from services.grpc.generated import sparge_pb2 as pb
from services.grpc.status import REQUEST_ID_TRAILER, Failure
from shared.errors import InternalError, SpargeError
from shared.service.request_id import identified, request_id

DESCRIPTOR = pb.DESCRIPTOR.services_by_name["Sparge"]
SERVICE: str = DESCRIPTOR.full_name
_PASSED_ON = ("authorization", "x-api-key", "traceparent", "tracestate")
"""Metadata that are headers of the HTTP interface, too."""

log = logging.getLogger("sparge")
access = logging.getLogger("sparge.access")

Context = grpc.aio.ServicerContext[Any, Any]
Behaviour = Callable[[Any, Context], Awaitable[Any]]


def handlers(gateway: Gateway) -> grpc.GenericRpcHandler:
    """Return what answers the calls of the service."""
    return grpc.method_handlers_generic_handler(
        SERVICE,
        {
            method.name: grpc.unary_unary_rpc_method_handler(
                _behaviour(method.name, CALLS[method.name], gateway),
                request_deserializer=GetMessageClass(method.input_type).FromString,
                response_serializer=GetMessageClass(method.output_type).SerializeToString,
            )
            for method in DESCRIPTOR.methods
        },
    )


def _behaviour(name: str, call: Call, gateway: Gateway) -> Behaviour:
    async def behave(message: Any, context: Context) -> Any:
        started = time.perf_counter()
        given = dict(context.invocation_metadata() or ())
        identifier = identified(str(given.get(REQUEST_ID_TRAILER, "")))
        request_id.set(identifier)
        headers = {key: str(given[key]) for key in _PASSED_ON if key in given}
        status, code = grpc.StatusCode.CANCELLED, None
        try:
            reply = await _answer(call, message, gateway, identifier, headers, context)
            status = grpc.StatusCode.OK
        except asyncio.CancelledError:
            left_s = context.time_remaining()
            if left_s is not None and left_s <= 0:
                status = grpc.StatusCode.DEADLINE_EXCEEDED
            raise
        except Failure as failure:
            status, code = failure.status_code, failure.code
            await context.abort(status, failure.shortened(), failure.trailers())
        finally:
            _log(name, status, code, time.perf_counter() - started, context.peer())
        context.set_trailing_metadata(((REQUEST_ID_TRAILER, identifier),))
        return reply

    return behave


async def _answer(
    call: Call,
    message: Any,
    gateway: Gateway,
    identifier: str,
    headers: dict[str, str],
    context: Context,
) -> Any:
    """Return the call's answer, or raise the `Failure` that it is answered with."""
    try:
        asked = await asyncio.to_thread(call.ask, message)
        answer = await gateway.ask(asked, identifier, headers, context.time_remaining())
        media_type = answer.headers.get("content-type", "")
        return await asyncio.to_thread(read_answer, call, media_type, answer.content)
    except Failure:
        raise
    except SpargeError as error:
        raise Failure.of(error, identifier) from None
    except Exception:
        log.exception("unhandled error in call %s", identifier)
        fault = InternalError("an internal error; the log has it under this request id")
        raise Failure.of(fault, identifier) from None


def _log(name: str, status: grpc.StatusCode, code: str | None, seconds: float, peer: str) -> None:
    ms = round(1e3 * seconds, 3)
    access.info(
        "grpc %s %s in %.0f ms",
        *(name, status.name, ms),
        extra={
            "service": "grpc",
            "route": name,
            "status": status.name,
            "ms": ms,
            "client": peer,
            **({"code": code} if code else {}),
        },
    )
