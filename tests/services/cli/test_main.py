"""The `sparge` command as a person types it."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import httpx
import pytest

from tests.support.samples import sample_path
from tests.support.serving import free_ports

SPARGE = [sys.executable, "-c", "from services.cli import main; main()"]


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    return {
        **os.environ,
        "SPARGE_REASONING_KNOWLEDGE_DIR": str(tmp_path / "knowledge"),
        "COLUMNS": "100",
    }


def sparge(environment: dict[str, str], *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*SPARGE, *words],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        cwd=Path(__file__).parents[3],
    )


def test_grasp_prints_the_answer_and_draws_it(environment: dict[str, str], tmp_path: Path) -> None:
    picture = tmp_path / "made" / "grasp.png"
    done = sparge(
        environment,
        *("grasp", str(sample_path("bottle")), "--task", "Pouring", "--save", str(picture)),
    )
    assert done.returncode == 0, done.stderr
    for word in ("pouring (v2): hold part", "Parts", "Grasps", "Why", "default/version2", "Time"):
        assert word in done.stdout
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_grasp_says_what_came_of_a_rehearsal(environment: dict[str, str]) -> None:
    done = sparge(
        environment,
        *("grasp", str(sample_path("saucepan")), "--task", "cooking", "--rehearsal", "always"),
    )
    assert done.returncode == 0, done.stderr
    assert "rehearsed" in done.stdout
    assert "rehearsal" in done.stdout.rsplit("Time", 1)[1]


def test_grasp_as_json(environment: dict[str, str]) -> None:
    done = sparge(
        environment,
        *("grasp", str(sample_path("bottle")), "--task", "handover", "--json"),
        *("--max-grasps", "2"),
    )
    answer = json.loads(done.stdout)
    assert answer["task"] == "handover"
    assert len(answer["grasps"]) <= 2


def test_what_is_said_is_printed_as_it_is(environment: dict[str, str]) -> None:
    done = sparge(environment, "grasp", str(sample_path("ladle")), "--task", "hammering")
    assert done.returncode == 0, done.stderr
    assert "default/version2:pound:" in done.stdout  # and no emoji


def test_an_error_is_one_line_and_status_1(environment: dict[str, str]) -> None:
    done = sparge(environment, "grasp", str(sample_path("bottle")), "--task", "juggling")
    assert done.returncode == 1
    assert "unknown_task" in done.stderr
    assert "pouring" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_file_that_is_no_cloud(environment: dict[str, str], tmp_path: Path) -> None:
    letter = tmp_path / "letter.txt"
    letter.write_text("dear robot")
    done = sparge(environment, "grasp", str(letter), "--task", "pouring")
    assert done.returncode == 1
    assert "unsupported_media_type" in done.stderr


def test_a_backend_that_is_not_there(environment: dict[str, str]) -> None:
    (port,) = free_ports(1)
    done = sparge(
        environment,
        *("grasp", str(sample_path("bottle")), "--task", "pouring"),
        *("--url", f"http://127.0.0.1:{port}"),
    )
    assert done.returncode == 1
    assert "stage_unavailable" in done.stderr


def test_serve_says_that_the_port_of_grpc_is_taken(environment: dict[str, str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        done = sparge(environment, "serve", "--port", "0", "--grpc-port", port)
    assert done.returncode == 1
    assert f"cannot listen on 127.0.0.1:{port}" in done.stderr
    assert "Traceback" not in done.stderr


def test_serve_answers_and_stops_on_sigterm(environment: dict[str, str]) -> None:
    (port,) = free_ports(1)
    url = f"http://127.0.0.1:{port}"
    server = subprocess.Popen(
        [*SPARGE, "serve", "--port", str(port), "--log-level", "warning"],
        env=environment,
        cwd=Path(__file__).parents[3],
    )
    try:
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            try:
                if httpx.get(f"{url}/health/ready").status_code == 200:
                    break
            except httpx.TransportError:
                assert server.poll() is None
            time.sleep(0.1)
        done = sparge(
            environment, "grasp", str(sample_path("bottle")), "--task", "pouring", "--url", url
        )
        assert done.returncode == 0, done.stderr
        assert "hold part" in done.stdout
        examined = sparge(environment, "doctor", "--url", url)
        assert examined.returncode == 0, examined.stdout
        assert "3 grasps for pouring" in examined.stdout
    finally:
        server.send_signal(signal.SIGTERM)
        assert server.wait(timeout=10) in (0, -signal.SIGTERM)
