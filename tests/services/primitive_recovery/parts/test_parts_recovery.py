"""The method `parts` as a client of the stage sees it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from shared.schemas.primitive import RecoverRequest, RecoverResponse
from shared.schemas.scene import SupportPlane
from shared.superquadric import radial_distance
from tests.services.primitive_recovery.parts.views import Seen, overlap, seen

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def stage() -> PrimitiveRecovery:
    return PrimitiveRecovery(PrimitiveRecoverySettings())


@pytest.fixture(scope="module")
def hammer() -> Seen:
    return seen("hammer", 2001)


def recovered(stage: PrimitiveRecovery, view: Seen, seed: int = 0) -> RecoverResponse:
    return stage.recover(RecoverRequest(points=view.points, plane=view.plane, seed=seed))


def test_every_point_has_a_part_and_every_part_its_points(
    stage: PrimitiveRecovery, hammer: Seen
) -> None:
    answer = recovered(stage, hammer)
    assert answer.method == "parts"
    assert answer.removed_as_overlap == 0
    assert answer.point_primitive is not None
    counts = np.bincount(answer.point_primitive)
    assert [one.support for one in answer.primitives] == counts.tolist()
    assert counts.tolist() == sorted(counts, reverse=True)


def test_superquadrics_lie_on_their_own_points(stage: PrimitiveRecovery, hammer: Seen) -> None:
    answer = recovered(stage, hammer)
    assert answer.point_primitive is not None
    for one in answer.primitives:
        own = hammer.points[answer.point_primitive == one.id]
        off = np.abs(radial_distance(one.superquadric, own))
        assert np.median(off) < 0.008
        assert off.max() < 0.05


def test_joints_and_covariances_speak_of_the_primitives(
    stage: PrimitiveRecovery, hammer: Seen
) -> None:
    answer = recovered(stage, hammer)
    assert [joint.primitive_ids for joint in answer.joints] == [(0, 1)]
    assert answer.covariances is not None
    assert answer.covariances.shape == (2, 11, 11)
    for each in answer.covariances:
        np.testing.assert_allclose(each, each.T, rtol=1e-6, atol=1e-12)
        assert np.linalg.eigvalsh(each).min() > -1e-9


def test_the_same_seed_gives_the_same_answer(stage: PrimitiveRecovery, hammer: Seen) -> None:
    assert recovered(stage, hammer, 3) == recovered(stage, hammer, 3)


def test_another_object_in_front_is_another_matter(stage: PrimitiveRecovery) -> None:
    """Points that something hides leave a gap, not another part."""
    view = seen("spoon", 2001)
    whole = recovered(stage, view)
    middle = np.median(view.points, axis=0)
    long_axis = np.linalg.svd(view.points - middle, full_matrices=False)[2][0]
    along = (view.points - middle) @ long_axis
    kept = np.abs(along) > 0.006
    hidden = Seen(view.points[kept], view.region[kept], view.plane)
    answer = recovered(stage, hidden)
    assert len(answer.primitives) == len(whole.primitives)
    assert answer.point_primitive is not None
    assert whole.point_primitive is not None
    assert (answer.point_primitive == whole.point_primitive[kept]).mean() > 0.9


def lattice(size: tuple[float, float, float], corner: tuple[float, float, float]) -> Array:
    """Return points 1.5 mm apart on the top and the front (least y) of a box on a table."""
    x, y, z = (np.arange(0.0, max(each, 1e-9), 0.0015) for each in size)
    top = np.stack(np.meshgrid(x, y, [size[2]], indexing="ij"), axis=-1).reshape(-1, 3)
    front = np.stack(np.meshgrid(x, [0.0], z, indexing="ij"), axis=-1).reshape(-1, 3)
    return np.vstack([top, front]) + corner


@pytest.mark.parametrize("noise", [0.0, 0.0003])
def test_a_blade_as_wide_as_its_handle_is_a_part(
    stage: PrimitiveRecovery, noise: float, rng: np.random.Generator
) -> None:
    """2.5 mm on a table beside a handle of 16 mm: the width says nothing, the height does."""
    handle = lattice((0.11, 0.028, 0.016), (0.0, 0.0, 0.0))
    blade = lattice((0.16, 0.028, 0.0025), (0.11, 0.0, 0.0))
    points = np.vstack([handle, blade])
    viewpoint = np.array([0.1, -0.5, 0.6])
    rays = points - viewpoint
    points = points + noise * rng.normal(size=(len(points), 1)) * rays / np.linalg.norm(
        rays, axis=1, keepdims=True
    )
    answer = stage.recover(
        RecoverRequest(
            points=points,
            viewpoint=(0.1, -0.5, 0.6),
            plane=SupportPlane(
                normal=(0.0, 0.0, 1.0), offset=0.0, inliers=1000, residual_mm=1e3 * noise
            ),
        )
    )
    assert answer.point_primitive is not None
    of_blade = np.arange(len(points)) >= len(handle)
    assert overlap(answer.point_primitive, of_blade) > 0.9
    assert overlap(answer.point_primitive, ~of_blade) > 0.9
    found = np.median(points[answer.point_primitive == 0][:, 0])
    blade_id = 0 if found > 0.11 else 1
    thickness, width, length = np.sort(answer.primitives[blade_id].full_extents)
    assert thickness < 0.005
    assert width == pytest.approx(0.028, rel=0.15)
    assert length == pytest.approx(0.16, rel=0.15)
