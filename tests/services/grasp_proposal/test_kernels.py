"""The compiled loops, each against what NumPy makes of the same arrays."""

from __future__ import annotations

import subprocess
import sys
from ast import literal_eval

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.grasp_proposal.boxes import any_inside
from services.grasp_proposal.closer_look import CONTINUES, look_closer
from services.grasp_proposal.eigen import principal_frames
from services.grasp_proposal.neighbourhood import scatter_of_groups, scatter_within
from services.grasp_proposal.placing import (
    COLLIDES,
    GOOD,
    TOO_WIDE,
    UNTRIED,
    Reach,
    place_hands,
)
from shared.settings import PROJECT_ROOT

Array = NDArray[np.float64]

REACH = Reach(
    radius=0.12,
    half_slab=0.0125,
    bin_size=0.0025,
    half_bins=45,
    free_bins=6,
    tip_margin=0.001,
    max_width=0.075,
    max_opening=0.08,
    depth_behind_tip=0.041,
    good_engagement=0.022,
)


def test_principal_frames(rng: np.random.Generator) -> None:
    groups = (
        rng.normal(0, [1e-3, 2e-3, 5e-2], (50, 8, 3)) @ Rotation.random(random_state=1).as_matrix()
    )
    scatters = np.concatenate(
        [np.einsum("gki,gkj->gij", groups, groups), np.zeros((1, 3, 3)), np.eye(3)[None]]
    )
    scatters = np.concatenate([scatters, np.diag([2.0, 1.0, 3.0])[None], np.ones((1, 3, 3))])
    values, vectors = principal_frames(scatters)
    np.testing.assert_allclose(values, np.linalg.eigh(scatters)[0], rtol=1e-9, atol=1e-12)
    rebuilt = np.einsum("gia,ga,gja->gij", vectors, values, vectors)
    np.testing.assert_allclose(rebuilt, scatters, atol=1e-12)
    unity = np.einsum("gia,gib->gab", vectors, vectors)
    np.testing.assert_allclose(unity, np.broadcast_to(np.eye(3), unity.shape), atol=1e-12)


def test_scatters(rng: np.random.Generator) -> None:
    points, at = rng.normal(0, 0.03, (200, 3)), rng.normal(0, 0.02, (20, 3))
    near = rng.integers(0, 200, (30, 16))
    expected = [16 * np.cov(points[group].T, bias=True) for group in near]
    np.testing.assert_allclose(scatter_of_groups(points, near), expected, atol=1e-15)
    away = np.linalg.norm(points - at[:, None], axis=2)
    expected = [np.cov(points[row < 0.035].T, bias=True) for row in away]
    np.testing.assert_allclose(scatter_within(points, at, 0.035), expected, atol=1e-15)


def test_any_inside(rng: np.random.Generator) -> None:
    points, origin = rng.normal(0, 0.05, (60, 3)), rng.normal(0, 0.05, (200, 3))
    rotation = Rotation.random(200, random_state=2).as_matrix()
    limits = np.column_stack(
        [
            rng.normal(0, 0.01, 200),
            rng.uniform(-0.01, 0.01, 200),
            np.full(200, 0.03),
            np.full(200, -0.04),
            np.full(200, 0.0),
        ]
    )
    local = np.einsum("gij,gni->gnj", rotation, points - origin[:, None])
    middle, inner, outer, back, front = limits.T[:, :, None]
    aside = np.abs(local[:, :, 1] - middle)
    inside = (np.abs(local[:, :, 0]) < 0.01) & (aside > inner) & (aside < outer)
    inside &= (local[:, :, 2] > back) & (local[:, :, 2] < front)
    expected = inside.any(axis=1)
    np.testing.assert_array_equal(any_inside(origin, rotation, 0.01, limits, points), expected)
    assert 10 < expected.sum() < 190


