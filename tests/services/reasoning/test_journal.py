"""The store: nothing acknowledged is lost, nothing half written counts, every process sees it."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from services.reasoning import journal, memory
from services.reasoning.change import Change, Learned
from services.reasoning.journal import Journal
from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.errors import Conflict, InternalError, NotFound, NotStored, StageUnavailable, TooBusy
from shared.schemas.route import Nothing
from shared.schemas.task import DecideRequest, TaskDefinition, TaskName
from shared.settings import PROJECT_ROOT
from tests.services.reasoning.objects import PAN
from tests.support.disk import FailingCalls


def task(name: str) -> TaskDefinition:
    return TaskDefinition(name=name, description="Ümläute, too.", grasp=("grasp",))


def store(book: Journal, learned: Learned, change: Change) -> None:
    with book.writing():
        for each in book.news():
            learned.apply(each)
        if book.needs_rewrite():
            book.rewrite(learned.snapshot())
        book.append(change)
        learned.apply(change)


def stored(folder: Path) -> Learned:
    book, learned = Journal(folder), Learned()
    for each in book.news():
        learned.apply(each)
    book.close()
    return learned


def names(reasoner: Reasoner) -> set[str]:
    return {each.name for each in reasoner.list_tasks(Nothing()).tasks if not each.builtin}


@pytest.fixture
def second(settings: ReasoningSettings) -> Iterator[Reasoner]:
    other = Reasoner(settings)
    other.warm_up()
    yield other
    other.close()


def test_an_incomplete_end_never_counts(tmp_path: Path) -> None:
    book, learned = Journal(tmp_path), Learned()
    store(book, learned, Change(tasks=(task("first"),)))
    before = (tmp_path / "knowledge.journal").read_bytes()
    store(book, learned, Change(tasks=(task("second"),)))
    after = (tmp_path / "knowledge.journal").read_bytes()
    assert after.startswith(before)
    for cut in range(len(before), len(after)):
        for garbage in (b"", b"\0\0\0"):
            folder = tmp_path / f"{cut}{len(garbage)}"
            folder.mkdir()
            (folder / "knowledge.journal").write_bytes(after[:cut] + garbage)
            assert set(stored(folder).tasks) == {"first"}
            again, known = Journal(folder), Learned()
            store(again, known, Change(tasks=(task("third"),)))
            assert set(stored(folder).tasks) == {"first", "third"}
            again.close()
    book.close()


def test_a_last_record_of_zeros_never_counts(tmp_path: Path) -> None:
    book, learned = Journal(tmp_path), Learned()
    store(book, learned, Change(tasks=(task("first"),)))
    with (tmp_path / "knowledge.journal").open("ab") as file:
        file.write(b"\0" * 40 + b"\n")
    assert set(stored(tmp_path).tasks) == {"first"}
    store(book, learned, Change(tasks=(task("second"),)))
    assert set(stored(tmp_path).tasks) == {"first", "second"}
    book.close()


def test_damage_in_the_middle_is_told(tmp_path: Path) -> None:
    book, learned = Journal(tmp_path), Learned()
    for number in range(3):
        store(book, learned, Change(tasks=(task(f"task_{number}"),)))
    book.close()
    file = tmp_path / "knowledge.journal"
    file.write_bytes(file.read_bytes().replace(b"task_1", b"task_9"))
    with pytest.raises(InternalError, match="record 3 is damaged"):
        stored(tmp_path)
    file.write_bytes(b"something else\n")
    with pytest.raises(InternalError, match="not a journal"):
        stored(tmp_path)


def test_a_change_that_cannot_be_stored_is_not_taken(
    reasoner: Reasoner, second: Reasoner, monkeypatch: pytest.MonkeyPatch
) -> None:
    reasoner.add_task(task("first"))
    assert names(second) == {"first"}

    def full(handle: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(NotStored, match="No space left"):
            reasoner.add_task(task("second"))
    assert names(reasoner) == names(second) == {"first"}
    reasoner.add_task(task("third"))
    assert names(reasoner) == names(second) == {"first", "third"}


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EROFS, errno.EIO])
@pytest.mark.parametrize("tidied", [False, True])
def test_wherever_the_disk_fails_memory_and_disk_agree(
    reasoner: Reasoner,
    second: Reasoner,
    settings: ReasoningSettings,
    monkeypatch: pytest.MonkeyPatch,
    error: int,
    tidied: bool,
) -> None:
    """Every system call of a change fails once, and all after it; both processes stay right."""
    if tidied:
        monkeypatch.setattr(memory, "_REWRITE_AFTER", 0)
    calls = FailingCalls(settings.knowledge_dir, monkeypatch)
    reasoner.add_task(task("first"))
    expected, refused = {"first"}, 0
    for number in range(100):
        name = f"task_{number}"
        with calls.failing_at(number, error):
            try:
                reasoner.add_task(task(name))
            except NotStored:
                refused += 1
            made = calls.made
        if name in names(reasoner):  # it is only unsure where even undoing it failed
            expected.add(name)
        assert names(reasoner) == names(second) == set(stored(settings.knowledge_dir).tasks)
        assert names(reasoner) == expected
        for stage in (reasoner, second):
            assert stage.decide(DecideRequest(task="first", primitives=PAN)).found
        if made <= number:
            break
    assert refused >= 3, "opening the lock, opening the file, writing, syncing"
    reasoner.add_task(task("last"))
    assert names(reasoner) == names(second) == {*expected, "last"}


def test_no_room_to_tidy_up_does_not_undo_a_change(
    reasoner: Reasoner, second: Reasoner, monkeypatch: pytest.MonkeyPatch
) -> None:
    reasoner.add_task(task("first"))
    monkeypatch.setattr(memory, "_REWRITE_AFTER", 0)

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    for number in range(8):  # more than four times what is known
        monkeypatch.setattr(tempfile, "mkstemp", full)
        if number % 2:
            reasoner.delete_task(TaskName(name="again"))
        else:
            reasoner.add_task(task("again"))
            assert reasoner.decide(DecideRequest(task="again", primitives=PAN)).found
        assert names(reasoner) == names(second) == {"first", *([] if number % 2 else ["again"])}


def test_where_the_disk_cannot_be_read_what_is_known_still_holds(
    reasoner: Reasoner, monkeypatch: pytest.MonkeyPatch
) -> None:
    reasoner.add_task(task("first"))
    stat = Path.stat

    def broken(path: Path, **options: bool) -> os.stat_result:
        if path.name == "knowledge.journal":
            raise OSError(errno.EIO, "Input/output error")
        return stat(path, **options)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "stat", broken)
        assert names(reasoner) == {"first"}
        assert reasoner.decide(DecideRequest(task="first", primitives=PAN)).found
        with pytest.raises(StageUnavailable, match="cannot be read"):
            reasoner.add_task(task("second"))
    reasoner.add_task(task("second"))
    assert names(reasoner) == {"first", "second"}


def test_a_file_that_is_repaired_in_place_is_read_from_the_beginning(tmp_path: Path) -> None:
    book, learned = Journal(tmp_path), Learned()
    for number in range(4):
        store(book, learned, Change(tasks=(task(f"task_{number}"),)))
    book.close()
    file = tmp_path / "knowledge.journal"
    sound = file.read_bytes()
    file.write_bytes(sound.replace(b"task_2", b"task_9"))
    follower, followed = Journal(tmp_path), Learned()
    for _ in range(2):
        with pytest.raises(InternalError, match="damaged"):
            follower.news()
    file.write_bytes(sound)
    for change in follower.news():
        followed.apply(change)
    follower.close()
    assert followed == learned


WRITER = """
import sys
from pathlib import Path
from services.reasoning.change import Change, Learned
from tests.services.reasoning.test_journal import Journal, store, task
journal, learned = Journal(Path(sys.argv[1])), Learned()
number = int(sys.argv[2])
while True:
    store(journal, learned, Change(tasks=(task(f"task_{number}"),)))
    print(number, flush=True)
    number += 1
    if number % 7 == 0:
        with journal.writing():
            journal.rewrite(learned.snapshot())
