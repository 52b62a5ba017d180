"""What a request leaves behind: metrics, `Server-Timing`, one trace through all stages."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from prometheus_client import CollectorRegistry
from prometheus_client.parser import text_string_to_metric_families

from services.gateway.metrics import REASONS, GraspMetrics
from services.wiring import create_app
from shared.schemas.task import Reason
from tests.support.collector import CLIENT, SERVER, traced
from tests.support.samples import sample_path
from tests.support.serving import Client, in_process

NPZ = "application/x-npz"
BOTTLE = sample_path("bottle").read_bytes()
ROOT = Path(__file__).parents[3]
STAGES = ("checks", "perception", "primitive_recovery", "reasoning", "matching", "grasp_proposal")


def grasp(backend: Client, accept: str = "application/json", **query: str) -> dict[str, str]:
    response = backend.request(
        "POST",
        "/grasp",
        params={"task": "pouring", **query},
        content=BOTTLE,
        headers={"Content-Type": NPZ, "Accept": accept},
    )
    return dict(response.headers)


def sample(backend: Client, name: str, **labels: str) -> float:
    """Return the value of one sample, 0 where it is not there yet."""
    for family in text_string_to_metric_families(backend.request("GET", "/metrics").text):
        for each in family.samples:
            if each.name == name and each.labels == labels:
                return each.value
    return 0.0


@pytest.mark.parametrize("accept", ["application/json", NPZ])
def test_server_timing_names_every_stage(backend: Client, accept: str) -> None:
    header = grasp(backend, accept)["server-timing"]
    assert re.fullmatch(r"(\w+;dur=\d+\.\d(, |$))+", header)
    entries = dict(re.findall(r"(\w+);dur=(\S+?)(?:,|$)", header))
    assert set(entries) == {"parsing", *STAGES, "total"}
    assert all(0 <= float(spent) <= float(entries["total"]) for spent in entries.values())


def test_other_answers_have_their_total(backend: Client) -> None:
    for path in ("/tasks", "/nowhere"):
        header = backend.request("GET", path).headers["server-timing"]
        assert re.fullmatch(r"total;dur=\d+\.\d", header)


def test_an_answer_is_counted_by_stage_and_outcome(backend: Client) -> None:
    def counts() -> list[float]:
        found = {"reasoning": "v2", "found": "true", "reason": ""}
        missed = {"reasoning": "v1", "found": "false", "reason": "no_part_matches"}
        return [
            *(sample(backend, "sparge_stage_seconds_count", stage=each) for each in STAGES[:3]),
            sample(backend, "sparge_answers_total", **found),
            sample(backend, "sparge_answer_grasps_sum", reasoning="v2"),
            sample(backend, "sparge_answers_total", **missed),
            sample(
                backend,
                "sparge_stage_errors_total",
                stage="reasoning",
                code="unknown_task",
            ),
            sample(backend, "sparge_errors_total", service="gateway", code="unknown_task"),
        ]

    before = counts()
    grasp(backend, max_grasps="3")
    grasp(backend, task="turning", reasoning="v1")
    grasp(backend, task="juggling")
    added = [now - then for now, then in zip(counts(), before, strict=True)]
    assert added == [3, 3, 2, 1, 3, 1, 1, 1]


def test_the_stages_of_this_process_are_among_the_metrics(backend: Client) -> None:
    labels = {"service": "perception", "route": "/perceive", "status": "200"}
    before = sample(backend, "sparge_requests_total", **labels)
    grasp(backend)
    assert sample(backend, "sparge_requests_total", **labels) == before + 1


def test_reasons_are_those_that_are_documented() -> None:
    table = re.findall(r"^\| `(\w+)` \|", (ROOT / "docs" / "reasons.md").read_text(), re.MULTILINE)
    assert set(table) == REASONS


def test_an_unknown_reason_makes_no_new_series() -> None:
    registry = CollectorRegistry()
    odd = Reason(code="forged", message="")
    GraspMetrics(registry).answered("v2", found=False, reason=odd, grasps=0)
    labels = {"reasoning": "v2", "found": "false", "reason": "other"}
    assert registry.get_sample_value("sparge_answers_total", labels) == 1


def test_a_grasp_is_one_trace_through_every_stage(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", str(tmp_path))
    with traced() as collector, in_process(create_app()) as backend:
        grasp(backend)
    (root,) = [each for each in collector.spans if not each.parent]
    assert (root.service, root.name, root.kind) == ("sparge-gateway", "POST /grasp", SERVER)
    assert root.attributes["sparge.task"] == "pouring"
    assert root.attributes["sparge.reasoning"] == "v2"
    assert root.attributes["sparge.found"] is True
    assert {each.trace for each in collector.spans} == {root.trace}
    calls = {each.id: each for each in collector.spans if each.kind == CLIENT}
    assert all(each.parent == root.id for each in calls.values())
    stages = {each.service for each in collector.spans if each.kind == SERVER and each != root}
    assert stages == {
        f"sparge-{each}"
        for each in ("perception", "primitive_recovery", "reasoning", "grasp_proposal", "matching")
    }
    for each in collector.spans:
        if each.kind == SERVER and each != root:
            assert calls[each.parent].name == each.name
