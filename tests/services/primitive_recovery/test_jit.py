"""Kernels compile with and without a cache on disk."""

from __future__ import annotations

import concurrent.futures
import json
import os
import subprocess
import sys
from pathlib import Path

from shared.settings import PROJECT_ROOT

WARM_UP = """
import json
from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from shared.jit import types_compiled
recovery = PrimitiveRecovery(PrimitiveRecoverySettings())
recovery.warm_up_ems()
{further}
print(json.dumps(types_compiled()))
"""
PARTS = "recovery.warm_up()"


def start(cache: Path | None, further: str = "") -> dict[str, int]:
    """Return how many combinations of types each kernel has in a process that warmed up."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    if cache is not None:
        environment["NUMBA_CACHE_DIR"] = str(cache)
    run = subprocess.run(
        [sys.executable, "-c", WARM_UP.format(further=further)],
        env=environment,
        cwd=PROJECT_ROOT,
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    types: dict[str, int] = json.loads(run.stdout)
    return types


def more_than_one(types: dict[str, int]) -> dict[str, int]:
    """Return the kernels that processes could overwrite each other's entries of.

    (None: it was loaded within a caller. What only kernels of the same file call is compiled
    with them, in their order.)
    """
    return {
        name: number
        for name, number in types.items()
        if number > 1 and not name.split(".")[-1].startswith("_")
    }


def test_processes_that_start_together_share_an_empty_cache(tmp_path: Path) -> None:
    # The method with the fewest kernels: all of them take a minute and a half of each process.
    with concurrent.futures.ThreadPoolExecutor() as pool:
        runs = [one.result() for one in [pool.submit(start, tmp_path) for _ in range(2)]]
    for types in (*runs, start(tmp_path)):
        assert more_than_one(types) == {}
    assert any(tmp_path.rglob("*.nbi"))


def test_every_kernel_is_called_with_one_combination_of_types() -> None:
    types = start(None, PARTS)
    assert len(types) > 60
    assert more_than_one(types) == {}