"""


def child(code: str, *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        cwd=PROJECT_ROOT,
        env={**os.environ, "PYTHONPATH": str(PROJECT_ROOT)},
    )


def test_what_was_acknowledged_survives_kill_9(tmp_path: Path) -> None:
    acknowledged = -1
    for round_ in range(3):
        writer = child(WRITER, str(tmp_path), str(acknowledged + 1))
        assert writer.stdout is not None
        for line in writer.stdout:  # to the end, which comes with the signal
            acknowledged = int(line)
            if acknowledged % 29 == 13 + round_:
                writer.send_signal(signal.SIGKILL)
        writer.communicate()
        known = {int(name.removeprefix("task_")) for name in stored(tmp_path).tasks}
        assert known >= set(range(acknowledged + 1))
        assert known <= set(range(acknowledged + 2))  # one may be stored and not yet told
        acknowledged = max(known)


FOLLOWER = """
import sys
from pathlib import Path
from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.errors import UnknownTask
from shared.schemas.task import DecideRequest
from tests.services.reasoning.objects import PAN
reasoner = Reasoner(ReasoningSettings(knowledge_dir=Path(sys.argv[1])))
reasoner.warm_up()
print("ready", flush=True)
for line in sys.stdin:
    try:
        print(reasoner.decide(DecideRequest(task=line, primitives=PAN)).found, flush=True)
    except UnknownTask:
        print("unknown", flush=True)
