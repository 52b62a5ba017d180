"""The Grafana dashboard asks only for metrics and labels that a backend has."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from prometheus_client.parser import text_string_to_metric_families

from tests.support.samples import sample_path
from tests.support.serving import Client

FILE = Path(__file__).parents[3] / "docker" / "grafana" / "sparge.json"
OF_PROMETHEUS = {"job", "instance", "le"}
ROWS = (
    "Traffic",
    "Errors by code",
    "Time per stage, as the gateway sees it",
    "Answers",
    "Queue",
    "Processes",
)


@pytest.fixture(scope="module")
def dashboard() -> dict[str, Any]:
    held: dict[str, Any] = json.loads(FILE.read_text())
    return held


@pytest.fixture(scope="module")
def labels(backend: Client) -> dict[str, set[str]]:
    """The labels of every sample that a backend exposes, by name, after three requests."""
    for query in ({"task": "pouring"}, {"task": "juggling"}):
        backend.request(
            "POST",
            "/grasp",
            params=query,
            content=sample_path("bottle").read_bytes(),
            headers={"Content-Type": "application/x-npz"},
        )
    found: dict[str, set[str]] = {}
    for family in text_string_to_metric_families(backend.request("GET", "/metrics").text):
        for sample in family.samples:
            found.setdefault(sample.name, set()).update(sample.labels)
    return found


def queries(dashboard: dict[str, Any]) -> Iterator[str]:
    for panel in dashboard["panels"]:
        for target in panel.get("targets", ()):
            yield target["expr"]


def test_it_has_its_rows_and_a_data_source_to_choose(dashboard: dict[str, Any]) -> None:
    assert [p["title"] for p in dashboard["panels"] if p["type"] == "row"] == list(ROWS)
    (source, _) = dashboard["templating"]["list"]
    assert (source["type"], source["query"]) == ("datasource", "prometheus")
    panels = [panel for panel in dashboard["panels"] if panel["type"] != "row"]
    assert {panel["datasource"]["uid"] for panel in panels} == {"${datasource}"}
    numbers = [panel["id"] for panel in dashboard["panels"]]
    assert len(set(numbers)) == len(numbers)


def test_no_two_panels_lie_on_each_other(dashboard: dict[str, Any]) -> None:
    taken: set[tuple[int, int]] = set()
    for panel in dashboard["panels"]:
        place = panel["gridPos"]
        assert place["x"] + place["w"] <= 24
        cells = {
            (place["x"] + x, place["y"] + y) for x in range(place["w"]) for y in range(place["h"])
        }
        assert not cells & taken
        taken |= cells


def test_every_metric_is_exposed(dashboard: dict[str, Any], labels: dict[str, set[str]]) -> None:
    asked = {name for each in queries(dashboard) for name in metrics_of(each)}
    queue = {"sparge_queue_depth", "sparge_queue_rejected_total"}
    assert len(asked) > 10
    assert asked - set(labels) <= queue
    assert asked >= {*queue, "sparge_stage_seconds_bucket", "process_resident_memory_bytes"}


def test_every_label_is_one_of_its_metric(
    dashboard: dict[str, Any], labels: dict[str, set[str]]
) -> None:
    for each in queries(dashboard):
        for name, selector in metrics_of(each).items():
            known = labels.get(name, {"service"}) | OF_PROMETHEUS
            assert set(re.findall(r"(\w+)[!=]~?\"", selector)) <= known, each
            for group in re.findall(r"by \(([^)]*)\)", each):
                assert set(re.split(r", *", group)) <= known, each


def metrics_of(query: str) -> dict[str, str]:
    """Return the selector of each metric in a query, by name."""
    return dict(re.findall(r"\b((?:sparge|process|python)_\w+)(\{[^}]*\})", query))
