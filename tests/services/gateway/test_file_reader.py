"""The process that reads files: the same answers as without it, and what happens when it ends."""

from __future__ import annotations

import os
import signal
import struct
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import lzf
import numpy as np
import pytest

from services.gateway.file_reader import FileReader
from services.gateway.settings import GatewaySettings
from shared.errors import (
    DeadlineExceeded,
    InternalError,
    InvalidInput,
    MalformedRequest,
    PayloadTooLarge,
    SpargeError,
    TooBusy,
    UnreadableFile,
    UnsupportedMediaType,
)
from shared.wire.files import read_cloud_file
from shared.wire.npz import write_npz
from tests.support.cloud_files import pcd, ply, png, xyz_header
from tests.support.fuzzing import CASES, SEED
from tests.support.hostile_files import ALLOWED
from tests.support.mutation import mutated_bytes

POINTS = np.random.default_rng(3).uniform(-1, 1, (60, 3)).astype(np.float32)
DEPTH = np.random.default_rng(4).integers(0, 2**16, (12, 17)).astype(np.uint16)
BESIDE: dict[str, Any] = {"intrinsics": np.eye(3).tolist(), "depth_scale": 1e-3}
TEXT = "\n".join(" ".join(map(repr, row)) for row in POINTS.tolist()).encode()
LONG = b"0 0 0\n" * 3_000_000
"""Takes a second of processor time and more."""
SOUND = {
    "a.PLY": ply(POINTS.tobytes(), *xyz_header(60)),
    "text.ply": ply(TEXT, *xyz_header(60), encoding="ascii"),
    "a.pcd": pcd(POINTS.tobytes(), "binary", 60),
    "text.pcd": pcd(TEXT, "ascii", 60),
    "a.xyz": TEXT,
    "a.png": png(DEPTH),
    "a.npz": write_npz({"points": POINTS}, compress=True),
    "depth.npz": write_npz({"depth": DEPTH, "intrinsics": np.eye(3)}),
}


@pytest.fixture(scope="module")
def reader() -> Iterator[FileReader]:
    yield from running()


def running(**settings: Any) -> Iterator[FileReader]:
    reader = FileReader(GatewaySettings(max_unpacked_bytes=ALLOWED, **settings))
    yield reader
    reader.close()


def process_of(reader: FileReader) -> int:
    assert reader._child is not None
    return reader._child._process.pid


def works(reader: FileReader) -> None:
    read = reader.read("a.png", SOUND["a.png"], **BESIDE)
    assert read.depth is not None
    np.testing.assert_array_equal(read.depth, DEPTH)


@pytest.mark.parametrize("name", SOUND)
def test_it_reads_what_is_read_without_it(reader: FileReader, name: str) -> None:
    here = read_cloud_file(name, SOUND[name], **BESIDE).fields()
    there = reader.read(name, SOUND[name], **BESIDE).fields()
    assert here.keys() == there.keys()
    for field, value in here.items():
        np.testing.assert_array_equal(there[field], value)
        assert np.asarray(there[field]).dtype == np.asarray(value).dtype


@pytest.mark.parametrize(
    ("name", "data", "kind"),
    [
        ("a.ply", b"solid", MalformedRequest),
        ("a.pcd", pcd(b"", "binary", 10**18 - 1), PayloadTooLarge),
        ("a.png", SOUND["a.png"][:-40], MalformedRequest),
        ("a.stl", b"solid", UnsupportedMediaType),
    ],
)
def test_its_errors_come_through_whole(
    reader: FileReader, name: str, data: bytes, kind: type[SpargeError]
) -> None:
    with pytest.raises(kind) as there:
        reader.read(name, data, **BESIDE)
    with pytest.raises(kind) as here:
        read_cloud_file(name, data, **BESIDE, max_unpacked_bytes=ALLOWED)
    assert there.value.message == here.value.message
    assert there.value.details == here.value.details


def test_it_is_started_for_those_files_alone_that_need_it() -> None:
    for reader in running():
        reader.read("a.npz", SOUND["a.npz"])
        with pytest.raises(UnsupportedMediaType):
            reader.read("a.stl", b"")
        assert reader._child is None
        reader.read("a.\0ply", SOUND["a.PLY"])
        first = process_of(reader)
        works(reader)
        assert process_of(reader) == first, "one process reads them all"


