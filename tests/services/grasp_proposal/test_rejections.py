"""Rejected hand poses: each reason occurs, and what it says is so."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from services.grasp_proposal.examples import left_out_as_alike
from services.grasp_proposal.proposer import GraspProposer
from services.grasp_proposal.settings import GraspProposalSettings
from shared.geometry.se3 import inverse, matrix_from_pose, transform_points
from shared.grippers import load_grippers
from shared.schemas.gripper import ParallelGripper, SuctionGripper
from shared.schemas.rejection import ORDER, RejectionCode
from tests.services.grasp_proposal.scenes import Scene, box, lying_cylinder, seen

Array = NDArray[np.float64]

SETTINGS = GraspProposalSettings()
PROPOSER = GraspProposer(SETTINGS)


def shipped() -> tuple[ParallelGripper, SuctionGripper]:
    grippers = load_grippers()
    hand, cup = grippers["panda"], grippers["onrobot_vgc10"]
    assert isinstance(hand, ParallelGripper)
    assert isinstance(cup, SuctionGripper)
    return hand, cup


HAND, CUP = shipped()


def sheet() -> Scene:
    """One side of something that stands upright."""
    y, z = (a.ravel() for a in np.meshgrid(np.arange(-0.05, 0.05, 0.002), np.arange(0, 0.1, 0.002)))
    points = np.column_stack([np.zeros_like(y), y, z])
    return seen(points, np.tile([-1.0, 0.0, 0.0], (len(y), 1)))


def beam_over_bar(size: tuple[float, float, float] = (0.025, 0.15, 0.02)) -> Scene:
    """A bar or slab on the table, and high above it a bar that belongs to the same thing."""
    low, high = box(size, turn=0.0), box((0.025, 0.15, 0.004), turn=0.0)
    points = np.vstack([low.points, high.points + np.array([0.0, 0.0, 0.19])])
    return Scene(points, np.vstack([low.normals, high.normals]), low.sensor, low.up)


def post_on_slab() -> Scene:
    """A slab with a post in its middle, which the palm of a cup beside it meets."""
    slab, post = box((0.12, 0.16, 0.03), turn=0.0), box((0.02, 0.02, 0.08), turn=0.0)
    points = np.vstack([slab.points, post.points + np.array([0.0, 0.0, 0.03])])
    return Scene(points, np.vstack([slab.normals, post.normals]), slab.sensor, slab.up)


SCENES: dict[str, Scene] = {
    "cylinder": lying_cylinder(),
    "bottle": box((0.05, 0.06, 0.18), turn=0.2),
    "wide": box((0.10, 0.16, 0.06)),
    "sheet": sheet(),
    "beam": beam_over_bar(),
    "post": post_on_slab(),
    "bell": beam_over_bar(size=(0.10, 0.16, 0.02)),
    "heavy": box((0.2, 0.2, 0.2), step=0.004),
}
WALL = np.array([0.05, 0.0, 0.02])
"""From a point of the object to one of an obstacle."""


@dataclass(frozen=True)
class Rejected:
    """A rejected hand pose and what it is among, in the pose's own frame."""

    code: RejectionCode
    rotation: Array
    width: float
    origin: Array
    points: Array
    obstacles: Array

    @property
    def opening(self) -> float:
        return min(self.width + 2 * SETTINGS.finger_clearance_m, HAND.max_opening)

    def fingers(self, points: Array, back: float, margin: float = 0.0015) -> bool:
        """Whether a point is in a finger that may reach back farther than it is long."""
        x, y, z = np.abs(points[:, 0]), np.abs(points[:, 1]), points[:, 2]
        tip = HAND.tip_beyond_tcp
        inside = (x < HAND.finger_width / 2 + margin) & (y > self.opening / 2 - margin)
        inside &= y < self.opening / 2 + HAND.finger_thickness + margin
        return bool((inside & (z < tip + margin) & (z > tip - HAND.finger_length - back)).any())

    def palm(self, points: Array, back: float, margin: float = 0.0015) -> bool:
        aside = np.abs(points[:, :2]) < np.array(HAND.palm_size[:2]) / 2 + margin
        front = HAND.tip_beyond_tcp - HAND.finger_length
        before = points[:, 2] < front + SETTINGS.palm_clearance_m + margin
        behind = points[:, 2] > front - HAND.palm_size[2] - back
        return bool((aside.all(axis=1) & before & behind).any())

    def between(self, points: Array, margin: float = 0.0) -> Array:
        """Return the points between the pads."""
        x, y, z = np.abs(points[:, 0]), np.abs(points[:, 1]), points[:, 2]
        inside = (x < HAND.finger_width / 2) & (y < self.opening / 2 + margin)
        return points[inside & (z < HAND.tip_beyond_tcp)]

    def lowest(self) -> tuple[float, float]:
        """Return the least heights of finger tips and palm, there and at the pregrasp."""
        tip = HAND.tip_beyond_tcp
        root = tip - HAND.finger_length
        away = SETTINGS.pregrasp_distance_m
        signs = np.array(np.meshgrid([-1, 1], [-1, 1])).reshape(2, -1).T
        side = self.opening / 2 + HAND.finger_thickness
        fingers = [(signs * [HAND.finger_width / 2, side], z) for z in (tip, root - away)]
        half = np.array(HAND.palm_size[:2]) / 2
        palm = [(signs * half, z) for z in (root, root - HAND.palm_size[2] - away)]
        return tuple(  # type: ignore[return-value]
            min(
                float((np.column_stack([xy, np.full(4, z)]) @ self.rotation[2]).min())
                for xy, z in of
            )
            + float(self.origin[2])
            for of in (fingers, palm)
        )


