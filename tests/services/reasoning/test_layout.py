"""How parts lie to each other: measured, and the same wherever the object is."""

from __future__ import annotations

import numpy as np
import pytest

from services.reasoning.layout import Layout, layout_of
from shared.geometry.rotation import matrix_from_quaternion, quaternion_from_matrix
from shared.schemas.primitive import Primitive
from shared.schemas.scene import SupportPlane
from shared.superquadric import Superquadric, surface_mesh
from tests.services.reasoning.objects import BOTTLE, HAMMER, KNIFE, LADLE, MUG, PAN, part


def lie(primitives: tuple[Primitive, ...], plane: SupportPlane | None = None) -> Layout:
    return layout_of(primitives, (), plane)


def moved(primitive: Primitive, rotation: np.ndarray, shift: np.ndarray) -> Primitive:
    shape = primitive.superquadric
    vector = shape.to_vector()
    vector[5:8] = rotation @ vector[5:8] + shift
    vector[8:] = quaternion_from_matrix(rotation @ shape.rotation)
    return primitive.model_copy(update={"parameters": tuple(vector.tolist())})


def turned(primitive: Primitive, axis: int, degrees: float) -> Primitive:
    """Return a part turned about its own centre, about x, y or z."""
    quaternion = np.zeros(4)
    quaternion[axis], quaternion[3] = (
        np.sin(np.radians(degrees) / 2),
        np.cos(np.radians(degrees) / 2),
    )
    rotation = matrix_from_quaternion(quaternion)
    centre = np.array(primitive.superquadric.position)
    return moved(primitive, rotation, centre - rotation @ centre)


def test_the_handle_shows_which_way_the_pan_lies() -> None:
    pan = lie(PAN)
    np.testing.assert_allclose(np.abs(pan.axes[:, 0]), [1, 0, 0], atol=1e-9)
    assert pan.extents[1, 0] == pytest.approx(0.2)
    assert pan.extents[1, 1:].max() == pytest.approx(0.03)
    assert np.ptp(pan.intervals) == pytest.approx(0.38)


def test_a_hammer_head_lies_across() -> None:
    hammer = lie(HAMMER)
    assert hammer.slants == pytest.approx([0, 90], abs=1e-6)
    assert hammer.extents[1, 0] == pytest.approx(0.03)
    assert hammer.extents[1, 1:].max() == pytest.approx(0.1)


def test_a_slightly_turned_handle_keeps_its_elongation() -> None:
    straight, leaning = lie(HAMMER).extents, lie((turned(HAMMER[0], 1, 10), HAMMER[1])).extents
    assert leaning[0, 0] / leaning[0, 1:].max() > 0.7 * straight[0, 0] / straight[0, 1:].max()


def test_a_leaning_sheet_does_not_shrink() -> None:
    blade = part(0, (0.002, 0.08, 0.1), "cuboid")
    handle = part(1, (0.02, 0.02, 0.3), position=(0.0, 0.0, 1.0))
    assert lie((turned(blade, 2, 30), handle)).extents[0, 1:].max() > 0.06


def test_reach_and_offset() -> None:
    bottle, mug = lie(BOTTLE), lie(MUG)
    assert bottle.reaches[1, 0] == pytest.approx(0.03)
    assert bottle.offsets[1, 0] == pytest.approx(1.15)
    assert mug.offsets[1, 0] == pytest.approx(0.0, abs=1e-9)
    assert 0.02 < mug.reaches[1, 0] < 0.04


def test_heights() -> None:
    table = SupportPlane(normal=(0.0, 0.0, 1.0), offset=-0.7, inliers=1000, residual_mm=1.0)
    heights = lie(BOTTLE, table).heights
    assert heights is not None
    np.testing.assert_allclose(heights, [[0.0, 0.2], [0.2, 0.23]], atol=1e-9)
    assert lie(BOTTLE).heights is None


def test_one_part() -> None:
    alone = lie((part(7, (0.05, 0.1, 0.2)),))
    assert alone.extents[0] == pytest.approx([0.2, 0.1, 0.05], abs=1e-9)
    assert alone.meeting == ()


@pytest.mark.parametrize("primitives", [PAN, HAMMER, BOTTLE, LADLE, KNIFE, MUG])
def test_a_rigid_motion_changes_nothing(primitives: tuple[Primitive, ...]) -> None:
    rng = np.random.default_rng(5)
    before = lie(primitives)
    for _ in range(5):
        quaternion = rng.standard_normal(4)
        rotation = matrix_from_quaternion(quaternion / np.linalg.norm(quaternion))
        shift = rng.uniform(-1, 1, 3)
        after = lie(tuple(moved(each, rotation, shift) for each in primitives))
        np.testing.assert_allclose(after.extents[:, 0], before.extents[:, 0], rtol=1e-6)
        np.testing.assert_allclose(
            after.extents[:, 1:].max(axis=1), before.extents[:, 1:].max(axis=1), rtol=1e-6
        )
        np.testing.assert_allclose(after.slants, before.slants, atol=1e-4)
        np.testing.assert_allclose(after.reaches, before.reaches, atol=1e-9)
        np.testing.assert_allclose(after.offsets, before.offsets, atol=1e-9)
        assert after.meeting == before.meeting


def test_scale_scales_lengths_alone() -> None:
    twice = []
    for each in PAN:
        vector = each.superquadric.to_vector()
        vector[2:8] *= 2
        extents = np.multiply(each.full_extents, 2).tolist()
        update = {"parameters": tuple(vector.tolist()), "full_extents": tuple(extents)}
        twice.append(each.model_copy(update=update))
    small, large = lie(PAN), lie(tuple(twice))
    np.testing.assert_allclose(large.extents, 2 * small.extents, rtol=1e-9)
    np.testing.assert_allclose(large.slants, small.slants, atol=1e-6)
    np.testing.assert_allclose(large.offsets, small.offsets, atol=1e-12)


@pytest.mark.parametrize("exponents", [(0.1, 0.1), (0.1, 1.0), (1.0, 1.0), (0.7, 1.6), (2.0, 2.0)])
def test_heights_are_those_of_the_surface(exponents: tuple[float, float]) -> None:
    """The support function in closed form against a fine mesh, from box to octahedron."""
    rng = np.random.default_rng(3)
    quaternion, normal = rng.standard_normal(4), rng.standard_normal(3)
    shape = Superquadric.from_vector(
        [*exponents, 0.05, 0.08, 0.1, 0, 0, 0, *(quaternion / np.linalg.norm(quaternion))]
    )
    primitive = part(0, shape.full_extents).model_copy(
        update={"parameters": tuple(shape.to_vector().tolist())}
    )
    normal /= np.linalg.norm(normal)
    x, y, z = normal.tolist()
    plane = SupportPlane(normal=(x, y, z), offset=0.0, inliers=9, residual_mm=1.0)
    heights = lie((primitive,), plane).heights
    assert heights is not None
    vertices, _ = surface_mesh(shape, 300, 600)
    assert (vertices @ normal).max() == pytest.approx(heights[0, 1], rel=0.01)
    assert (vertices @ normal).min() == pytest.approx(heights[0, 0], rel=0.01)
