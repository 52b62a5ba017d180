"""An OpenTelemetry collector on the loopback: it keeps the spans that are sent to it."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import pytest
from opentelemetry.proto.collector.trace.v1.trace_service_pb2 import ExportTraceServiceRequest

from shared.service import tracing


@dataclass(frozen=True)
class Span:
    """What the tests ask of a span; ids as bytes."""

    service: str
    name: str
    kind: int
    trace: bytes
    id: bytes
    parent: bytes
    attributes: dict[str, Any]


SERVER, CLIENT = 2, 3  # of OTLP's SpanKind


@dataclass
class Collector:
    """Where it listens and what it got."""

    url: str = ""
    spans: list[Span] = field(default_factory=list)

    def take(self, body: bytes) -> None:
        request = ExportTraceServiceRequest()
        request.ParseFromString(body)
        for sent in request.resource_spans:
            service = _plain(sent.resource.attributes)["service.name"]
            for scope in sent.scope_spans:
                self.spans += [
                    Span(
                        service,
                        each.name,
                        each.kind,
                        each.trace_id,
                        each.span_id,
                        each.parent_span_id,
                        _plain(each.attributes),
                    )
                    for each in scope.spans
                ]


@contextlib.contextmanager
def traced() -> Iterator[Collector]:
    """Configure traces in this process, and give the collector that they are sent to."""
    with pytest.MonkeyPatch.context() as environment, collecting() as collector:
        environment.setenv("OTEL_EXPORTER_OTLP_ENDPOINT", collector.url)
        environment.setattr(tracing, "_serving", 0)  # the backend of other tests may still run
        tracing._processor.cache_clear()
        try:
            yield collector
        finally:
            if (processor := tracing._processor()) is not None:
                processor.shutdown()  # type: ignore[no-untyped-call]  # of the SDK
            tracing._processor.cache_clear()


@contextlib.contextmanager
def collecting() -> Iterator[Collector]:
    """Run a collector; its URL is what OTEL_EXPORTER_OTLP_ENDPOINT takes."""
    collector = Collector()

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            collector.take(self.rfile.read(int(self.headers["Content-Length"])))
            self.send_response(200)
            self.end_headers()

        def log_request(self, *_: Any) -> None:
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        collector.url = f"http://127.0.0.1:{server.server_port}"
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield collector
        finally:
            server.shutdown()
            thread.join()


def _plain(attributes: Any) -> dict[str, Any]:
    return {each.key: getattr(each.value, each.value.WhichOneof("value")) for each in attributes}
