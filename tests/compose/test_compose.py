"""`make compose-test`: the images as they are deployed, on a real Docker engine.

Builds, starts, asks over the published port, scales, kills a stage in the middle of requests,
restarts, stops. Every test leaves the deployment as it found it.
"""

from __future__ import annotations

import json
import os
import subprocess
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx
import pytest

from services.gateway.settings import STAGES
from services.wiring import create_app
from tests.support.samples import sample_path
from tests.support.serving import free_ports, in_process

pytestmark = pytest.mark.skipif(
    os.environ.get("SPARGE_COMPOSE_TEST") != "1",
    reason="needs a Docker engine; `make compose-test` runs it",
)

ROOT = Path(__file__).parents[2]
NPZ = {"Content-Type": "application/x-npz"}
DEADLINE_S = 30.0
STOP_S = 5.0


class Deployment:
    """A compose project of its own, so that it meets no other one."""

    def __init__(self, port: int) -> None:
        self.url = f"http://127.0.0.1:{port}"
        self._environment = {**os.environ, "SPARGE_PORT": str(port)}
        self._command = ("docker", "compose", "--project-name", f"sparge-test-{port}")

    def run(self, *arguments: str, timeout_s: float = 300) -> str:
        ended = subprocess.run(
            [*self._command, *arguments],
            cwd=ROOT,
            env=self._environment,
            capture_output=True,
            text=True,
            timeout=timeout_s,
        )
        assert ended.returncode == 0, f"{arguments}: {ended.stderr[-2000:]}"
        return ended.stdout

    def up(self, *arguments: str) -> None:
        self.run("up", "--detach", "--wait", *arguments)

    def containers(self, service: str) -> list[str]:
        return self.run("ps", "--all", "--quiet", service).split()

    def inspect(self, container: str) -> dict[str, Any]:
        text = subprocess.check_output(["docker", "inspect", container], text=True)
        found: dict[str, Any] = json.loads(text)[0]
        return found

    def grasp(self, **question: str) -> httpx.Response:
        return httpx.post(
            f"{self.url}/grasp",
            params={"task": "cooking", **question},
            content=sample_path("saucepan").read_bytes(),
            headers=NPZ,
            timeout=DEADLINE_S + 5,
        )


@pytest.fixture(scope="module")
def deployment() -> Iterator[Deployment]:
    (port,) = free_ports(1)
    deployed = Deployment(port)
    deployed.run("build", timeout_s=1800)
    try:
        deployed.up()
        yield deployed
    finally:
        deployed.run("down", "--volumes", "--rmi", "local", "--timeout", "5")


def timeless(answer: dict[str, Any]) -> dict[str, Any]:
    return {key: answer[key] for key in answer if key not in ("request_id", "timings_ms")}


