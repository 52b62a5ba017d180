"""A Ray cluster to work on: one of this machine alone that ends with us, or a running one."""

from __future__ import annotations

import contextlib
import logging
import os
import secrets
import sys
from collections.abc import Iterator
from typing import Any

from shared.errors import StageUnavailable

OBJECT_STORE_BYTES = 512 * 2**20
"""For the files and rows on their way; Ray would take a third of the memory."""

_PRIVATE = {
    # Ray's own switch for clusters of one machine, whatever its name says: every port is
    # opened on the loopback alone. By default any interface would be listened on.
    "RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0",
    "RAY_AUTH_MODE": "token",
    "OMP_NUM_THREADS": "1",  # what Ray sets for a worker of one CPU, if nothing is set
}


def private_ray() -> None:
    """Set Ray up, before it is imported, for a cluster that nobody else can reach.

    What the user has set stays; where Ray was imported before, its settings stand.
    """
    if "ray" not in sys.modules:
        for name, value in {**_PRIVATE, "RAY_AUTH_TOKEN": secrets.token_hex(32)}.items():
            os.environ.setdefault(name, value)


@contextlib.contextmanager
def ray_session(address: str | None, workers: int | None) -> Iterator[int]:
    """Connect to Ray; yield how many workers there will be.

    Ray reads its environment when it is imported, so nothing that runs before may import it.

    Parameters
    ----------
    address : str or None
        Of a running cluster (`auto`: that of this machine). None starts Ray here, on
        127.0.0.1 only, with a password of its own, without dashboard and telemetry.
    workers : int or None
        How many are wanted; None: one per processor.

    Raises
    ------
    ImportError
        Ray is not installed.
    StageUnavailable
        There is no cluster at `address`, or Ray cannot be started here.
    """
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    if address is None:
        private_ray()
    import ray

    here: dict[str, Any] = {
        "num_cpus": workers or len(os.sched_getaffinity(0)),
        "num_gpus": 0,
        "include_dashboard": False,
        "object_store_memory": OBJECT_STORE_BYTES,
    }
    there = {"address": address}
    try:
        ray.init(
            **(here if address is None else there), log_to_driver=False, logging_level=logging.ERROR
        )
    except Exception as error:  # Ray's own are of many kinds, `Exception` among them
        what = "Ray cannot be started" if address is None else f"no Ray cluster at {address}"
        reason = str(error).strip().partition("\n")[0]
        raise StageUnavailable(f"{what}: {reason}") from None
    try:
        yield workers or max(int(ray.cluster_resources().get("CPU", 1)), 1)
    finally:
        ray.shutdown()
