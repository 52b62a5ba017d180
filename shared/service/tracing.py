"""OpenTelemetry traces: nothing unless an endpoint is configured in the environment.

FastAPI itself makes the span of each request once it is given a provider, and continues
the trace that the request names. Here are the provider and the span of a call to a stage.
"""

from __future__ import annotations

import functools
import logging
import os
import threading
from collections.abc import AsyncIterator, Iterator, MutableMapping
from contextlib import asynccontextmanager, contextmanager
from typing import TYPE_CHECKING, Any

import httpx
from fastapi.telemetry import TelemetryConfig
from opentelemetry import propagate, trace
from starlette.concurrency import run_in_threadpool

from shared import __version__
from shared.schemas.route import Route
from shared.service.exchange import POLLED
from shared.service.request_id import request_id

if TYPE_CHECKING:
    from opentelemetry.sdk.trace.export import BatchSpanProcessor

ENDPOINTS = ("OTEL_EXPORTER_OTLP_ENDPOINT", "OTEL_EXPORTER_OTLP_TRACES_ENDPOINT")
PROTOCOLS = ("OTEL_EXPORTER_OTLP_TRACES_PROTOCOL", "OTEL_EXPORTER_OTLP_PROTOCOL")
_FLUSH_S = 2.0

log = logging.getLogger("sparge")
_serving = 0
"""The services of this process that are running."""


def configured() -> bool:
    """Say whether the environment asks for traces."""
    wanted = any(os.environ.get(name) for name in ENDPOINTS)
    switched_off = (
        os.environ.get("OTEL_SDK_DISABLED", "").lower() == "true"
        or os.environ.get("OTEL_TRACES_EXPORTER", "") == "none"
    )
    return wanted and not switched_off


def tracer_provider(service: str) -> trace.TracerProvider | None:
    """Return what makes the spans of `service`, or None where no traces are asked for.

    The service is called `sparge-NAME` in traces, also where several share a process,
    unless OTEL_SERVICE_NAME says otherwise; all of them send through one exporter.
    """
    if not configured() or (processor := _processor()) is None:
        return None
    from opentelemetry.sdk.resources import SERVICE_NAME, SERVICE_VERSION, Resource
    from opentelemetry.sdk.trace import TracerProvider

    named = {} if os.environ.get("OTEL_SERVICE_NAME") else {SERVICE_NAME: f"sparge-{service}"}
    resource = Resource.create({SERVICE_VERSION: __version__, **named})
    provider = TracerProvider(resource=resource, shutdown_on_exit=False)
    provider.add_span_processor(processor)
    return provider


def telemetry(provider: trace.TracerProvider | None) -> TelemetryConfig:
    """Return what FastAPI is to do: a span per request, but for what machines poll."""
    return {
        "tracer_provider": provider,
        "tracing": True,
        "metrics": False,
        "logs": False,
        "operation_spans": False,
        "auto_configure": False,
        "exclude": _is_polled,
    }


@contextmanager
def calling(
    tracer: trace.Tracer, route: Route[Any, Any], where: httpx.URL | str
) -> Iterator[trace.Span]:
    """Give the span of a call to `route`; the call's headers are made within (`inject`).

    `where` is the service's URL, or its name where it is called without a network.
    """
    attributes: dict[str, str | int] = {
        "http.request.method": route.method,
        "url.template": route.path,
    }
    if isinstance(where, str):
        attributes["server.address"] = where
    else:
        attributes["server.address"] = where.host
        attributes["server.port"] = where.port or (443 if where.scheme == "https" else 80)
    with tracer.start_as_current_span(
        f"{route.method} {route.path}",
        kind=trace.SpanKind.CLIENT,
        attributes=attributes,
        record_exception=False,
        set_status_on_exception=False,
    ) as span:
        try:
            yield span
        except BaseException as error:
            span.set_attribute("error.type", type(error).__name__)
            span.set_status(trace.StatusCode.ERROR)
            raise


@contextmanager
def answering(tracer: trace.Tracer, route: Route[Any, Any]) -> Iterator[trace.Span]:
    """Give the span of a message that was handed over, as FastAPI does for a request."""
    attributes = {
        "http.request.method": route.method,
        "http.route": route.path,
        "sparge.request_id": request_id.get(),
    }
    with tracer.start_as_current_span(
        f"{route.method} {route.path}", kind=trace.SpanKind.SERVER, attributes=attributes
    ) as span:
        yield span


def answered(span: trace.Span, url: str, status_code: int) -> None:
    """Note what was asked, and the status of the answer."""
    span.set_attribute("url.full", url)
    span.set_attribute("http.response.status_code", status_code)
    if status_code >= 400:
        span.set_attribute("error.type", str(status_code))
        span.set_status(trace.StatusCode.ERROR)


def inject(headers: dict[str, str]) -> dict[str, str]:
    """Return `headers` with the current span's `traceparent`, if there is one."""
    propagate.inject(headers)
    return headers


@asynccontextmanager
async def exporting() -> AsyncIterator[None]:
    """Send the spans that wait when the last service of this process ends.

    For two seconds at most: a collector that is down delays no stop.
    """
    global _serving
    _serving += 1
    try:
        yield
    finally:
        _serving -= 1
        if not _serving and configured() and (processor := _processor()) is not None:
            sending = threading.Thread(target=processor.force_flush, daemon=True)
            sending.start()
            await run_in_threadpool(sending.join, _FLUSH_S)


@functools.cache
def _processor() -> BatchSpanProcessor | None:
    """Return the one exporter of this process; None, with a warning, where it cannot be."""
    protocol = next(filter(None, map(os.environ.get, PROTOCOLS)), "http/protobuf")
    if protocol != "http/protobuf":
        log.warning("traces are sent as http/protobuf only, not as %s: none are sent", protocol)
        return None
    try:
        from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter
        from opentelemetry.sdk.trace.export import BatchSpanProcessor
    except ImportError as error:
        log.warning(
            "an OpenTelemetry endpoint is configured, but traces cannot be sent: %s; "
            "install the extra with `pip install 'sparge[tracing]'`",
            error,
        )
        return None
    return BatchSpanProcessor(OTLPSpanExporter())


def _is_polled(scope: MutableMapping[str, Any]) -> bool:
    return scope.get("path") in POLLED
