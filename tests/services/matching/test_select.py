from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from services.matching.select import select_grasps
from shared.errors import EmptyCloud, InvalidInput
from shared.geometry.se3 import transform_points
from shared.schemas.grasp import SelectRequest, SelectResponse
from tests.services.matching.clouds import some_motion

LINE = np.column_stack([np.linspace(0, 0.2, 21), np.zeros(21), np.zeros(21)])
LEFT = LINE[:, 0] < 0.095


def grasps_at(*rows: tuple[float, float]) -> np.ndarray:
    """Return grasps at x with a score, 3 cm above the line."""
    return np.array([[x, 0, 0.03, 0, 0, 0, 1, 0.02, score] for x, score in rows]).reshape(-1, 9)


def select(grasps: np.ndarray, **changes: object) -> SelectResponse:
    fields = {"points": LINE, "point_region": LEFT, "grasps": grasps} | changes
    return select_grasps(SelectRequest.model_validate(fields))


def test_keeps_grasps_in_the_region_best_first() -> None:
    grasps = grasps_at((0.01, 0.2), (0.15, 0.9), (0.05, 0.7), (0.03, 0.5))
    answer = select(grasps)
    assert answer.indices.tolist() == [2, 3, 0]
    assert np.array_equal(answer.grasps, grasps[[2, 3, 0]])
    assert answer.outside_region == 1


def test_at_most_max_grasps_but_counts_all_outside() -> None:
    grasps = grasps_at((0.15, 0.9), (0.01, 0.2), (0.05, 0.7), (0.19, 0.1))
    answer = select(grasps, max_grasps=1)
    assert answer.indices.tolist() == [2]
    assert answer.outside_region == 2
    assert len(select(grasps, max_grasps=0).grasps) == 0


def test_equal_scores_keep_the_order_of_the_request() -> None:
    assert select(grasps_at((0.05, 0.5), (0.01, 0.5), (0.03, 0.5))).indices.tolist() == [0, 1, 2]


def test_a_point_between_two_parts_counts_as_in_the_region_whatever_the_order() -> None:
    points = np.array([[0.0, 0, 0], [0.1, 0, 0]])
    for region in ([True, False], [False, True]):
        answer = select(grasps_at((0.05, 0.5)), points=points, point_region=np.array(region))
        assert answer.indices.tolist() == [0]


def test_the_closest_point_is_not_enough_where_the_contacts_are_known() -> None:
    grasps = grasps_at((0.01, 0.5), (0.02, 0.5), (0.03, 0.5), (0.15, 0.5))
    shares = np.array([[0.4, 1.0, 1.0], [1.0, 1.0, 0.4], [0.6, 0.5, 0.7], [1.0, 1.0, 1.0]])
    answer = select(grasps, on_region=shares)
    assert answer.indices.tolist() == [2]
    assert answer.outside_region == 3


def test_a_grasp_well_inside_goes_before_one_at_the_border() -> None:
    grasps = grasps_at((0.08, 0.6), (0.01, 0.5), (0.02, 0.4))
    shares = np.array([[0.6, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.0]])
    answer = select(grasps, on_region=shares)
    assert answer.indices.tolist() == [1, 2, 0]
    assert answer.grasps[0, 8] == 0.5  # the score stays what it was: the chance to lift


def test_a_way_in_that_comes_near_the_rest_goes_behind_its_equals() -> None:
    grasps = grasps_at((0.01, 0.5), (0.02, 0.45), (0.03, 0.3))
    clear = np.array([False, True, True])
    assert select(grasps, keeps_clear=clear).indices.tolist() == [1, 0, 2]
    assert select(grasps, keeps_clear=~clear).indices.tolist() == [0, 1, 2]
    assert select(grasps_at((0.01, 0.5), (0.02, 0.34)), keeps_clear=clear[:2]).indices[0] == 1
    assert select(grasps_at((0.01, 0.5), (0.02, 0.33)), keeps_clear=clear[:2]).indices[0] == 0


def test_one_that_hardly_fails_stays_before_one_that_fails_five_times_as_often() -> None:
    grasps = grasps_at((0.01, 0.98), (0.02, 0.9), (0.03, 1.0), (0.04, 0.0))
    near = np.array([False, True, False, False])
    assert select(grasps, keeps_clear=near).indices.tolist() == [2, 0, 1, 3]


def test_nothing_in_nothing_out() -> None:
    empty = select(np.empty((0, 9)))
    assert empty.grasps.shape == (0, 9)
    assert empty.outside_region == 0
    nowhere = select(grasps_at((0.01, 0.2)), point_region=np.zeros(21, dtype=bool))
    assert nowhere.grasps.shape == (0, 9)
    assert nowhere.outside_region == 1
    bare = select(np.empty((0, 9)), points=np.empty((0, 3)), point_region=np.empty(0, dtype=bool))
    assert bare.indices.shape == (0,)


