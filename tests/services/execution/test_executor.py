from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from services.execution.executor import Executor
from services.execution.settings import ExecutionSettings
from services.execution.simulator import Simulator
from shared.deadline import within
from shared.errors import (
    DeadlineExceeded,
    DegenerateCloud,
    StageUnavailable,
    UnknownGripper,
)
from shared.grippers import load_grippers
from tests.services.execution.scenes import cylinder, from_above, from_side, request

LIFTED = request((0, 0, 0.09), from_side(), cylinder())
FLAT = request((0, 0, 0.05), from_above(), (np.eye(3) * 0.1, np.array([[0, 1, 2]], dtype=np.int32)))


@pytest.fixture(scope="module")
def executor() -> Iterator[Executor]:
    stage = Executor(ExecutionSettings())
    stage.warm_up()
    yield stage
    stage.close()


def test_concurrent_requests_get_the_answers_of_single_ones(executor: Executor) -> None:
    requests = [LIFTED, request((0.12, 0, 0.12), from_above(), cylinder())] * 2
    expected = [executor.execute(each) for each in requests[:2]] * 2
    answers: dict[int, object] = {}

    def ask(index: int) -> None:
        answers[index] = executor.execute(requests[index])

    threads = [threading.Thread(target=ask, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [answers[index] for index in range(4)] == expected
    assert [answer.outcome for answer in expected[:2]] == ["lifted", "missed"]


def test_every_process_ends_with_the_stage() -> None:
    stage = Executor(ExecutionSettings(workers=2))
    threads = [threading.Thread(target=stage.execute, args=(LIFTED,)) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    started = [each for each in stage._idle.queue if each is not None]
    assert len(started) == 2
    stage.close()
    assert not any(each.alive for each in started)


def test_errors_of_the_simulation_come_through(executor: Executor) -> None:
    with pytest.raises(DegenerateCloud, match="no volume"):
        executor.execute(FLAT)
    with pytest.raises(UnknownGripper):
        executor.execute(request((0, 0, 0.05), from_above(), cylinder(), gripper="soft"))
    assert executor.execute(LIFTED).success


def test_nothing_is_printed(executor: Executor, capfd: pytest.CaptureFixture[str]) -> None:
    simulator = Simulator()
    simulator.run(LIFTED, load_grippers()["panda"], 30.0)
    simulator.stop()
    executor.execute(LIFTED)
    assert capfd.readouterr() == ("", "")


def test_a_dead_process_is_replaced() -> None:
    stage = Executor(ExecutionSettings(workers=1))
    try:
        expected = stage.execute(LIFTED)
        (simulator,) = stage._idle.queue
        assert simulator is not None
        os.kill(simulator._process.pid, signal.SIGSEGV)
        simulator._process.wait()
        assert stage.execute(LIFTED) == expected
    finally:
        stage.close()


def test_a_process_that_dies_at_work_is_an_error_and_then_replaced() -> None:
    stage = Executor(ExecutionSettings(workers=1, time_limit_s=20))
    try:
        stage.warm_up()
        (simulator,) = stage._idle.queue
        assert simulator is not None
        os.kill(simulator._process.pid, signal.SIGSTOP)  # so that it is surely still at work
        killer = threading.Timer(0.3, simulator._process.kill)
        killer.start()
        with pytest.raises(StageUnavailable, match="process died"):
            stage.execute(LIFTED)
        killer.join()
        assert stage.execute(LIFTED).success
    finally:
        stage.close()


def test_a_process_that_hangs_is_ended_and_replaced() -> None:
    stage = Executor(ExecutionSettings(workers=1, time_limit_s=0.4))
    try:
        stage.warm_up()
        (simulator,) = stage._idle.queue
        assert simulator is not None
        os.kill(simulator._process.pid, signal.SIGSTOP)
        with pytest.raises(DeadlineExceeded, match=r"0\.4 s"):
            stage.execute(LIFTED)
        assert simulator._process.returncode is not None
        quick = request((0, 0, 0.1), from_above(), cylinder(), width=0.09)
        assert stage.execute(quick).outcome == "unreachable"
    finally:
        stage.close()


def test_a_filmed_execution_may_take_longer() -> None:
    stage = Executor(ExecutionSettings(workers=1, time_limit_s=0.2, film_time_s=0.5))
    try:
        stage.warm_up()
        (simulator,) = stage._idle.queue
        assert simulator is not None
        os.kill(simulator._process.pid, signal.SIGSTOP)
        with pytest.raises(DeadlineExceeded, match=r"0\.7 s"):
            stage.execute(LIFTED.model_copy(update={"animate": True}))
    finally:
        stage.close()


def test_the_deadline_of_a_request_ends_its_simulation() -> None:
    stage = Executor(ExecutionSettings(workers=1, time_limit_s=20))
    try:
        stage.warm_up()
        (simulator,) = stage._idle.queue
        assert simulator is not None
        os.kill(simulator._process.pid, signal.SIGSTOP)
        with within(0.3), pytest.raises(DeadlineExceeded, match=r"0\.3 s|0\.29"):
            stage.execute(LIFTED)
        assert stage.execute(LIFTED).outcome == "lifted"
    finally:
        stage.close()


def test_a_process_is_replaced_after_its_share() -> None:
    stage = Executor(ExecutionSettings(workers=1, executions_per_worker=1))
    try:
        quick = request((0, 0, 0.1), from_above(), cylinder(), width=0.09)
        pids = set()
        for _ in range(2):
            stage.execute(quick)
            (simulator,) = stage._idle.queue
            assert simulator is not None
            pids.add(simulator._process.pid)
        assert len(pids) == 2
    finally:
        stage.close()


def test_closing_ends_the_process() -> None:
    stage = Executor(ExecutionSettings(workers=1))
    stage.warm_up()
    (simulator,) = stage._idle.queue
    assert simulator is not None
    stage.close()
    assert simulator._process.returncode is not None
    with pytest.raises(StageUnavailable, match="shutting down"):
        stage.execute(LIFTED)


def test_a_process_whose_owner_vanishes_ends() -> None:
    script = (
        "from services.execution.simulator import Simulator; import os;"
        "s = Simulator(); print(s._process.pid, flush=True); os._exit(0)"
    )
    owner = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, check=True, timeout=60
    )
    pid = int(owner.stdout)
    for _ in range(200):
        if not _runs(pid):
            return
        threading.Event().wait(0.05)
    pytest.fail("the simulation process outlives its owner")


def _runs(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return False
    return state != "Z"


def test_the_service_does_not_load_the_simulator() -> None:
    script = "import services.execution.app, sys; sys.exit('pybullet' in sys.modules)"
    subprocess.run([sys.executable, "-c", script], check=True, timeout=60)
