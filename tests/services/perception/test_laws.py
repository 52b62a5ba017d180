"""What must not matter: the frame, the order of the points, the seed, other requests."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from services.perception.perceive import Perception
from shared.geometry.se3 import pose_matrix, transform_points
from shared.schemas.scene import PerceiveRequest
from shared.settings import PROJECT_ROOT
from shared.wire import NPZ, encode
from tests.services.perception.scenes import Shot, small_view

STAGE = Perception()


@pytest.fixture(scope="module")
def noisy() -> Shot:
    return small_view().with_noise(np.random.default_rng(5), 0.0015)


def overlap(a: set[int], b: set[int]) -> float:
    return len(a & b) / len(a | b)


def chosen(request: PerceiveRequest) -> set[int]:
    return set(STAGE.perceive(request).object_indices.tolist())


def test_depth_and_its_points_give_the_same(noisy: Shot) -> None:
    """But for the gaze, which bare points do not tell exactly."""
    points = PerceiveRequest(points=noisy.cloud())
    assert overlap(chosen(noisy.request()), chosen(points)) > 0.98


@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_rigid_motion(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shot = small_view().with_noise(np.random.default_rng(5), 0.0015)
    rotation = Rotation.random(random_state=rng).as_matrix()
    motion = pose_matrix(rng.uniform(-2, 2, 3), rotation)
    here = STAGE.perceive(PerceiveRequest(points=shot.cloud()))
    there = STAGE.perceive(
        PerceiveRequest(
            points=transform_points(motion, shot.cloud()), viewpoint=tuple(motion[:3, 3].tolist())
        )
    )
    assert overlap(set(here.object_indices.tolist()), set(there.object_indices.tolist())) > 0.97
    np.testing.assert_allclose(rotation @ here.up, there.up, atol=1e-3)
    assert here.clusters == there.clusters


@settings(max_examples=5, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_order_of_the_points(seed: int) -> None:
    shot = small_view().with_noise(np.random.default_rng(5), 0.0015)
    points = shot.cloud()
    order = np.random.default_rng(seed).permutation(len(points))
    shuffled = {int(order[row]) for row in chosen(PerceiveRequest(points=points[order]))}
    assert overlap(chosen(PerceiveRequest(points=points)), shuffled) > 0.97


@settings(max_examples=5, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_seed(seed: int) -> None:
    shot = small_view().with_noise(np.random.default_rng(5), 0.0015)
    assert overlap(chosen(shot.request()), chosen(shot.request(seed=seed))) > 0.97


def test_the_same_request_gives_the_same_bytes_whoever_else_asks(noisy: Shot) -> None:
    clean = small_view()
    requests = [noisy.request(), clean.request(), noisy.request(seed=7)]
    alone = [encode(STAGE.perceive(request), NPZ) for request in requests]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda r: encode(STAGE.perceive(r), NPZ), requests * 4))
    assert together == alone * 4


def test_the_number_of_threads() -> None:
    """BLAS and OpenMP add in another order with another number of threads."""
    program = """
import hashlib
import numpy as np
from services.perception.perceive import Perception
from shared.wire import NPZ, encode
from tests.services.perception.scenes import Stage, spoon
shot = spoon(Stage().table()).shoot().with_noise(np.random.default_rng(0), 0.0015)
print(hashlib.sha256(encode(Perception().perceive(shot.request()), NPZ)).hexdigest())
"""
    digests = {
        subprocess.run(
            [sys.executable, "-c", program],
            env={**os.environ, "OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads},
            cwd=PROJECT_ROOT,
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for threads in ("1", "2")
    }
    assert len(digests) == 1


def test_far_outliers_and_missing_rows_change_nothing(noisy: Shot) -> None:
    points = noisy.cloud()
    stray = np.array([[1e9, 0, 0], [np.inf, 0, 1], [0, 900.0, 0], [np.nan, 1, 1]])
    more = PerceiveRequest(points=np.vstack([points, stray]))
    assert overlap(chosen(PerceiveRequest(points=points)), chosen(more)) > 0.97
