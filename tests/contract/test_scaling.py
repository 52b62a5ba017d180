"""What `python -m tests.bench.scaling` counts is what there is."""

from __future__ import annotations

import subprocess
import sys

import httpx
import pytest
from fastapi import FastAPI, Request

from tests.bench.scaling.relay import relays
from tests.bench.scaling.sizing import size
from tests.bench.scaling.usage import usage
from tests.support.serving import serving

PARENT = """
import subprocess, sys
child = subprocess.Popen([sys.executable, "-c", sys.argv[1]], stdout=subprocess.PIPE)
child.stdout.readline()
print("worked", flush=True)
sys.stdin.read()
child.kill()
"""
CHILD = """
import time
held = b"x" * 50_000_000
while time.process_time() < 0.5:
    pass
print("worked", flush=True)
time.sleep(60)
"""


def test_the_work_of_a_child_counts() -> None:
    command = [sys.executable, "-c", PARENT, CHILD]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.readline()
        used = usage(process.pid)
        process.communicate()
    assert used.cpu_s >= 0.4  # of 0.5: the kernel cuts user and system time to ticks of 10 ms each
    assert used.peak_mb >= 50
    with pytest.raises(ProcessLookupError):
        usage(process.pid)


def test_a_relay_counts_what_passes() -> None:
    app = FastAPI()

    @app.post("/half")
    async def half(request: Request) -> str:
        return "x" * (len(await request.body()) // 2)

    with (
        serving(app) as url,
        relays({"half": url}) as passed,
        httpx.Client(base_url=passed["half"].url) as http,
    ):
        for _ in range(2):
            assert len(http.post("/half", content=b"y" * 100_000).json()) == 50_000
    counted = passed["half"]
    assert counted.connections == 1
    assert 200_000 < counted.sent < 201_000, "two bodies and their headers"
    assert 100_000 < counted.answered < 101_000


def test_pods_are_enough_for_the_share_that_may_be_busy() -> None:
    needed = size(rate=1000, cpu_ms=45, kilobytes=800, pod_mb=250, share=0.6)
    assert needed.cores == pytest.approx(45)
    assert needed.pods == 75
    assert needed.memory_gb == pytest.approx(18.75)
    assert needed.megabits == pytest.approx(6400)
    assert size(1, 1, 1, 100, 0.6).pods == 1
