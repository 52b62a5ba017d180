"""The disk of the knowledge, full or read-only: changes are refused, everything else goes on."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from services.gateway.app import create_app
from services.gateway.settings import GatewaySettings
from services.reasoning.change import Learned
from services.reasoning.journal import Journal
from services.wiring import create_stage
from tests.faults.conftest import DEADLINE_S, Backend
from tests.support.asking import REQUESTS, failed
from tests.support.disk import Disk, FailingCalls, small_disk
from tests.support.serving import serving

LONG = "watering_" + "x" * 50
"""So that each of the changes below needs more room than a small one that does not fit."""
TASK = {"name": LONG, "requires": ["contain"], "grasp": ["wrap_grasp"]}
WITH_A_TASK = """
@prefix : <https://example.org/sparge#> .
:imported a :Task ; :requiresAffordance :contain ; :hasGraspAffordance :wrap_grasp .
"""
ROUND = {"name": "is_round", "conditions": [{"condition": "shape", "value": ["sphere"]}]}
CHANGES: dict[str, tuple[str, str, dict[str, Any] | None]] = {
    "add a task": ("POST", "/tasks", {**TASK, "name": "another"}),
    "delete a task": ("DELETE", f"/tasks/{LONG}", None),
    "add a rule": ("POST", "/rules", {**ROUND, "affordance": "contain"}),
    "add an affordance": ("POST", "/affordances", {"name": "rollable", "rules": [ROUND]}),
    "import": ("POST", "/knowledge?replace=true", {"turtle": WITH_A_TASK}),
}


@pytest.fixture(params=["mounted", "system calls"])
def disk(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Disk]:
    if request.param == "mounted":
        with small_disk(tmp_path) as mounted:
            yield mounted
    else:
        yield FailingCalls(tmp_path, monkeypatch)


@pytest.fixture
def gateway(
    backend: Backend, disk: Disk, monkeypatch: pytest.MonkeyPatch
) -> Iterator[httpx.Client]:
    """A gateway whose reasoning keeps its knowledge on that disk."""
    monkeypatch.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", str(disk.folder / "knowledge"))
    urls: dict[str, Any] = {f"{name}_url": stage.url for name, stage in backend.stages.items()}
    with contextlib.ExitStack() as stack:
        reasoning = stack.enter_context(warm_reasoning())
        settings = GatewaySettings(**{**urls, "reasoning_url": reasoning}, deadline_s=10)
        url = stack.enter_context(serving(create_app(settings)))
        yield stack.enter_context(httpx.Client(base_url=url, timeout=60))


@contextlib.contextmanager
def warm_reasoning() -> Iterator[str]:
    with serving(create_stage("reasoning")) as url, httpx.Client(base_url=url) as http:
        while http.get("/health/ready").status_code != 200:
            time.sleep(0.02)
        yield url


def known(gateway: httpx.Client) -> set[str]:
    """What was learned, as the gateway says: tasks and rules."""
    tasks, rules = gateway.get("/tasks").json()["tasks"], gateway.get("/rules").json()["rules"]
    return {each["name"] for each in (*tasks, *rules) if not each.get("builtin")}


def stored(disk: Disk) -> set[str]:
    """What was learned, as the disk says."""
    journal, learned = Journal(disk.folder / "knowledge"), Learned()
    for change in journal.news():
        learned.apply(change)
    journal.close()
    return {*learned.tasks, *learned.rules}


def fill_what_is_left(gateway: httpx.Client) -> set[str]:
    """Add the smallest tasks there are until one does not fit; return their names."""
    for number in range(500):
        response = gateway.post("/tasks", json={"name": f"t{number}", "grasp": ["grasp"]})
        if response.status_code != 200:
            return {f"t{each}" for each in range(number)}
    raise AssertionError("the disk is not full")


def decides(gateway: httpx.Client, task: str) -> None:
    path, body = REQUESTS["reasoning"]
    response = gateway.post(path, json={**body, "task": task, "max_grasps": 0})
    assert response.status_code == 200, response.text


@pytest.mark.parametrize("trouble", ["full", "read_only"])
def test_changes_are_refused_whole_and_everything_else_goes_on(
    gateway: httpx.Client, disk: Disk, trouble: str
) -> None:
    assert gateway.post("/tasks", json=TASK).status_code == 200
    journal = disk.folder / "knowledge" / "knowledge.journal"
    with getattr(disk, trouble)():
        small = fill_what_is_left(gateway)  # of the last block
        expected = {LONG, *small}
        before = journal.read_bytes()
        for name, (method, path, body) in CHANGES.items():
            started = time.monotonic()
            response = gateway.request(method, path, json=body)
            assert time.monotonic() - started < DEADLINE_S, name
            message = failed(response, 503, "not_stored", "reasoning")
            assert ("No space left" if trouble == "full" else "Read-only") in message
            assert response.json()["error"]["details"]["setting"] in message
            assert known(gateway) == stored(disk) == expected, name
            assert journal.read_bytes() == before, name
        decides(gateway, LONG)
        assert LONG in gateway.get("/knowledge").text
    assert gateway.post("/tasks", json={**TASK, "name": "another"}).status_code == 200
    assert known(gateway) == stored(disk) == expected | {"another"}
    decides(gateway, "another")
    assert not list(journal.parent.glob(".*.tmp"))


def test_a_disk_that_fills_up_with_what_is_learned(gateway: httpx.Client, disk: Disk) -> None:
    """Until no more fits; then it is as full as it says, and what fitted is there."""
    if isinstance(disk, FailingCalls):
        pytest.skip("takes a disk of a size")
    learned = set()
    for number in range(500):
        task = {**TASK, "name": f"task_{number}", "description": "x" * 480}
        response = gateway.post("/tasks", json=task)
        if response.status_code != 200:
            break
        learned.add(task["name"])
    failed(response, 503, "not_stored", "reasoning")
    assert 50 < len(learned) < 200
    assert known(gateway) == stored(disk) == learned
    decides(gateway, "task_0")


@pytest.mark.parametrize("trouble", ["full", "read_only"])
def test_a_disk_in_trouble_from_the_start(gateway: httpx.Client, disk: Disk, trouble: str) -> None:
    with getattr(disk, trouble)():
        failed(gateway.post("/tasks", json=TASK), 503, "not_stored", "reasoning")
        assert known(gateway) == stored(disk) == set()
        decides(gateway, "handover")
    assert gateway.post("/tasks", json=TASK).status_code == 200
    assert known(gateway) == stored(disk) == {LONG}
