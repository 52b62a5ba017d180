"""Two Ray nodes, one of which is killed in the middle: every question is settled once."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pyarrow")
if importlib.util.find_spec("ray") is None:  # not imported here: its settings come first
    pytest.skip("Ray is not installed", allow_module_level=True)

from services.annotate.drive import MAX_ATTEMPTS
from tests.support.annotating import rejects, rows, settled, write_inputs

ROOT = Path(__file__).parents[3]
LOOPBACK = {"0100007F", "0000000000000000FFFF00000100007F", "00000000000000000000000001000000"}
"""127.0.0.1, the same as an IPv6 address, and ::1, as /proc/net has them."""
FILES = {f"{number:03d}.xyz": f"cloud {number}" for number in range(100)}


def on_ray(*words: str) -> dict[str, Any]:
    """Return what `tests.support.ray_run` prints; any warning in it is an error."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-m", "tests.support.ray_run", *words],
        capture_output=True,
        text=True,
        timeout=600,
        cwd=ROOT,
    )
    assert done.returncode == 0, done.stderr
    told: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return told


@pytest.mark.slow
def test_a_node_is_killed_in_the_middle(tmp_path: Path) -> None:
    files = {
        **FILES,
        "070-empty.xyz": "empty",
        "080-poison.xyz": "poison",
        "090-hang.xyz": f"hang {tmp_path / 'hung'}",
    }
    folder, out, started = write_inputs(tmp_path / "in", files), tmp_path / "out", tmp_path / "up"
    started.mkdir()
    told = on_ray("cluster", str(folder), str(out), str(started))
    assert set(told["listens_on"]) <= LOOPBACK
    assert told["listens_on"]
    assert len(told["workers_on"]) == 2
    assert told["killed"] in told["workers_on"]
    assert 30 <= told["settled_then"] < 70
    assert settled(out) == sorted((name, "pouring") for name in files)
    assert {path: (row["code"], row["attempts"]) for (path, _), row in rejects(out).items()} == {
        "070-empty.xyz": ("empty_cloud", 1),
        "080-poison.xyz": ("worker_died", MAX_ATTEMPTS),
    }
    assert (tmp_path / "hung").exists()
    assert len(rows(out)) == told["annotated"] == len(FILES) + 1
