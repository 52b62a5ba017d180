"""Metrics: what every service counts, and several services in one process."""

from __future__ import annotations

from prometheus_client.parser import text_string_to_metric_families

from shared.service.exchange import Exchange
from shared.service.server_timing import server_timing
from shared.service.telemetry import Metrics


def exposed(metrics: Metrics) -> dict[tuple[str, tuple[tuple[str, str], ...]], float]:
    """Return every sample; the parser refuses a family that comes twice."""
    text = bytes(metrics.expose().body).decode()
    families = list(text_string_to_metric_families(text))
    assert len({each.name for each in families}) == len(families)
    return {
        (each.name, tuple(sorted(each.labels.items()))): each.value
        for family in families
        for each in family.samples
    }


def an_exchange(route: str = "/select", status: int = 200, code: str | None = None) -> Exchange:
    return Exchange("POST", route, status, 0.02, 10, 20, "127.0.0.1", code)


def test_services_of_one_process_are_exposed_together() -> None:
    gateway, stage = Metrics("gateway"), Metrics("matching")
    gateway.join(stage)
    gateway.observe(an_exchange("/grasp"))
    stage.observe(an_exchange())
    stage.observe(an_exchange(status=422, code="invalid_input"))
    found = exposed(gateway)

    def requests(service: str, route: str, status: str) -> float:
        labels = (("route", route), ("service", service), ("status", status))
        return found["sparge_requests_total", labels]

    assert requests("gateway", "/grasp", "200") == 1
    assert requests("matching", "/select", "200") == 1
    assert requests("matching", "/select", "422") == 1
    errors = (("code", "invalid_input"), ("service", "matching"))
    assert found["sparge_errors_total", errors] == 1
    assert not any("grasp" in str(labels) for _, labels in exposed(stage)), "not the other way"


def test_the_process_is_there_once() -> None:
    gateway = Metrics("gateway")
    for name in ("perception", "reasoning"):
        gateway.join(Metrics(name))
    text = bytes(gateway.expose().body).decode()
    assert text.count("\nprocess_resident_memory_bytes ") == 1
    assert text.count("\nprocess_cpu_seconds_total ") == 1
    assert "python_gc_collections_total" in text


def test_server_timing_is_in_milliseconds() -> None:
    assert server_timing({"perception": 12.3456, "total": 20.0}) == (
        "perception;dur=12.3, total;dur=20.0"
    )