def test_it_answers_as_the_embedded_default(
    deployment: Deployment, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", str(tmp_path))
    with in_process(create_app()) as embedded:
        here = embedded.request(
            "POST",
            "/grasp",
            params={"task": "cooking"},
            content=sample_path("saucepan").read_bytes(),
            headers=NPZ,
        )
    there = deployment.grasp()
    assert (here.status_code, there.status_code) == (200, 200), there.text
    assert timeless(here.json()) == timeless(there.json())


@pytest.mark.parametrize("service", [*STAGES, "gateway"])
def test_a_container_may_do_little(deployment: Deployment, service: str) -> None:
    (container,) = deployment.containers(service)
    found = deployment.inspect(container)
    host = found["HostConfig"]
    assert found["Config"]["User"] == "sparge"
    assert host["ReadonlyRootfs"]
    assert host["CapDrop"] == ["ALL"]
    assert any(each.startswith("no-new-privileges") for each in host["SecurityOpt"])
    assert 0 < host["Memory"] <= 2**30
    assert 0 < host["PidsLimit"] <= 128
    published = {port: bound for port, bound in found["NetworkSettings"]["Ports"].items() if bound}
    if service == "gateway":
        (bound,) = published["8000/tcp"]
        assert bound["HostIp"] == "127.0.0.1"
    else:
        assert published == {}
        (network,) = found["NetworkSettings"]["Networks"]
        assert network.endswith("_inside")


def test_replicas_share_the_load(deployment: Deployment) -> None:
    deployment.up("--no-recreate", "--scale", "primitive_recovery=2")
    try:
        time.sleep(6.0)  # the gateway asks for addresses every five seconds
        before = [recovered(deployment, index) for index in (1, 2)]
        with ThreadPoolExecutor(4) as pool:
            answers = list(pool.map(lambda n: deployment.grasp(seed=str(n)), range(12)))
        assert {answer.status_code for answer in answers} <= {200, 429}
        after = [recovered(deployment, index) for index in (1, 2)]
        shares = [now - then for now, then in zip(after, before, strict=True)]
        assert min(shares) >= 3, shares
    finally:
        deployment.up("--no-recreate", "--scale", "primitive_recovery=1")


def recovered(deployment: Deployment, index: int) -> float:
    """Return how many requests a replica has answered, by its own metrics."""
    read = (
        "import urllib.request as r;"
        "print(r.urlopen('http://127.0.0.1:8000/metrics').read().decode())"
    )
    text = deployment.run(
        "exec", "--index", str(index), "primitive_recovery", "python3", "-c", read
    )
    return sum(
        float(line.rsplit(" ", 1)[1])
        for line in text.splitlines()
        if line.startswith("sparge_requests_total") and 'route="/recover"' in line
    )


def test_a_stage_killed_in_mid_request_is_named_and_comes_back(deployment: Deployment) -> None:
    answers: list[tuple[httpx.Response, float]] = []
    stop = threading.Event()

    def ask() -> None:
        while not stop.is_set():
            started = time.monotonic()
            answers.append((deployment.grasp(), time.monotonic() - started))

    with ThreadPoolExecutor(3) as pool:
        for _ in range(3):
            pool.submit(ask)
        wait_for(lambda: len(answers) >= 3)
        deployment.run("kill", "--signal", "KILL", "grasp_proposal")
        wait_for(lambda: any(answer.status_code == 503 for answer, _ in answers))
        stop.set()
    refused = [answer for answer, _ in answers if answer.status_code != 200]
    for answer in refused:
        assert answer.status_code == 503, answer.text
        error = answer.json()["error"]
        assert (error["code"], error["details"]["stage"]) == ("stage_unavailable", "grasp_proposal")
        assert int(answer.headers["retry-after"]) >= 1
    assert max(seconds for _, seconds in answers) < DEADLINE_S
    assert httpx.get(f"{deployment.url}/health/ready", timeout=10).status_code == 503
    deployment.run("start", "grasp_proposal")
    wait_for(lambda: deployment.grasp().status_code == 200)


def test_a_host_that_vanishes_is_named_before_the_deadline(deployment: Deployment) -> None:
    """Without its network a container closes no connection and refuses none."""
    (container,) = deployment.containers("perception")
    (network,) = deployment.inspect(container)["NetworkSettings"]["Networks"]
    assert deployment.grasp().status_code == 200  # a connection is kept
    docker = ["docker", "network"]
    subprocess.check_call([*docker, "disconnect", network, container])
    try:
        started = time.monotonic()
        answer = deployment.grasp()
        assert time.monotonic() - started < DEADLINE_S / 2
        assert answer.status_code == 503
        assert answer.json()["error"]["details"]["stage"] == "perception"
    finally:
        subprocess.check_call([*docker, "connect", "--alias", "perception", network, container])
    wait_for(lambda: deployment.grasp().status_code == 200)


def test_knowledge_survives_the_containers(deployment: Deployment) -> None:
    known = httpx.get(f"{deployment.url}/affordances", timeout=30).json()["affordances"]
    name = known[0]["name"]
    taught = {"name": "stirring", "requires": [name], "grasp": [name]}
    added = httpx.post(f"{deployment.url}/tasks", json=taught, timeout=30)
    assert added.status_code == 200, added.text
    deployment.run("down", "--timeout", "5")
    deployment.up()
    tasks = httpx.get(f"{deployment.url}/tasks", timeout=30).json()["tasks"]
    assert "stirring" in {task["name"] for task in tasks}


def test_it_stops_in_good_order_within_five_seconds(deployment: Deployment) -> None:
    containers = [one for name in (*STAGES, "gateway") for one in deployment.containers(name)]
    started = time.monotonic()
    deployment.run("stop")
    assert time.monotonic() - started < 2 * STOP_S  # the gateway first, then its stages
    stopped = [deployment.inspect(container) for container in containers]
    codes = {each["Name"]: each["State"]["ExitCode"] for each in stopped}
    assert set(codes.values()) <= {0, 143}, f"137 is who took longer and was killed: {codes}"
    deployment.up()


def wait_for(holds: Any, seconds: float = 60.0) -> None:
    until = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < until, "it did not come about in time"
        time.sleep(0.2)