@cache
def rejected(scene: str, gripper: str = "panda", **changes: bool) -> tuple[Rejected, ...]:
    held = SCENES[scene]
    obstacles = held.points + WALL if changes.get("walled") else np.empty((0, 3))
    answer = PROPOSER.propose(
        held.request(rejected=200, gripper=gripper, obstacle_points=obstacles, seed=4)
    )
    assert answer.rejected_poses is not None
    found = []
    for row, code in zip(answer.rejected_poses, answer.rejected_reasons, strict=True):
        pose = matrix_from_pose(row[:3], row[3:7])
        local = (transform_points(inverse(pose), each) for each in (held.points, obstacles))
        found.append(Rejected(code, pose[:3, :3], float(row[7]), row[:3], *local))
    return tuple(found)


def those(code: str, *scene: str, **changes: bool) -> list[Rejected]:
    found = [each for each in rejected(*scene, **changes) if each.code == code]
    assert found, f"no {code} in {scene}"
    return found


def test_too_wide_leaves_no_room_for_the_fingers() -> None:
    """Wherever the open hand is shifted to around its point, a finger meets the object."""
    room = HAND.finger_thickness + SETTINGS.finger_clearance_m + 0.006
    for each in those("too_wide", "wide"):
        if each.width > HAND.max_opening - SETTINGS.finger_clearance_m and each.width != (
            pytest.approx(HAND.max_opening)
        ):
            continue  # measured between its edges
        near = each.points[np.abs(each.points[:, 0]) < HAND.finger_width / 2 + 0.0015]
        near = near[near[:, 2] < HAND.tip_beyond_tcp + 0.001]
        inner = HAND.max_opening - SETTINGS.finger_clearance_m
        for shift in np.linspace(0, inner, 15):
            left, right = -shift, inner - shift
            hit = (near[:, 1] > left - room) & (near[:, 1] < left)
            hit |= (near[:, 1] > right) & (near[:, 1] < right + room)
            assert hit.any()


def test_a_finger_or_the_palm_is_in_the_object() -> None:
    for scene in ("wide", "bottle"):
        for each in those("finger_collides_object", scene):
            assert each.fingers(each.points, back=0.0)
        for each in those("palm_collides_object", scene):
            assert each.palm(each.points, back=0.0)