@pytest.mark.parametrize("end", [signal.SIGSEGV, signal.SIGKILL, signal.SIGABRT])
def test_a_crash_is_told_and_the_next_file_is_read(reader: FileReader, end: signal.Signals) -> None:
    works(reader)
    process = process_of(reader)
    os.kill(process, signal.SIGSTOP)  # so that it is surely still at work

    def crash() -> None:
        while not reader._lock.locked():
            time.sleep(0.01)
        time.sleep(0.2)
        os.kill(process, end)
        os.kill(process, signal.SIGCONT)

    killer = threading.Thread(target=crash)
    killer.start()
    with pytest.raises(UnreadableFile, match=f"exit status -{end.value}"):
        reader.read("a.png", SOUND["a.png"], **BESIDE)
    killer.join()
    works(reader)
    assert process_of(reader) != process


def test_a_process_that_died_at_rest_is_replaced_unseen(reader: FileReader) -> None:
    works(reader)
    os.kill(process_of(reader), signal.SIGKILL)
    os.waitid(os.P_PID, process_of(reader), os.WEXITED | os.WNOWAIT)
    works(reader)


def test_processor_time_is_bounded() -> None:
    for reader in running(file_time_s=0.2, deadline_s=60):
        works(reader)
        with pytest.raises(UnreadableFile, match=r"0\.2 s of processor time") as caught:
            reader.read("a.ply", ply(LONG, "element pad 3000000", *xyz_header(1), encoding="ascii"))
        assert caught.value.details == {"field": "file", "allowed": 0.2}
        works(reader)


def test_memory_is_bounded() -> None:
    for reader in running(file_memory_bytes=6 * 2**20):
        with pytest.raises(UnreadableFile, match="6291456 bytes of memory"):
            reader.read("a.ply", ply(bytes(12 * 150_000), *xyz_header(150_000)))
        works(reader)


def test_a_sound_file_as_large_as_allowed_needs_four_times_as_much() -> None:
    limit = 16 * 2**20
    count = limit // 24
    body = lzf.compress(bytes(12 * count))
    data = pcd(struct.pack("<II", len(body), 12 * count) + body, "binary_compressed", count)
    reader = FileReader(GatewaySettings(max_unpacked_bytes=limit, file_memory_bytes=4 * limit))
    try:
        points = reader.read("a.pcd", data).points
    finally:
        reader.close()
    assert points is not None
    assert points.shape == (count, 3)


def test_a_process_that_hangs_is_ended_at_the_deadline_and_replaced() -> None:
    for reader in running(deadline_s=1.0):
        works(reader)
        os.kill(process_of(reader), signal.SIGSTOP)
        started = time.monotonic()
        with pytest.raises(DeadlineExceeded, match="within 1 s"):
            reader.read("a.xyz", LONG)  # more than the pipe holds: sending blocks, too
        assert time.monotonic() - started < 5
        works(reader)


def test_who_waits_too_long_for_others_is_told_to_come_again() -> None:
    for reader in running(deadline_s=0.5):
        with reader._lock, pytest.raises(TooBusy):
            reader.read("a.xyz", TEXT)


def test_many_at_once_get_their_own_answers(reader: FileReader) -> None:
    def read(number: int) -> float:
        points = reader.read("a.xyz", f"{number} 0 0\n".encode()).points
        assert points is not None
        return float(points[0, 0])

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(read, range(40))) == list(range(40))


def test_it_knows_no_secrets(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SPARGE_GATEWAY_API_KEYS", "secret of the house")
    for reader in running():
        works(reader)
        held = Path(f"/proc/{process_of(reader)}/environ").read_bytes()
        assert b"secret" not in held
        assert b"PYTHONPATH" in held


@pytest.mark.parametrize("name", SOUND)
def test_damaged_files_are_read_or_refused_and_nothing_else(reader: FileReader, name: str) -> None:
    rng = np.random.default_rng([SEED, len(name)])
    for _ in range(CASES):
        data = mutated_bytes(SOUND[name], rng)
        try:
            read = reader.read(name, data, **BESIDE)
        except (UnreadableFile, InternalError):
            raise AssertionError(f"{name}: {data!r}") from None
        except (MalformedRequest, InvalidInput, PayloadTooLarge):
            continue
        assert (read.points is None) != (read.depth is None)


def test_it_costs_little(reader: FileReader) -> None:
    """A view of an ordinary camera; a process for each file would take half a second."""
    view = np.random.default_rng(1).integers(500, 1500, (480, 640)).astype(np.uint16)
    data = png(view)

    def milliseconds(read: Callable[..., object]) -> float:
        taken = []
        for _ in range(9):
            started = time.perf_counter()
            read("a.png", data, **BESIDE)
            taken.append(1e3 * (time.perf_counter() - started))
        return float(np.median(taken))

    works(reader)
    here, there = milliseconds(read_cloud_file), milliseconds(reader.read)
    print(f"\n640 x 480 PNG of {len(data)} bytes: {here:.1f} ms here, {there:.1f} ms there", end="")
    assert there < here + 250
