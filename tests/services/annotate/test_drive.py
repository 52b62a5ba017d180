"""The driver and the tables, without Ray: every question is settled once, whatever happens."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pyarrow")

from services.annotate import parts
from services.annotate.book import Book
from services.annotate.drive import MAX_ATTEMPTS, Driver, Summary
from services.annotate.inputs import find_inputs
from services.annotate.label import label
from services.annotate.pool import Finished
from services.annotate.question import Job, Question, Refusal, Terms
from shared.output import write_whole
from tests.support import annotating
from tests.support.annotating import LightPipeline, rejects, rows, settled, write_inputs

TASKS = ("pouring", "handover")
FILES = {f"{name}.xyz": f"cloud {name}" for name in ("a", "b", "sub/c", "sub/deep/d", "e")}


class LocalPool:
    """Workers of this process that die where `dies` says; the last job is finished first."""

    def __init__(
        self, question: Question, terms: Terms, size: int, dies: Callable[[Job], bool]
    ) -> None:
        self.asked: list[tuple[str, str]] = []
        self.most_under_way = 0
        self._question, self._terms, self._size, self._dies = question, terms, size, dies
        self._given: list[Job] = []

    @property
    def idle(self) -> int:
        return self._size - len(self._given)

    def give(self, job: Job) -> None:
        assert self.idle
        self._given.append(job)
        self.most_under_way = max(self.most_under_way, len(self._given))

    def take(self) -> Sequence[Finished]:
        job = self._given.pop()
        self.asked.append(job.key)
        if self._dies(job):
            return [Finished(job, Refusal("worker_died", "its worker died", True))]
        outcome = label(LightPipeline(), job, self._question.parameters, self._terms)
        return [Finished(job, outcome)]


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(annotating, "SECONDS", 0.0)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_inputs(tmp_path / "in", FILES)


def run(
    folder: Path,
    out: Path,
    *,
    tasks: tuple[str, ...] = TASKS,
    seed: int = 0,
    backend: str = "light",
    size: int = 3,
    part_rows: int = 4,
    dies: Callable[[Job], bool] = lambda job: False,
    retry_rejects: bool = False,
    progress: Callable[[int], None] = lambda settled: None,
) -> tuple[Summary, LocalPool]:
    question = Question(tasks, {"seed": seed})
    terms = Terms(question.settings, backend)
    pool = LocalPool(question, terms, size, dies)
    with Book(out, part_rows) as book:
        driver = Driver(folder, question, terms, book, 1000, retry_rejects, progress)
        return driver.run(find_inputs(folder), pool), pool


def keys(*names: str, tasks: Sequence[str] = TASKS) -> list[tuple[str, str]]:
    return sorted((name, task) for name in names or FILES for task in tasks)


def test_a_row_per_file_and_task(folder: Path, tmp_path: Path) -> None:
    summary, pool = run(folder, tmp_path / "out")
    assert settled(tmp_path / "out") == keys()
    assert sorted(pool.asked) == keys()
    assert (summary.annotated, summary.settled) == (10, 10)
    assert pool.most_under_way == 3


def test_the_rows_do_not_depend_on_the_number_of_workers(folder: Path, tmp_path: Path) -> None:
    for size in (1, 4):
        run(folder, tmp_path / str(size), size=size)
    assert rows(tmp_path / "1") == rows(tmp_path / "4")


def test_a_part_is_written_as_soon_as_it_is_full(folder: Path, tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    out = tmp_path / "out"
    run(folder, out, size=1, progress=lambda done: seen.append((done, len(settled(out)))))
    assert all(done - 4 < written <= done for done, written in seen)
    assert [path.name for path in sorted((out / "annotations").iterdir())] == [
        *(f"part-00000{number}.parquet" for number in range(3)),
        "part-empty.parquet",
    ]


def test_what_is_settled_is_not_asked_again(folder: Path, tmp_path: Path) -> None:
    run(folder, tmp_path / "out", tasks=("pouring",))
    summary, pool = run(folder, tmp_path / "out")
    assert sorted(pool.asked) == keys(tasks=["handover"])
    assert (summary.annotated, summary.annotated_before) == (5, 5)
    assert settled(tmp_path / "out") == keys()
    again, idle = run(folder, tmp_path / "out")
    assert (again.annotated_before, idle.asked) == (10, [])


def test_a_changed_file_is_asked_again_and_its_row_replaced(folder: Path, tmp_path: Path) -> None:
    run(folder, tmp_path / "out")
    before = rows(tmp_path / "out")
    write_inputs(folder, {"b.xyz": "cloud of another kind"})
    _, pool = run(folder, tmp_path / "out")
    after = rows(tmp_path / "out")
    assert sorted(pool.asked) == keys("b.xyz")
    assert settled(tmp_path / "out") == keys()
    assert {key for key in after if after[key] != before[key]} == set(keys("b.xyz"))


@pytest.mark.parametrize("change", [{"seed": 1}, {"backend": "taught"}])
def test_another_question_is_asked_of_all(
    folder: Path, tmp_path: Path, change: dict[str, Any]
) -> None:
    run(folder, tmp_path / "out")
    _, pool = run(folder, tmp_path / "out", **change)
    assert sorted(pool.asked) == keys() == settled(tmp_path / "out")
    run(folder, tmp_path / "fresh", **change)
    assert rows(tmp_path / "out") == rows(tmp_path / "fresh")


def test_bad_files_are_rejected_with_their_reason(folder: Path, tmp_path: Path) -> None:
    write_inputs(folder, {"empty.xyz": "empty", "large.xyz": "x" * 2000, "nothing.xyz": "nothing"})
    (folder / "gone.xyz").symlink_to("nowhere")
    summary, _ = run(folder, tmp_path / "out")
    found = rejects(tmp_path / "out")
    assert {path: found[path, "pouring"]["code"] for path, _ in found} == {
        "empty.xyz": "empty_cloud",
        "large.xyz": "too_large",
        "gone.xyz": "unreadable",
    }
    assert found["empty.xyz", "pouring"]["message"] == "no points"
    assert found["gone.xyz", "pouring"]["sha256"] is None
    assert summary.rejected == Counter(empty_cloud=2, too_large=2, unreadable=2)
    assert rows(tmp_path / "out")["nothing.xyz", "pouring"]["reason"] == "no_part_matches"
    assert settled(tmp_path / "out") == keys(
        *FILES, "empty.xyz", "large.xyz", "gone.xyz", "nothing.xyz"
    )


def test_a_worker_that_dies_now_and_then_costs_nothing(folder: Path, tmp_path: Path) -> None:
    deaths: Counter[tuple[str, str]] = Counter()

    def dies(job: Job) -> bool:
        deaths[job.key] += 1
        return deaths[job.key] < MAX_ATTEMPTS

    summary, _ = run(folder, tmp_path / "out", dies=dies)
    assert set(deaths.values()) == {MAX_ATTEMPTS}
    assert (summary.annotated, summary.rejected) == (10, Counter())
    assert settled(tmp_path / "out") == keys()


@pytest.mark.parametrize(
    ("text", "code"), [("slow", "deadline_exceeded"), ("bug", "internal"), ("cloud", "worker_died")]
)
def test_what_fails_again_and_again_is_rejected(
    folder: Path, tmp_path: Path, text: str, code: str
) -> None:
    write_inputs(folder, {"b.xyz": text})
    _, pool = run(folder, tmp_path / "out", dies=lambda job: job.data == b"cloud")
    found = rejects(tmp_path / "out")
    assert sorted(found) == keys("b.xyz")
    assert {(row["code"], row["attempts"]) for row in found.values()} == {(code, MAX_ATTEMPTS)}
    assert Counter(pool.asked)["b.xyz", "pouring"] == MAX_ATTEMPTS
    assert settled(tmp_path / "out") == keys()


def test_rejects_are_asked_again_only_on_request(folder: Path, tmp_path: Path) -> None:
    run(folder, tmp_path / "out", dies=lambda job: job.path == "b.xyz")
    summary, pool = run(folder, tmp_path / "out")
    assert (summary.rejected_before, pool.asked) == (2, [])
    run(folder, tmp_path / "out", retry_rejects=True)
    assert rejects(tmp_path / "out") == {}
    assert settled(tmp_path / "out") == keys()


def test_an_interrupted_run_keeps_what_is_answered(folder: Path, tmp_path: Path) -> None:
    def interrupt(done: int) -> None:
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(folder, tmp_path / "out", size=1, progress=interrupt)
    assert len(settled(tmp_path / "out")) == 3
    _, pool = run(folder, tmp_path / "out")
    assert len(pool.asked) == 7
    assert settled(tmp_path / "out") == keys()


class _PowerCut(BaseException):
    pass


@pytest.mark.parametrize("after", [False, True], ids=["before", "after"])
@pytest.mark.parametrize("nth", range(12))
def test_a_crash_at_any_write_settles_nothing_twice(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, nth: int, *, after: bool
) -> None:
    """Some files changed, some rejected before: both tables are shortened and added to."""
    out = tmp_path / "out"
    write_inputs(folder, {"a.xyz": "empty", "f.xyz": "empty"})
    run(folder, out, part_rows=3)
    write_inputs(folder, {"a.xyz": "cloud", "b.xyz": "cloud", "e.xyz": "empty", "g.xyz": "cloud"})
    changes = 0

    def cut(change: Callable[..., None]) -> Callable[..., None]:
        def changing(*arguments: Any, **options: Any) -> None:
            nonlocal changes
            changes += 1
            if changes > nth and not after:
                raise _PowerCut
            change(*arguments, **options)
            if changes > nth:
                raise _PowerCut

        return changing

    with monkeypatch.context() as power:
        power.setattr(parts, "write_whole", cut(write_whole))
        power.setattr(Path, "unlink", cut(Path.unlink))
        try:
            run(folder, out, part_rows=3)
            assert changes <= nth
        except _PowerCut:
            pass
    held = settled(out)
    assert len(held) == len(set(held))
    run(folder, out, part_rows=3)
    run(folder, tmp_path / "fresh")
    assert settled(out) == keys(*FILES, "f.xyz", "g.xyz")
    assert rows(out) == rows(tmp_path / "fresh")
    assert rejects(out) == rejects(tmp_path / "fresh")


def test_names_that_are_no_unicode(folder: Path, tmp_path: Path) -> None:
    write_inputs(folder, {os.fsdecode(b"caf\xe9.xyz"): "cloud"})
    run(folder, tmp_path / "out")
    assert ("caf\\xe9.xyz", "pouring") in rows(tmp_path / "out")
