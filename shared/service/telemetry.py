"""Prometheus metrics, one registry per application: several may share a process."""

from __future__ import annotations

from collections.abc import Callable

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram
from prometheus_client.exposition import CONTENT_TYPE_LATEST, generate_latest
from starlette.responses import Response
from starlette.types import Scope

from shared.service.admission import Admission

_BUCKETS = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0)


class Metrics:
    """Requests and their latency by route, and whatever an application adds."""

    def __init__(self, service: str) -> None:
        self.registry = CollectorRegistry()
        self._requests = Counter(
            "sparge_requests_total",
            "Requests answered",
            ["service", "route", "status"],
            registry=self.registry,
        )
        self._seconds = Histogram(
            "sparge_request_seconds",
            "Time to answer",
            ["service", "route"],
            buckets=_BUCKETS,
            registry=self.registry,
        )
        self._service = service

    def watch(self, admission: Admission) -> None:
        """Show the queue as it is whenever the metrics are read."""
        shown: tuple[tuple[str, str, Callable[[], float]], ...] = (
            ("sparge_queue_depth", "Requests that wait", lambda: admission.waiting),
            ("sparge_queue_running", "Requests that are worked on", lambda: admission.running),
            ("sparge_queue_wait_seconds", "Expected wait", admission.expected_wait_s),
        )
        for name, text, value in shown:
            gauge = Gauge(name, text, ["service"], registry=self.registry)
            gauge.labels(self._service).set_function(value)
        rejected = Counter(
            "sparge_queue_rejected_total",
            "Requests refused at once because the queue was full or too slow",
            ["service"],
            registry=self.registry,
        ).labels(self._service)
        admission.on_refusal = rejected.inc

    def observe(self, scope: Scope, status: int, seconds: float) -> None:
        """Count one request under its route's template, so that ids make no new series."""
        route = getattr(scope.get("route"), "path", "unmatched")
        self._requests.labels(self._service, route, str(status)).inc()
        self._seconds.labels(self._service, route).observe(seconds)

    def expose(self) -> Response:
        """Return the metrics in Prometheus' text format."""
        return Response(generate_latest(self.registry), media_type=CONTENT_TYPE_LATEST)