def test_a_rigid_motion_changes_nothing() -> None:
    grasps = grasps_at((0.01, 0.2), (0.15, 0.9), (0.05, 0.7), (0.03, 0.5))
    moved = grasps.copy()
    moved[:, :3] = transform_points(some_motion(), grasps[:, :3])
    answer = select(moved, points=transform_points(some_motion(), LINE))
    assert answer.indices.tolist() == select(grasps).indices.tolist()


@given(st.permutations(range(21)), st.permutations(range(4)))
def test_orders_of_points_and_grasps_do_not_matter(points: list[int], rows: list[int]) -> None:
    grasps = grasps_at((0.01, 0.2), (0.15, 0.9), (0.05, 0.7), (0.03, 0.5))
    answer = select(grasps[rows], points=LINE[points], point_region=LEFT[points])
    assert np.array_equal(answer.grasps, select(grasps).grasps)
    assert np.array_equal(grasps[rows][answer.indices], answer.grasps)


def test_bad_input_is_named() -> None:
    grasp = grasps_at((0.01, 0.2))
    with pytest.raises(InvalidInput, match="point_region has 3 entries for 21 points"):
        select(grasp, point_region=np.ones(3, dtype=bool))
    with pytest.raises(InvalidInput, match="points must be finite"):
        select(grasp, points=LINE * np.nan)
    with pytest.raises(InvalidInput, match="grasps must be finite"):
        select(np.full_like(grasp, np.inf))
    with pytest.raises(InvalidInput, match="on_region has 2 rows for 1 grasps"):
        select(grasp, on_region=np.ones((2, 3)))
    with pytest.raises(InvalidInput, match="keeps_clear has 2 rows for 1 grasps"):
        select(grasp, keeps_clear=np.ones(2, dtype=bool))
    with pytest.raises(InvalidInput, match="on_region must be finite"):
        select(grasp, on_region=np.full((1, 3), np.nan))
    with pytest.raises(InvalidInput, match="metres"):
        select(grasp, points=LINE + 1e200)
    with pytest.raises(EmptyCloud, match="1 grasps"):
        select(grasp, points=np.empty((0, 3)), point_region=np.empty(0, dtype=bool))


def test_says_why_grasps_are_left_out_where_asked() -> None:
    grasps = grasps_at((0.01, 0.2), (0.15, 0.9), (0.05, 0.7), (0.03, 0.5))
    before = np.array([[0.1, 0.1, 0.0, 0, 1, 0, 0, 0.08]])
    asked = {"rejected_poses": before, "rejected_reasons": ("too_wide",), "max_grasps": 2}
    answer = select(grasps, rejected=10, **asked)
    assert answer.indices.tolist() == [2, 3]
    assert answer.rejected_reasons == ("too_wide", "outside_region", "beyond_max_grasps")
    assert answer.rejected_poses is not None
    assert np.array_equal(answer.rejected_poses, np.vstack([before, grasps[[1, 0], :8]]))
    assert len(select(grasps, rejected=2, **asked).rejected_reasons) == 2
    silent = select(grasps, **asked)
    assert silent.rejected_poses is None
    assert "rejected" not in silent.model_dump_json()
    assert np.array_equal(silent.grasps, answer.grasps)


def test_what_is_left_out_follows_the_seed(rng: np.random.Generator) -> None:
    grasps = grasps_at(*((x, 0.5) for x in rng.uniform(0, 0.2, 80)))
    one, again, other = (select(grasps, rejected=9, seed=seed) for seed in (1, 1, 2))
    assert one == again
    assert one.rejected_poses is not None
    assert one != other
    for code, row in zip(one.rejected_reasons, one.rejected_poses, strict=True):
        assert (code == "outside_region") == (row[0] > 0.095)
    assert len(np.unique(one.rejected_poses, axis=0)) == 9


def test_reasons_that_do_not_fit_the_poses_are_named() -> None:
    before = np.array([[0.1, 0.1, 0.0, 0, 1, 0, 0, 0.08]])
    with pytest.raises(InvalidInput, match="0 rejected_reasons for 1 rejected_poses"):
        select(grasps_at((0.01, 0.2)), rejected=3, rejected_poses=before)
    with pytest.raises(InvalidInput, match="rejected_poses must be finite"):
        select(
            grasps_at((0.01, 0.2)),
            rejected=3,
            rejected_poses=np.full_like(before, np.inf),
            rejected_reasons=("too_wide",),
        )
    with pytest.raises(ValueError, match="rejected"):
        select(grasps_at((0.01, 0.2)), rejected=201)
