"""`sparge grpc` as a process, until it is told to stop."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Iterator

import grpc
import pytest
from grpc_health.v1 import health_pb2, health_pb2_grpc

from services.gateway.settings import STAGES
from services.grpc.generated import sparge_pb2 as pb
from tests.services.gateway.test_access import stage
from tests.support.grpc_calls import call
from tests.support.processes import CHECKOUT, READY_TIMEOUT_S
from tests.support.serving import free_ports, serving


@contextlib.contextmanager
def sparge_grpc(*words: str, **variables: str) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """Start `sparge grpc`; it has ended in the end."""
    (port,) = free_ports(1)
    command = ("-c", "from services.cli import main; main()", "grpc", "--port", str(port))
    process = subprocess.Popen(
        [sys.executable, *command, *words],
        env={**os.environ, **variables},
        cwd=CHECKOUT,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        yield process, port
    finally:
        process.kill()
        process.communicate()


def test_it_answers_and_stops_in_good_order() -> None:
    """The gateway is in the process; its stages are elsewhere, or it would warm them up first."""
    with (
        serving(stage()) as url,
        sparge_grpc(**{f"SPARGE_GATEWAY_{name.upper()}_URL": url for name in STAGES}) as started,
        grpc.insecure_channel(f"127.0.0.1:{started[1]}") as channel,
    ):
        process, port = started
        grpc.channel_ready_future(channel).result(timeout=READY_TIMEOUT_S)
        watched = health_pb2_grpc.HealthStub(channel).Watch(
            health_pb2.HealthCheckRequest(), timeout=READY_TIMEOUT_S
        )
        assert any(said.status == health_pb2.HealthCheckResponse.SERVING for said in watched)
        assert not call(channel, "ListTasks", pb.Nothing())[0].tasks
        process.send_signal(signal.SIGTERM)
        _, told = process.communicate(timeout=20)
        assert process.returncode == 0, told
    assert f"gRPC on 127.0.0.1:{port}" in told
    assert "grpc ListTasks OK in" in told
    assert "gRPC stopped" in told
    assert "Traceback" not in told


@pytest.mark.parametrize("behind", ["a gateway that is down", "a backend of its own"])
def test_other_machines_are_not_served_without_keys_or_so_many_words(behind: str) -> None:
    (nobody,) = free_ports(1)
    down = behind == "a gateway that is down"
    words = ("--url", f"http://127.0.0.1:{nobody}") if down else ()
    with sparge_grpc(*words, "--host", "192.0.2.7") as (process, _):
        _, told = process.communicate(timeout=60)
    assert process.returncode == 1
    assert ("stage_unavailable" if down else "API keys") in told
    assert "Traceback" not in told