def bar(width: float, top: float = 0.0) -> Array:
    """Return points on the face z = `top` of a long bar, `width` along y, seen along +z."""
    x, y = np.meshgrid(np.linspace(-0.05, 0.05, 81), np.arange(-width / 2, width / 2 + 1e-9, 1e-3))
    return np.column_stack([x.ravel(), y.ravel(), np.full(x.size, top)])


def place(surface: Array, tips: list[float], tried: list[bool] | None = None):  # type: ignore[no-untyped-def]
    """Place one hand that comes along +z and closes along y at the origin."""
    return place_hands(
        surface,
        np.zeros((1, 3)),
        np.zeros(1, dtype=np.int64),
        np.eye(3)[None],
        np.array([tips]),
        np.array([tried or [True] * len(tips)]),
        REACH,
    )


def test_hands_placed_together_are_placed_as_alone(rng: np.random.Generator) -> None:
    surface, samples = bar(0.03), np.array([[0.0, 0.0, 0.0], [0.01, 0.005, 0.0]])
    about_x = np.zeros((4, 3))
    about_x[:, 0] = [0.0, 0.2, 0.2, -0.3]  # one slab
    turns = Rotation.from_rotvec(about_x)
    rotations = np.concatenate([turns.as_matrix(), Rotation.random(4, random_state=3).as_matrix()])
    of_sample = np.array([0, 0, 0, 1, 1, 1, 1, 1])
    tips, tried = np.tile([0.005, 0.02], (8, 1)), rng.random((8, 2)) < 0.6
    tried[:2], tried[4] = True, False
    together = place_hands(surface, samples, of_sample, rotations, tips, tried, REACH)
    for h in range(8):
        one = slice(h, h + 1)
        alone = place_hands(
            surface, samples, of_sample[one], rotations[one], tips[one], tried[one], REACH
        )
        for number, expected in enumerate(alone):
            np.testing.assert_array_equal(together[number][one], expected)
    assert (together.depth >= 0).any()


@pytest.mark.parametrize("width", [0.01, 0.03, 0.06])
def test_a_hand_is_placed_around_a_bar(width: float) -> None:
    found = place(bar(width), [0.005, 0.020])
    assert found.depth[0].tolist() == [1, -1]  # the deeper one holds more: it is both
    assert found.fate[0].tolist() == [GOOD, GOOD]
    assert found.front[0, 0] == 0.0
    covered = (found.left[0, 0] + found.right[0, 0] + 1) * REACH.bin_size
    assert width <= covered <= width + 2 * REACH.bin_size


def test_hands_that_do_not_fit() -> None:
    wide = place(bar(0.09), [0.005, 0.020])
    assert (wide.depth[0].tolist(), wide.fate[0].tolist()) == ([-1, -1], [TOO_WIDE] * 2)
    tall = place(np.vstack([bar(0.03), bar(0.01, top=-0.045)]), [0.005, 0.020])
    assert (tall.depth[0].tolist(), tall.fate[0].tolist()) == ([-1, -1], [COLLIDES] * 2)
    skipped = place(bar(0.03), [0.005, 0.020], [True, False])
    assert (skipped.depth[0].tolist(), skipped.fate[0].tolist()) == ([0, -1], [GOOD, UNTRIED])


def test_the_deepest_place_is_kept_beside_the_best() -> None:
    found = place(bar(0.01), [0.005, REACH.good_engagement, 0.035])
    assert found.depth[0].tolist() == [1, 2]  # 22 mm hold the part, but more may hold it better
    stepped = np.vstack([bar(0.01), bar(0.05, top=0.03)])
    found = place(stepped, [0.025, 0.038])
    assert found.depth[0].tolist() == [0, 1]
    assert found.right[0, 1] > found.right[0, 0]


def test_a_neighbour_that_leaves_no_room_for_a_finger_belongs_to_the_part() -> None:
    near = bar(0.01) + np.array([0.0, 0.02, 0.0])
    far = bar(0.01) + np.array([0.0, 0.05, 0.0])
    assert place(np.vstack([bar(0.03), near]), [0.02]).right[0, 0] == 10
    assert place(np.vstack([bar(0.03), far]), [0.02]).right[0, 0] == 6


