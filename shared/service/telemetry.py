"""Prometheus metrics, one registry per application: several may share a process."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from prometheus_client import REGISTRY, CollectorRegistry, Counter, Gauge, Histogram
from prometheus_client.exposition import CONTENT_TYPE_LATEST, generate_latest
from prometheus_client.metrics_core import Metric
from prometheus_client.registry import Collector
from starlette.responses import Response

from shared.service.admission import Admission
from shared.service.exchange import Exchange

_BUCKETS = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0)


class Metrics:
    """Requests, their latency and errors by route, and whatever an application adds."""

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
        self._errors = Counter(
            "sparge_errors_total",
            "Requests answered with an error, by its code",
            ["service", "code"],
            registry=self.registry,
        )
        self._service = service
        self._registries = [self.registry]

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

    def observe(self, exchange: Exchange) -> None:
        """Count one request under its route's template."""
        self._requests.labels(self._service, exchange.route, str(exchange.status)).inc()
        self._seconds.labels(self._service, exchange.route).observe(exchange.seconds)
        if exchange.error_code is not None:
            self._errors.labels(self._service, exchange.error_code).inc()

    def join(self, other: Metrics) -> None:
        """Expose the metrics of another application of this process as well."""
        self._registries.append(other.registry)

    def expose(self) -> Response:
        """Return the metrics in Prometheus' text format, with the process's own beside them.

        Those (memory, processor time, garbage collection) are in prometheus_client's
        default registry, once per process.
        """
        text = generate_latest(_Joined([*self._registries, REGISTRY]))
        return Response(text, media_type=CONTENT_TYPE_LATEST)


class _Joined(Collector):
    """Several registries as one: the format allows each family of metrics only once."""

    def __init__(self, registries: Iterable[CollectorRegistry]) -> None:
        self._registries = registries

    def collect(self) -> Iterable[Metric]:
        families: dict[str, Metric] = {}
        for registry in self._registries:
            for family in registry.collect():
                held = families.setdefault(
                    family.name, Metric(family.name, family.documentation, family.type, family.unit)
                )
                held.samples.extend(family.samples)
        return families.values()
