from __future__ import annotations

import numpy as np
import pytest

from services.matching.region import find_region
from shared.errors import InvalidInput
from shared.geometry.se3 import transform_points
from shared.schemas.grasp import RegionRequest, RegionResponse
from shared.schemas.primitive import Primitive
from shared.superquadric import radial_distance
from tests.services.matching.clouds import (
    HANDLE,
    HEAD,
    as_primitive,
    moved,
    some_motion,
    surface_points,
)

POINTS = np.vstack([surface_points(HANDLE), surface_points(HEAD)])
BOTH = (as_primitive(4, HANDLE), as_primitive(9, HEAD))


def region(
    points: np.ndarray = POINTS, primitives: tuple[Primitive, ...] = BOTH, *ids: int
) -> RegionResponse:
    return find_region(RegionRequest(points=points, primitives=primitives, primitive_ids=ids))


def test_points_go_to_the_primitive_with_the_smallest_radial_distance() -> None:
    answer = region(POINTS, BOTH, 9)
    to_handle = np.abs(radial_distance(HANDLE, POINTS))
    to_head = np.abs(radial_distance(HEAD, POINTS))
    owned = np.where(answer.point_primitive == 4, to_handle, to_head)
    assert np.array_equal(owned, np.minimum(to_handle, to_head))
    assert np.array_equal(answer.point_region, answer.point_primitive == 9)
    assert answer.point_primitive.dtype == np.int16


def test_points_inside_a_primitive_are_its_own() -> None:
    centre = np.array([HEAD.position, HANDLE.position])
    assert region(centre).point_primitive.tolist() == [9, 4]


def test_a_rigid_motion_changes_nothing() -> None:
    motion = some_motion()
    primitives = (as_primitive(4, moved(HANDLE, motion)), as_primitive(9, moved(HEAD, motion)))
    answer = region(transform_points(motion, POINTS), primitives, 4)
    expected = region(POINTS, BOTH, 4)
    near_tie = np.abs(
        np.abs(radial_distance(HANDLE, POINTS)) - np.abs(radial_distance(HEAD, POINTS))
    )
    clear = near_tie > 1e-9
    assert np.array_equal(answer.point_primitive[clear], expected.point_primitive[clear])


def test_the_order_of_points_only_orders_the_answer() -> None:
    order = np.random.default_rng(1).permutation(len(POINTS))
    assert np.array_equal(
        region(POINTS[order], BOTH, 4).point_region, region(POINTS, BOTH, 4).point_region[order]
    )


def test_between_equals_the_first_primitive_wins() -> None:
    twins = (as_primitive(7, HEAD), as_primitive(2, HEAD))
    assert set(region(POINTS, twins).point_primitive) == {7}


def test_no_chosen_primitive_means_no_region() -> None:
    assert not region().point_region.any()


def test_without_primitives_all_points_belong_to_none() -> None:
    answer = region(POINTS, ())
    assert set(answer.point_primitive) == {-1}
    assert not answer.point_region.any()


def test_without_points_the_answer_is_empty() -> None:
    answer = region(np.empty((0, 3)), BOTH, 4)
    assert answer.point_primitive.shape == (0,)
    assert answer.point_region.shape == (0,)


def test_an_unknown_primitive_is_named() -> None:
    with pytest.raises(InvalidInput, match=r"\[5\].*\[4, 9\]") as caught:
        region(POINTS, BOTH, 5, 4)
    assert caught.value.details["found"] == [5]


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e200])
def test_points_must_be_finite_metres(bad: float) -> None:
    points = POINTS.copy()
    points[3, 1] = bad
    with pytest.raises(InvalidInput, match="points"):
        region(points)


@pytest.mark.parametrize(
    ("index", "value"), [(0, 0.0), (2, -0.01), (slice(8, 12), 0.0)], ids=["e1", "a1", "rotation"]
)
def test_a_primitive_must_have_a_shape(index: int | slice, value: float) -> None:
    parameters = HEAD.to_vector()
    parameters[index] = value
    broken = as_primitive(3, HEAD).model_copy(update={"parameters": tuple(parameters.tolist())})
    with pytest.raises(InvalidInput, match="primitive 3 has no shape"):
        region(POINTS, (broken,))


def test_ids_must_be_unique_and_fit() -> None:
    with pytest.raises(InvalidInput, match="unique"):
        region(POINTS, (as_primitive(1, HEAD), as_primitive(1, HANDLE)))
    with pytest.raises(InvalidInput, match="at most 32767"):
        region(POINTS, (as_primitive(40000, HEAD),))


def test_far_points_and_sharp_primitives_stay_finite() -> None:
    sharp = as_primitive(0, HEAD).model_copy(
        update={"parameters": (0.1, 0.1, *HEAD.to_vector()[2:].tolist())}
    )
    assert region(np.array([[1e6, -1e6, 1e6], [0, 0, 0.1]]), (sharp,)).point_primitive.tolist() == [
        0,
        0,
    ]


def test_assignments_that_the_request_brings_are_kept() -> None:
    given = np.where(np.arange(len(POINTS)) % 2 == 0, 4, -1).astype(np.int16)
    answer = find_region(
        RegionRequest(points=POINTS, primitives=BOTH, primitive_ids=(4,), point_primitive=given)
    )
    assert np.array_equal(answer.point_primitive, given)
    assert np.array_equal(answer.point_region, given == 4)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (np.full(3, 4, np.int16), "3 entries"),
        (np.full(len(POINTS), 7, np.int16), r"names \[7\]"),
    ],
)
def test_assignments_that_do_not_fit_are_refused(given: np.ndarray, message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        find_region(
            RegionRequest(points=POINTS, primitives=BOTH, primitive_ids=(4,), point_primitive=given)
        )
