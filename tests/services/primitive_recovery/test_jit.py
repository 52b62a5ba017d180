"""Kernels compile with and without a cache on disk."""

from __future__ import annotations

import concurrent.futures
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from services.primitive_recovery.ems.jit import kernel
from shared.settings import PROJECT_ROOT

WARM_UP = """
from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
PrimitiveRecovery(PrimitiveRecoverySettings()).warm_up()
from services.primitive_recovery.ems.kernels import normal_equations, radial_distances, turned
print([len(k.signatures) for k in (normal_equations, radial_distances, turned)])
"""


def test_a_function_that_cannot_be_cached_works_all_the_same() -> None:
    # Code without a file has nowhere to keep its cache: numba refuses to cache it.
    scope: dict[str, Callable[[float], float]] = {}
    exec("def twice(x):\n    return 2.0 * x", scope)
    assert kernel(scope["twice"])(4.0) == 8.0


def test_processes_that_start_together_share_an_empty_cache(tmp_path: Path) -> None:
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "OMP_NUM_THREADS": "1"}

    def start() -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-c", WARM_UP],
            env=environment,
            cwd=PROJECT_ROOT,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )

    with concurrent.futures.ThreadPoolExecutor() as pool:
        runs = [one.result() for one in [pool.submit(start) for _ in range(2)]]
    for run in (*runs, start()):
        assert run.returncode == 0, run.stderr
        # One combination of types each, or processes could overwrite each other's entries.
        assert run.stdout.strip() == "[1, 1, 1]"
    assert any(tmp_path.rglob("*.nbi"))