def test_the_sweep_hits_what_the_hand_at_its_place_does_not() -> None:
    away = SETTINGS.pregrasp_distance_m
    for each in those("sweep_collides", "beam"):
        assert not each.fingers(each.points, back=0.0, margin=0.0)
        assert not each.palm(each.points, back=0.0, margin=-0.005)
        assert each.fingers(each.points, back=away) or each.palm(each.points, back=away)


def test_an_obstacle_is_met_and_the_object_is_not() -> None:
    away = SETTINGS.pregrasp_distance_m
    for each in those("obstacle", "cylinder", walled=True):
        met = each.fingers(each.obstacles, away) or each.palm(each.obstacles, away)
        assert met or len(each.between(each.obstacles))
        assert not each.fingers(each.points, away, margin=-0.001)


@pytest.mark.parametrize("scene", ["cylinder", "bottle"])
def test_the_support_plane_is_near(scene: str) -> None:
    for each in those("support_plane", scene):
        fingers, palm = (height - 1e-6 for height in each.lowest())
        assert fingers < SETTINGS.support_clearance_m or palm < SETTINGS.palm_clearance_m
    for each in those("from_below", scene):
        assert each.rotation[2, 2] > 0.29


def test_no_contact_is_one_side_of_something() -> None:
    for each in those("no_contact", "sheet"):
        held = each.between(each.points)
        assert len(held) < 3 or np.ptp(held[:, 1]) < 0.0005


def test_not_antipodal_closes_on_slopes() -> None:
    """On the cylinder a pad's surface is turned away from the closing direction."""
    scene = SCENES["cylinder"]
    for each in those("not_antipodal", "cylinder"):
        y = each.points[:, 1]
        within = np.abs(each.points[:, 0]) < HAND.finger_width / 2
        within &= (each.points[:, 2] < HAND.tip_beyond_tcp) & (np.abs(y) < each.width / 2 + 0.001)
        faces = scene.normals[within] @ each.rotation[:, 1]
        edges = y[within]
        ends = (
            faces[edges < edges.min() + 0.003].mean(),
            faces[edges > edges.max() - 0.003].mean(),
        )
        assert min(-ends[0], ends[1]) < 0.8


@pytest.mark.parametrize(
    ("code", "scene", "walled"),
    [
        ("no_seal", "cylinder", False),
        ("cup_collides_object", "post", False),
        ("support_plane", "bottle", False),
        ("too_heavy", "heavy", False),
        ("obstacle", "wide", True),
        ("better_grasp_nearby", "wide", False),
        ("sweep_collides", "bell", False),
    ],
)
def test_a_cup_says_why_too(code: str, scene: str, walled: bool) -> None:
    found = [each for each in rejected(scene, "onrobot_vgc10", walled=walled) if each.code == code]
    assert found
    assert {each.width for each in found} == {0.0}
    check: dict[str, Callable[[Rejected], bool]] = {
        "no_seal": lambda each: rim_is_off(each.points),
        "cup_collides_object": lambda each: cup_meets(each.points, 0.0),
        "sweep_collides": lambda each: (
            cup_meets(each.points, SETTINGS.pregrasp_distance_m) and not cup_meets(each.points, 0.0)
        ),
        "obstacle": lambda each: cup_meets(each.obstacles, SETTINGS.pregrasp_distance_m),
        "support_plane": lambda each: cup_lowest(each) < SETTINGS.support_clearance_m,
    }
    if code in check:
        assert all(map(check[code], found))


def rim_is_off(points: Array) -> bool:
    """Whether the surface under the lip departs from the cup's plane, or is missing."""
    radius = CUP.cup_diameter / 2
    ring = np.abs(np.hypot(points[:, 0], points[:, 1]) - radius) < 0.004
    ring &= np.abs(points[:, 2]) < CUP.compliance
    sectors = np.floor(np.arctan2(points[ring, 1], points[ring, 0]) / (np.pi / 6)).astype(int)
    off = np.abs(np.hypot(points[:, 0], points[:, 1])) < radius + 0.004
    return len(set(sectors.tolist())) < 12 or bool((np.abs(points[off, 2]) > 0.0005).any())


