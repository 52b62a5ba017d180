"""Scenes of two things: what is in front of an object is neither its edge nor its background."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial.transform import Rotation

from experiments.camera import StereoNoise
from services.primitive_recovery.parts.cutter import Cutter
from services.primitive_recovery.parts.grid import bridged, nearest_of
from services.primitive_recovery.parts.profile import hidden_reach, profile
from services.primitive_recovery.parts.segment import Segmentation, segment
from services.primitive_recovery.parts.view import part_view
from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from shared.schemas.primitive import RecoverRequest
from tests.services.primitive_recovery.parts.views import Seen, overlap, seen

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
ORIGIN = np.zeros(3)
THIN = 0.005
"""Metres between the points of what stands in front, as perception reports obstacles."""


@pytest.fixture(scope="module")
def cutter() -> Cutter:
    return Cutter.load()


def card(points: Array, low: float, high: float, across: tuple[float, float]) -> tuple[Mask, Array]:
    """Return which points (N,) a card in front of an object leaves visible, and the card's.

    It covers from `low` to `high` of the object's length as the sensor at the origin sees
    it, and the range `across` of its width there; 5 cm nearer than the nearest point.
    """
    flat = points[:, :2] / points[:, 2:]
    middle = flat.mean(axis=0)
    axes = np.linalg.svd(flat - middle, full_matrices=False)[2]
    placed = (flat - middle) @ axes.T
    first, size = placed.min(axis=0), np.ptp(placed, axis=0)
    start = first + size * np.array([low, across[0]])
    end = first + size * np.array([high, across[1]])
    covered = ((placed > start) & (placed < end)).all(axis=1)
    depth = points[:, 2].min() - 0.05
    u, v = (np.arange(a, b, THIN / depth) for a, b in zip(start, end, strict=True))
    grid = np.column_stack([each.ravel() for each in np.meshgrid(u, v)]) @ axes + middle
    return ~covered, depth * np.column_stack([grid, np.ones(len(grid))])


def disc(pitch: float = 0.002) -> Array:
    """Return a lattice of points within a disc of 10 cm, a metre ahead of the origin."""
    side = np.arange(-0.1, 0.1, pitch)
    x, y = (each.ravel() for each in np.meshgrid(side, side))
    placed = np.column_stack([x, y, np.ones_like(x)])
    return np.asarray(placed[np.hypot(x, y) < 0.1])


def cut_both(
    view: Seen, visible: Mask, front: Array, cutter: Cutter
) -> tuple[Segmentation, Segmentation]:
    alone = segment(view.points, ORIGIN, view.plane, cutter)
    told = segment(view.points[visible], ORIGIN, view.plane, cutter, front)
    return alone, told


def same_parts(one: NDArray[np.int16], other: NDArray[np.int16]) -> float:
    """Return the least IoU of any part with the best one of the other cut."""
    return min(
        overlap(other, one == part) for part in range(int(one.max()) + 1) if (one == part).any()
    )


@pytest.mark.parametrize("noise", [None, StereoNoise()])
@pytest.mark.parametrize("class_name", ["hammer", "ladle", "pan", "spatula", "bottle", "knife"])
def test_parts_behind_a_card_are_those_without_it(
    class_name: str, noise: StereoNoise | None, cutter: Cutter
) -> None:
    found, places = [], [(0.15, 0.3), (0.5, 0.65), (0.7, 0.85)]
    for number in (2001, 2002):
        view = seen(class_name, number, noise)
        for low, high in places:
            visible, front = card(view.points, low, high, (-0.5, 1.5))
            alone, told = cut_both(view, visible, front, cutter)
            assert len(told.labels) == visible.sum()
            found.append(same_parts(alone.labels[visible], told.labels))
    assert np.mean(np.array(found) > 0.9) >= 0.8


@pytest.mark.parametrize("class_name", ["box", "can", "bowl"])
@pytest.mark.parametrize(
    ("place", "across"),
    [((0.6, 1.2), (0.5, 1.5)), ((-0.2, 0.4), (-0.5, 0.5)), ((0.35, 0.65), (-0.5, 0.5))],
    ids=["one corner", "the other corner", "a bite of the side"],
)
def test_the_edge_of_what_is_in_front_is_no_border(
    class_name: str, place: tuple[float, float], across: tuple[float, float], cutter: Cutter
) -> None:
    whole = 0
    for number in range(2001, 2006):
        view = seen(class_name, number)
        visible, front = card(view.points, *place, across)
        whole += segment(view.points[visible], ORIGIN, view.plane, cutter, front).labels.max() == 0
    assert whole >= 4


@pytest.mark.parametrize("class_name", ["can", "box", "bottle"])
def test_the_superquadric_may_go_on_behind_it(class_name: str) -> None:
    stage = PrimitiveRecovery(PrimitiveRecoverySettings())
    off: dict[str, list[Array]] = {"blind": [], "told": []}
    for number in range(2001, 2009):
        view = seen(class_name, number)
        visible, front = card(view.points, 0.6, 1.2, (0.4, 1.5))
        alone, blind, told = (
            stage.recover(RecoverRequest(points=points, plane=view.plane, obstacle_points=others))
            for points, others in (
                (view.points, None),
                (view.points[visible], None),
                (view.points[visible], front),
            )
        )
        true = np.sort(alone.primitives[0].full_extents)
        for name, answer in (("blind", blind), ("told", told)):
            off[name].append(np.abs(np.log(np.sort(answer.primitives[0].full_extents) / true)))
    assert np.mean(off["told"]) < 0.8 * np.mean(off["blind"])
    assert np.median(off["told"]) < 0.1


def test_a_gap_behind_something_is_no_hole(cutter: Cutter) -> None:
    points = disc()
    visible, front = card(points, 0.4, 0.6, (0.4, 0.6))
    assert segment(points[visible], ORIGIN, None, cutter).holes == (1,)
    assert segment(points[visible], ORIGIN, None, cutter, front).holes == (0,)


def test_a_hole_beside_something_is_still_one(cutter: Cutter) -> None:
    points = disc()
    points = points[np.hypot(points[:, 0] - 0.04, points[:, 1]) > 0.03]
    visible, front = card(points, -0.1, 0.15, (-0.5, 1.5))
    found = segment(points[visible], ORIGIN, None, cutter, front)
    assert sum(found.holes) == 1


@pytest.mark.parametrize("place", [(0.4, 0.55), (0.3, 0.4), (-0.1, 0.3)])
def test_a_ring_behind_a_bar_has_one_hole(place: tuple[float, float], cutter: Cutter) -> None:
    points = disc()
    points = points[np.hypot(points[:, 0], points[:, 1]) > 0.06]
    visible, front = card(points, *place, (-0.5, 1.5))
    assert sum(segment(points[visible], ORIGIN, None, cutter, front).holes) == 1


def test_what_stands_behind_or_beside_hides_nothing(cutter: Cutter) -> None:
    view = seen("mug", 2001)
    _, front = card(view.points, 0.3, 0.6, (-0.5, 1.5))
    for others in (2.0 * front, front + np.array([1.0, 0.0, 0.0]), -front, front[:1], front[:0]):
        found = segment(view.points, ORIGIN, view.plane, cutter, others)
        assert not len(found.front)
        assert (
            found.labels.tobytes()
            == segment(view.points, ORIGIN, view.plane, cutter).labels.tobytes()
        )


def test_the_front_is_where_it_is_seen() -> None:
    points = disc()
    visible, front = card(points, 0.4, 0.6, (-0.5, 1.5))
    hidden = part_view(points[visible], ORIGIN, None, others=front)
    points_of_it = hidden.middle + hidden.hidden.front
    np.testing.assert_allclose(points_of_it[:, 2], front[0, 2], rtol=1e-4)
    behind = hidden.middle + hidden.hidden.behind
    np.testing.assert_allclose(behind[:, 2], 1.0, rtol=1e-4)
    gap = points[~visible]
    bridges = hidden.bridges()
    # The bridge is the gap: about as many points, in the same place.
    assert len(bridges) == pytest.approx(1.8 * len(gap), rel=0.25)
    np.testing.assert_allclose(bridges.mean(axis=0), gap.mean(axis=0), atol=0.003)


def test_a_rigid_motion_of_both_things_changes_nothing(cutter: Cutter) -> None:
    view = seen("hammer", 2002)
    visible, front = card(view.points, 0.5, 0.65, (-0.5, 1.5))
    points = view.points[visible]
    turn, shift = Rotation.random(random_state=3).as_matrix(), np.array([0.3, -0.2, 1.0])
    normal = turn @ np.array(view.plane.normal)
    moved = view.plane.model_copy(
        update={
            "normal": tuple(normal.tolist()),
            "offset": view.plane.offset - float(normal @ shift),
        }
    )
    before = segment(points, ORIGIN, view.plane, cutter, front)
    after = segment(points @ turn.T + shift, shift, moved, cutter, front @ turn.T + shift)
    assert same_parts(before.labels, after.labels) > 0.98
    assert before.holes == after.holes


def test_lines_between_cells() -> None:
    mask = np.zeros((7, 12), dtype=bool)
    mask[2:5, 1:4] = mask[2:5, 8:11] = True
    hidden = np.zeros_like(mask)
    hidden[1:6, 4:8] = True
    depth = np.where(mask, np.arange(12)[None, :] * 1.0, 0.0)
    found = bridged(mask, hidden, depth)
    assert (found[2:5, 4:8] == np.arange(4, 8)).all()
    hidden[:, 6] = False  # background was seen between them
    assert not bridged(mask, hidden, depth).any()


def test_squares_about_points() -> None:
    mask = np.zeros((6, 8), dtype=bool)
    cells, reach = np.array([[2, 2], [2, 4], [-1, 7]]), np.array([1, 1, 1])
    found = nearest_of(mask, cells, reach, np.array([0.5, 0.4, 0.3]))
    expected = np.full((6, 8), np.inf)
    for (row, column), value in zip(cells, (0.5, 0.4, 0.3), strict=True):
        spot = np.zeros((10, 12), dtype=bool)
        spot[row + 2, column + 2] = True
        near = ndimage.binary_dilation(spot, np.ones((3, 3), dtype=bool))[2:8, 2:10]
        expected[near] = np.minimum(expected[near], value)
    np.testing.assert_array_equal(found, expected)


def test_hidden_slices_are_as_wide_as_their_neighbours() -> None:
    x, y = (each.ravel() for each in np.mgrid[-0.1:0.1:0.001, -0.03:0.03:0.001])
    plate = np.column_stack([x, y, 0 * x])
    bite = (np.abs(x) < 0.03) & (y > 0.0)
    axis, ray = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    height = np.zeros((~bite).sum())
    blind = profile(plate[~bite], axis, ray, height, 0.001)
    told = profile(plate[~bite], axis, ray, height, 0.001, plate[bite])
    assert np.ptp(blind.width) > 0.025
    assert np.ptp(told.width) < 0.005
    assert told.filled.min() > 0.9


def test_reach_of_hidden_places() -> None:
    left, right = np.zeros(2), np.full(2, 3.0)
    side, index = np.array([3.5, 4.5, 6.5, -0.5, -9.0]), np.array([0, 0, 0, 1, 1])
    reach = hidden_reach(side, index, left, right, 1.0)
    assert reach[1, 1] == 3.0
    assert reach[0, 0] == 0.0
    assert reach[1, 0] == pytest.approx(7.0, abs=1.0)  # over a gap of one
    assert reach[0, 1] == pytest.approx(-1.0, abs=1.0)
