"""Which parts objects fall into, and the laws that hold for any of them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from experiments.camera import StereoNoise
from services.primitive_recovery.parts.cutter import Cutter
from services.primitive_recovery.parts.segment import segment
from shared.schemas.scene import SupportPlane
from tests.services.primitive_recovery.parts.views import Seen, overlap, seen

Array = NDArray[np.float64]
ORIGIN = np.zeros(3)
TWO_PARTS = ("pan", "ladle", "hammer", "spatula", "bottle", "knife", "scissors", "spoon")
ONE_PART = ("box", "can", "bowl")


@pytest.fixture(scope="module")
def cutter() -> Cutter:
    return Cutter.load()


def plane_of(normal: Array, offset: float) -> SupportPlane:
    x, y, z = normal.tolist()
    return SupportPlane(normal=(x, y, z), offset=offset, inliers=1000, residual_mm=1.0)


def alike(one: NDArray[np.int16], other: NDArray[np.int16]) -> float:
    """Return the share of points in the same part; parts of equal size may swap numbers."""
    if one.max() != other.max():
        return 0.0
    parts = range(int(one.max()) + 1)
    return sum(max(float(((one == p) & (other == q)).mean()) for q in parts) for p in parts)


@pytest.mark.parametrize("noise", [None, StereoNoise()])
@pytest.mark.parametrize("class_name", TWO_PARTS)
def test_parts_are_the_regions(class_name: str, noise: StereoNoise | None, cutter: Cutter) -> None:
    good = 0
    for number in range(2001, 2005):
        view = seen(class_name, number, noise)
        labels = segment(view.points, ORIGIN, view.plane, cutter).labels
        good += min(overlap(labels, view.region == task) for task in (0, 1)) >= 0.7
    assert good >= 3


@pytest.mark.parametrize("class_name", ONE_PART)
def test_convex_objects_stay_whole(class_name: str, cutter: Cutter) -> None:
    whole = 0
    for number in range(2001, 2005):
        view = seen(class_name, number)
        whole += segment(view.points, ORIGIN, view.plane, cutter).labels.max() == 0
    assert whole >= 3


def test_scissors_have_two_rings(cutter: Cutter) -> None:
    holes = []
    for number in range(2001, 2008):
        view = seen("scissors", number)
        found = segment(view.points, ORIGIN, view.plane, cutter)
        of_region = [found.labels[view.region == region] for region in (0, 1)]
        handles, blades = (int(np.argmax(np.bincount(each))) for each in of_region)
        holes.append((found.holes[handles], found.holes[blades]))
    assert holes.count((2, 0)) >= 5


def test_a_joint_lies_on_the_border(cutter: Cutter) -> None:
    view = seen("hammer", 2001)
    found = segment(view.points, ORIGIN, view.plane, cutter)
    (joint,) = found.joints
    assert joint.parts == (0, 1)
    for part in joint.parts:
        own = view.points[found.labels == part]
        assert np.linalg.norm(own - joint.position, axis=1).min() < 0.015


@pytest.mark.parametrize("class_name", [*TWO_PARTS, "mug", "screwdriver", "box"])
def test_a_rigid_motion_of_everything_changes_nothing(
    class_name: str, cutter: Cutter, rng: np.random.Generator
) -> None:
    view = seen(class_name, 2002)
    before = segment(view.points, ORIGIN, view.plane, cutter)
    turn = Rotation.random(random_state=7).as_matrix()
    shift = rng.normal(size=3)
    normal = turn @ np.array(view.plane.normal)
    plane = plane_of(normal, view.plane.offset - float(normal @ shift))
    after = segment(view.points @ turn.T + shift, shift, plane, cutter)
    assert alike(before.labels, after.labels) > 0.995
    assert before.holes == after.holes
    for one, other in zip(before.joints, after.joints, strict=True):
        np.testing.assert_allclose(turn @ one.position + shift, other.position, atol=2e-3)


@pytest.mark.parametrize("class_name", TWO_PARTS)
def test_the_order_of_the_points_does_not_matter(
    class_name: str, cutter: Cutter, rng: np.random.Generator
) -> None:
    view = seen(class_name, 2003)
    order = rng.permutation(len(view.points))
    before = segment(view.points, ORIGIN, view.plane, cutter).labels
    after = segment(view.points[order], ORIGIN, view.plane, cutter).labels
    assert alike(before[order], after) > 0.995


@pytest.mark.parametrize("scale", [0.01, 0.5, 2.0, 1000.0])
@pytest.mark.parametrize("class_name", ["hammer", "mug", "bottle", "box"])
def test_the_unit_of_length_does_not_matter(class_name: str, scale: float, cutter: Cutter) -> None:
    view = seen(class_name, 2004)
    plane = plane_of(np.array(view.plane.normal), scale * view.plane.offset)
    before = segment(view.points, ORIGIN, view.plane, cutter).labels
    after = segment(scale * view.points, ORIGIN, plane, cutter).labels
    assert alike(before, after) > 0.995


@pytest.mark.parametrize("class_name", TWO_PARTS)
def test_doubling_the_density_changes_little(
    class_name: str, cutter: Cutter, rng: np.random.Generator
) -> None:
    view = seen(class_name, 2005)
    # along the rays' tangents: between each point and the next pixel's
    nearer = view.points * (1 + rng.normal(0, 1e-4, (len(view.points), 1)))
    jitter = rng.uniform(-4e-4, 4e-4, (len(view.points), 3))
    twice = np.vstack([view.points, nearer + jitter])
    before = segment(view.points, ORIGIN, view.plane, cutter).labels
    after = segment(twice, ORIGIN, view.plane, cutter).labels[: len(before)]
    assert alike(before, after) > 0.93


@pytest.mark.parametrize("sigma", [0.0, 0.002, 0.01, 0.05, 0.5])
def test_more_noise_never_crashes(sigma: float, cutter: Cutter, rng: np.random.Generator) -> None:
    view = seen("hammer", 2001)
    noisy = view.points + rng.normal(0, sigma, view.points.shape)
    for plane in (view.plane, None):
        found = segment(noisy, ORIGIN, plane, cutter)
        assert len(found.holes) == found.labels.max() + 1 <= 6
        assert found.labels.min() == 0


def test_the_same_input_gives_the_same_bytes(cutter: Cutter) -> None:
    view = seen("mug", 2001)
    one, other = (segment(view.points, ORIGIN, view.plane, cutter) for _ in range(2))
    assert one.labels.tobytes() == other.labels.tobytes()
    assert [j.position.tobytes() for j in one.joints] == [
        j.position.tobytes() for j in other.joints
    ]


def cloud_of_both_sides(view: Seen) -> Array:
    return np.vstack([view.points, 2 * view.points.mean(axis=0) - view.points])


@pytest.mark.parametrize("viewpoint", ["origin", "inside", "on a point", "far"])
def test_clouds_without_a_sensible_viewpoint(viewpoint: str, cutter: Cutter) -> None:
    view = seen("hammer", 2001)
    cloud = cloud_of_both_sides(view)
    eye = {
        "origin": ORIGIN,
        "inside": cloud.mean(axis=0),
        "on a point": cloud[0],
        "far": np.array([0.0, 0.0, -1e6]),
    }[viewpoint]
    found = segment(cloud, eye, None, cutter)
    assert found.labels.shape == (len(cloud),)
    assert np.isfinite([joint.position for joint in found.joints]).all()


@pytest.mark.parametrize("number", [11, 30, 59, 60, 61])
def test_few_points_are_one_part(number: int, cutter: Cutter, rng: np.random.Generator) -> None:
    found = segment(rng.normal(size=(number, 3)), np.array([0, 0, -9.0]), None, cutter)
    assert found.labels.shape == (number,)
    if number < 60:
        assert found.labels.max() == 0


def test_flat_and_straight_clouds_are_taken(cutter: Cutter, rng: np.random.Generator) -> None:
    for flat in ((1, 1, 0), (1, 0, 0), (1, 1e-9, 1e-9)):
        cloud = rng.uniform(-0.1, 0.1, (500, 3)) * np.array(flat, dtype=np.float64)
        assert segment(cloud, np.array([0.0, 0.0, 1.0]), None, cutter).labels.shape == (500,)