"""


def test_another_process_knows_a_change_with_its_next_request(
    settings: ReasoningSettings, reasoner: Reasoner
) -> None:
    follower = child(FOLLOWER, str(settings.knowledge_dir))
    assert follower.stdin is not None
    assert follower.stdout is not None

    def asked(name: str) -> str:
        assert follower.stdin is not None
        assert follower.stdout is not None
        follower.stdin.write(f"{name}\n")
        follower.stdin.flush()
        return follower.stdout.readline().strip()

    try:
        assert follower.stdout.readline() == "ready\n"
        taken = []
        for number in range(20):
            name = f"task_{number}"
            assert asked(name) == "unknown"
            begin = time.perf_counter()
            reasoner.add_task(task(name))
            assert asked(name) == "True"
            taken.append(time.perf_counter() - begin)
            reasoner.delete_task(TaskName(name=name))
            assert asked(name) == "unknown"
        taken.sort()
        print(f"\nadded here, decided in another process: median {1e3 * taken[10]:.1f} ms", end="")
        assert taken[10] < 0.1
    finally:
        follower.kill()
        follower.communicate()


def test_both_ways(reasoner: Reasoner, second: Reasoner) -> None:
    reasoner.add_task(task("here"))
    second.add_task(task("there"))
    assert names(reasoner) == names(second) == {"here", "there"}
    second.delete_task(TaskName(name="here"))
    assert names(reasoner) == names(second) == {"there"}
    request = DecideRequest(task="there", primitives=PAN)
    assert reasoner.decide(request) == second.decide(request)


def test_a_journal_that_is_written_anew_is_followed(
    reasoner: Reasoner, second: Reasoner, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, "_REWRITE_AFTER", 10)
    for number in range(30):
        reasoner.add_task(task(f"task_{number}"))
        if number % 3:
            second.delete_task(TaskName(name=f"task_{number}"))
    expected = {f"task_{number}" for number in range(0, 30, 3)}
    assert names(reasoner) == names(second) == expected


def test_the_journal_does_not_grow_with_what_is_forgotten(
    reasoner: Reasoner, settings: ReasoningSettings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, "_REWRITE_AFTER", 10)
    sizes = []
    for _ in range(60):
        reasoner.add_task(task("again"))
        reasoner.delete_task(TaskName(name="again"))
        sizes.append((settings.knowledge_dir / "knowledge.journal").stat().st_size)
    assert max(sizes) < 2 * max(sizes[:10])


def test_many_writers_at_once_lose_nothing(reasoner: Reasoner, second: Reasoner) -> None:
    def add(number: int) -> None:
        (reasoner, second)[number % 2].add_task(task(f"task_{number}"))

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(add, range(40)))
    assert names(reasoner) == names(second) == {f"task_{number}" for number in range(40)}


def test_what_a_killed_writer_left_is_cleaned_up(
    reasoner: Reasoner, settings: ReasoningSettings
) -> None:
    settings.knowledge_dir.mkdir()
    (settings.knowledge_dir / ".abc.tmp").write_text("half")
    reasoner.add_task(task("first"))
    left = {file.name for file in settings.knowledge_dir.iterdir()}
    assert left == {"knowledge.journal", "lock"}


def test_a_journal_that_is_taken_away_is_empty_knowledge(
    reasoner: Reasoner, settings: ReasoningSettings
) -> None:
    reasoner.add_task(task("first"))
    with contextlib.suppress(FileNotFoundError):
        (settings.knowledge_dir / "knowledge.journal").unlink()
    assert names(reasoner) == set()
    reasoner.add_task(task("second"))
    assert names(reasoner) == {"second"}


def test_deciding_goes_on_while_another_process_keeps_the_lock(
    reasoner: Reasoner, settings: ReasoningSettings
) -> None:
    reasoner.add_task(task("first"))
    with ThreadPoolExecutor(1) as pool:
        with Journal(settings.knowledge_dir).writing():
            waiting = pool.submit(reasoner.add_task, task("second"))
            time.sleep(0.05)
            begin = time.perf_counter()
            assert reasoner.decide(DecideRequest(task="first", primitives=PAN)).found
            assert time.perf_counter() - begin < 1
            assert not waiting.done()
        waiting.result(timeout=5)
    assert names(reasoner) == {"first", "second"}


def test_a_lock_that_is_kept_is_too_busy(
    reasoner: Reasoner, settings: ReasoningSettings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(journal, "_WAIT_S", 0.05)
    with Journal(settings.knowledge_dir).writing(), pytest.raises(TooBusy, match="ask again"):
        reasoner.add_task(task("first"))
    assert names(reasoner) == set()


def test_threads_that_add_and_delete_the_same_get_clear_answers(
    reasoner: Reasoner, second: Reasoner
) -> None:
    def once(number: int) -> None:
        stage = (reasoner, second)[number % 2]
        with contextlib.suppress(Conflict):
            stage.add_task(task("same"))
        with contextlib.suppress(NotFound):
            stage.delete_task(TaskName(name="same"))

    with ThreadPoolExecutor(6) as pool:
        list(pool.map(once, range(40)))
    with contextlib.suppress(NotFound):
        reasoner.delete_task(TaskName(name="same"))
    assert names(reasoner) == names(second) == set()
