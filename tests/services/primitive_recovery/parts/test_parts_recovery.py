"""The method `parts` as a client of the stage sees it."""

from __future__ import annotations

import numpy as np
import pytest

from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from shared.schemas.primitive import RecoverRequest, RecoverResponse
from shared.superquadric import radial_distance
from tests.services.primitive_recovery.parts.views import Seen, seen


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