def test_a_closer_look(rng: np.random.Generator) -> None:
    points, hands = rng.uniform(-0.03, 0.03, (500, 3)), 40
    normals, focus = rng.normal(0, 1, (500, 3)), rng.random(500) < 0.3
    origin = rng.uniform(-0.01, 0.01, (hands, 3))
    rotation = Rotation.random(hands, random_state=3).as_matrix()
    width = 0.02
    extent = np.column_stack(
        [rng.uniform(-0.02, 0.02, hands), np.full(hands, -0.012), np.full(hands, 0.009)]
    )
    extent[0, 0] = -0.2  # reaches nothing
    look = look_closer(points, normals, focus, origin, rotation, extent, width)
    local = np.einsum("gij,gni->gnj", rotation, points - origin[:, None])
    for g in range(hands):
        x, y, z = local[g].T
        tip, left, right = extent[g]
        held = (np.abs(x) < width / 2) & (z < tip) & (y > left - 0.001) & (y < right + 0.001)
        assert look.number[g] == held.sum()
        assert look.in_focus[g] == (held & focus).sum()
        if not held.any():
            assert look.left[g] == look.right[g] == look.front[g] == 0.0
            continue
        assert look.left[g] == pytest.approx(y[held].min())
        assert look.right[g] == pytest.approx(y[held].max())
        assert look.front[g] == pytest.approx(z[held].min())
        slab = (np.abs(x) < width / 2 + CONTINUES) & (z < tip + CONTINUES)
        for sign, pad in ((-1, look.left_pad), (1, look.right_pad)):
            outwards = sign * y - (sign * y[held]).max()
            contact = held & (outwards > -0.003)
            assert pad.touched[g] == contact.sum()
            assert pad.in_focus[g] == (contact & focus).sum()
            assert pad.strips[g] == len(set(np.floor((x[contact] / width + 0.5) * 4)))
            assert pad.x[g] == pytest.approx(x[contact].mean())
            np.testing.assert_allclose(pad.normal[g], normals[contact].sum(axis=0))
            np.testing.assert_allclose(pad.centre[g], points[contact].mean(axis=0))
            centred = points[contact] - points[contact].mean(axis=0)
            np.testing.assert_allclose(pad.scatter[g], centred.T @ centred, atol=1e-15)
            beyond = slab & (outwards > 0) & (outwards < CONTINUES) & (np.abs(x) < width / 2)
            assert pad.goes_on[g] == beyond.any()
            beside = slab & (np.abs(x) > width / 2) & (outwards > 0.004) & (outwards < 0.012)
            assert pad.widens[g] == (beside & (z < tip)).any()
    assert look.number[0] == 0
    assert look.left_pad.goes_on.any()
    assert look.left_pad.widens.any()


def test_warming_up_compiles_every_kernel_and_requests_none() -> None:
    """One combination of types each, or processes could overwrite each other's cache entries."""
    program = """
from services.grasp_proposal.proposer import GraspProposer
from services.grasp_proposal.settings import GraspProposalSettings
from shared.jit import types_compiled
from tests.services.grasp_proposal.scenes import box

proposer = GraspProposer(GraspProposalSettings())
proposer.warm_up()
warm = types_compiled()
print(warm)
scene = box((0.05, 0.06, 0.18), turn=0.2)
for change in ({}, {"plane": None}, {"plane": None, "up": None}, {"obstacle_points": None},
               {"gripper": "onrobot_vgc10"}):
    proposer.propose(scene.request(samples=10, **change))
print({name: count for name, count in types_compiled().items() if count != warm[name]})
"""
    run = subprocess.run(
        [sys.executable, "-c", program],
        cwd=PROJECT_ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    warm, later = map(literal_eval, run.stdout.splitlines())
    assert max(warm.values()) == 1, warm
    assert later == {}