def cup_meets(points: Array, back: float) -> bool:
    x, y, z = np.abs(points[:, 0]), np.abs(points[:, 1]), points[:, 2]
    radius, root = CUP.cup_diameter / 2, -CUP.cup_length
    cup = (x < radius) & (y < radius) & (z > root - back) & (z < 0.0)
    palm = (x < CUP.palm_size[0] / 2) & (y < CUP.palm_size[1] / 2)
    palm &= (z < root + SETTINGS.palm_clearance_m) & (z > root - CUP.palm_size[2] - back)
    above = z < -2 * CUP.compliance
    return bool(((cup & above) | palm).any())


def cup_lowest(each: Rejected) -> float:
    signs = np.array(np.meshgrid([-1, 1], [-1, 1])).reshape(2, -1).T
    half = np.array(CUP.palm_size[:2]) / 2
    ends = (-CUP.cup_length, -CUP.cup_length - CUP.palm_size[2] - SETTINGS.pregrasp_distance_m)
    corners = [np.column_stack([signs * half, np.full(4, z)]) for z in ends]
    rim = signs * CUP.cup_diameter / 2
    low = np.vstack([*corners, np.column_stack([rim, np.zeros(4)])]) @ each.rotation[2]
    return float(low.min() + each.origin[2])


def test_every_reason_that_is_counted_has_examples_and_no_other() -> None:
    counted = {
        "collision_support": {"from_below", "support_plane"},
        "collision_object": {
            *("finger_collides_object", "palm_collides_object"),
            *("cup_collides_object", "sweep_collides"),
        },
        "collision_obstacle": {"obstacle"},
        "less_promising": {"less_promising", "better_grasp_nearby"},
        "duplicate": {"less_promising", "better_grasp_nearby"},
    }
    for gripper in ("panda", "onrobot_vgc10"):
        for scene in SCENES.values():
            answer = PROPOSER.propose(scene.request(rejected=200, gripper=gripper))
            said = set(answer.rejected_reasons)
            known = [counted.get(reason, {reason}) for reason in answer.rejected]
            assert all(said & codes for codes in known)
            assert said <= set().union(*known)


def test_examples_change_nothing_else_and_are_there_only_where_asked_for() -> None:
    for gripper in ("panda", "onrobot_vgc10"):
        scene = SCENES["wide"]
        alone = PROPOSER.propose(scene.request(gripper=gripper))
        beside = PROPOSER.propose(scene.request(gripper=gripper, rejected=30))
        assert len(beside.rejected_reasons) == 30
        fields = beside.model_dump_json(exclude={"rejected_poses", "rejected_reasons"})
        assert alone.model_dump_json() == fields


def test_examples_are_spread_and_follow_the_seed() -> None:
    scene = SCENES["bottle"]
    one, again, other = (
        PROPOSER.propose(scene.request(rejected=40, seed=seed)) for seed in (0, 0, 1)
    )
    assert one == again
    assert one.rejected_poses is not None
    assert other.rejected_poses is not None
    assert not np.array_equal(one.rejected_poses, other.rejected_poses)
    numbers = [one.rejected_reasons.count(code) for code in set(one.rejected_reasons)]
    assert max(numbers) - min(numbers) <= 1
    places = [ORDER[code] for code in one.rejected_reasons]
    assert places == sorted(places)
    assert np.linalg.norm(one.rejected_poses[:, 3:7], axis=1) == pytest.approx(1.0)


def test_alike_and_beyond_the_limit_are_told_apart() -> None:
    order = np.array([5, 3, 1, 0, 2, 4])
    (alike, first), (less, second) = left_out_as_alike(order, np.array([0, 2]), 2)
    assert (alike, first.tolist()) == ("better_grasp_nearby", [3])
    assert (less, second.tolist()) == ("less_promising", [0, 2, 4])
    (_, first), (_, second) = left_out_as_alike(order, np.array([0, 2]), 3)
    assert (first.tolist(), second.tolist()) == ([3, 0, 2, 4], [])
