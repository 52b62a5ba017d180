"""The bounded queue: order, refusal at once, deadlines, and places that nobody loses."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Awaitable, Callable

import pytest

from shared.deadline import check_deadline, remaining_s, within
from shared.errors import DeadlineExceeded, TooBusy
from shared.service.admission import Admission
from shared.settings import ServiceSettings


def admission(
    running: int = 1, waiting: int = 10, wait_s: float = 60.0, service: str = "matching"
) -> Admission:
    return Admission(
        service,
        ServiceSettings(max_running=running, max_waiting=waiting, queue_wait_s=wait_s),
    )


async def until(holds: Callable[[], bool]) -> None:
    async with asyncio.timeout(5.0):
        while not holds():
            await asyncio.sleep(0.001)


def run(test: Callable[[], Awaitable[None]]) -> None:
    async def bounded() -> None:
        async with asyncio.timeout(10.0):
            await test()

    asyncio.run(bounded())


def test_so_many_run_and_the_others_follow_in_order() -> None:
    async def test() -> None:
        queue, begun, most = admission(running=2), list[int](), 0
        free = asyncio.Event()

        async def request(number: int) -> None:
            nonlocal most
            async with queue.turn():
                begun.append(number)
                most = max(most, queue.running)
                await free.wait()

        tasks = [asyncio.create_task(request(number)) for number in range(6)]
        await until(lambda: queue.waiting == 4)
        assert begun == [0, 1]
        free.set()
        await asyncio.gather(*tasks)
        assert (begun, most) == ([0, 1, 2, 3, 4, 5], 2)
        assert (queue.running, queue.waiting) == (0, 0)

    run(test)


def test_a_full_queue_refuses_at_once_and_says_when_to_come_again() -> None:
    async def test() -> None:
        queue, free = admission(waiting=1), asyncio.Event()

        async def request() -> None:
            async with queue.turn():
                await free.wait()

        tasks = [asyncio.create_task(request()) for _ in range(2)]
        await until(lambda: queue.waiting == 1)
        refused: list[int] = []
        queue.on_refusal = lambda: refused.append(1)
        started = time.perf_counter()
        with pytest.raises(TooBusy, match="matching is busy") as caught:
            await request()
        assert time.perf_counter() - started < 0.1
        assert caught.value.details["stage"] == "matching"
        assert caught.value.details["retry_after_s"] >= 1
        assert refused == [1]
        free.set()
        await asyncio.gather(*tasks)
        await request()  # there is room again

    run(test)


def test_who_would_wait_too_long_is_refused_by_what_requests_took() -> None:
    async def test() -> None:
        queue, free = admission(wait_s=0.05), asyncio.Event()
        async with queue.turn():
            await asyncio.sleep(0.1)

        async def request() -> None:
            async with queue.turn():
                await free.wait()

        first = asyncio.create_task(request())
        await until(lambda: queue.running == 1)
        assert queue.expected_wait_s() == pytest.approx(0.1, rel=0.5)
        with pytest.raises(TooBusy):
            await request()
        free.set()
        await first

    run(test)


def test_a_deadline_that_passes_in_the_queue_ends_the_wait() -> None:
    async def test() -> None:
        queue, free = admission(), asyncio.Event()

        async def request() -> None:
            async with queue.turn():
                await free.wait()

        first = asyncio.create_task(request())
        await until(lambda: queue.running == 1)
        with within(0.05), pytest.raises(DeadlineExceeded, match="while it waited for matching"):
            await request()
        assert (queue.running, queue.waiting) == (1, 0)
        free.set()
        await first
        with within(0.0), pytest.raises(DeadlineExceeded):
            await request()
        assert queue.running == 0

    run(test)


def test_who_leaves_while_waiting_gives_the_turn_to_the_next() -> None:
    async def test() -> None:
        queue, free, begun = admission(), asyncio.Event(), list[str]()

        async def request(name: str) -> None:
            async with queue.turn():
                begun.append(name)
                await free.wait()

        first, leaving, last = (asyncio.create_task(request(name)) for name in "abc")
        await until(lambda: queue.waiting == 2)
        free.set()
        await asyncio.sleep(0)
        leaving.cancel()
        await asyncio.gather(first, last)
        with pytest.raises(asyncio.CancelledError):
            await leaving
        assert begun[-1] == "c"
        assert (queue.running, queue.waiting) == (0, 0)

    run(test)


def test_a_thread_keeps_its_place_after_its_client_has_left() -> None:
    async def test() -> None:
        queue, go = admission(), threading.Event()
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.05):
                await queue.in_thread(go.wait)
        assert queue.running == 1
        later = asyncio.create_task(queue.in_thread(lambda: "answer"))
        await until(lambda: queue.waiting == 1)
        go.set()
        assert await later == "answer"
        await until(lambda: queue.running == 0)

    run(test)


def test_work_that_asks_stops_at_its_deadline() -> None:
    async def test() -> None:
        queue, steps = admission(), 0

        def work() -> None:
            nonlocal steps
            while True:
                check_deadline()
                steps += 1
                time.sleep(0.005)

        with within(0.05), pytest.raises(DeadlineExceeded):
            await queue.in_thread(work)
        await until(lambda: queue.running == 0)
        assert 1 <= steps <= 12

    run(test)


def test_an_error_of_the_work_gives_the_place_back() -> None:
    async def test() -> None:
        queue = admission()
        with pytest.raises(ZeroDivisionError):
            await queue.in_thread(lambda: 1 / 0)
        await until(lambda: queue.running == 0)

    run(test)


def test_a_deadline_inside_another_only_shortens_it() -> None:
    assert remaining_s() == float("inf")
    with within(1.0):
        with within(10.0):
            assert 0.9 < remaining_s() <= 1.0
        with within(0.5):
            assert remaining_s() <= 0.5
        assert remaining_s() > 0.9
    check_deadline()
