"""What the arithmetic of a request alone would take: the estimate that stages are held against."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from experiments.camera import D435
from experiments.framework import Table
from shared.geometry.points import points_from_depth
from shared.superquadric import Superquadric, radial_distance
from shared.wire.npz import read_npz, write_npz

REPEAT = 15
OBJECT_POINTS = 5_000
DEPTH_SCALE = 1e-4


def limits_table(rng: np.random.Generator) -> Table:
    """Time single passes over data of a request's size on one core, the least of `REPEAT` runs."""
    shape = (D435.height, D435.width)
    depth = rng.integers(6_000, 12_000, shape).astype(np.uint16)
    metres = (DEPTH_SCALE * depth).astype(np.float32)
    rays = D435.rays().astype(np.float32)
    normal, offset = np.array([0.0, -0.8, -0.6]), 0.9
    slope = rays @ normal.astype(np.float32)
    points = points_from_depth(depth, D435.intrinsics, DEPTH_SCALE)
    body = write_npz({"depth": depth})
    superquadric = Superquadric((0.5, 0.8), (0.03, 0.05, 0.1), (0, 0, 0.8), (0, 0, 0, 1))
    cloud = rng.normal((0.0, 0.0, 0.8), 0.05, (OBJECT_POINTS, 3))
    pixels, size = f"{depth.size:,} pixels", len(body) / 1e3
    passes: dict[str, Callable[[], object]] = {
        f"unpack the {size:.0f} kB of a depth image": lambda: read_npz(body, 2**24),
        f"{pixels}: distance to a plane, in the image, float32": lambda: (
            metres * slope + np.float32(offset)
        ),
        f"{pixels} to points, float64": lambda: points_from_depth(
            depth, D435.intrinsics, DEPTH_SCALE
        ),
        f"{pixels}: distance of the points to a plane, float64": lambda: points @ normal + offset,
        f"copy the {points.nbytes / 1e6:.1f} MB of points": points.copy,
        f"{OBJECT_POINTS:,} object points: distance to a superquadric": lambda: radial_distance(
            superquadric, cloud
        ),
    }
    return Table(
        "limits",
        "Single passes over the data of a request",
        ("pass", "ms"),
        tuple((name, _least(work)) for name, work in passes.items()),
        f"Processor time in the process of the experiment, one core, the least of {REPEAT} runs: "
        "what a stage would take that did each of these once.",
    )


def _least(work: Callable[[], object]) -> float:
    """Return the least milliseconds of processor time of several runs."""
    spent = []
    for _ in range(REPEAT):
        started = time.process_time()
        work()
        spent.append(time.process_time() - started)
    return 1e3 * min(spent)
