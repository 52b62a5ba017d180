from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.execution.convex import ConvexPart
from services.execution.decomposition import MAX_PARTS, parts_of_mesh, parts_of_primitives
from services.execution.pieces import clip
from shared.errors import DegenerateCloud
from shared.geometry.se3 import transform_points
from shared.superquadric import Superquadric, volume
from tests.services.execution.scenes import (
    CAMERA_FROM_WORLD,
    STANDING_SUPERQUADRIC,
    Mesh,
    box,
    cylinder,
)

Array = np.ndarray


def ring(inner: float = 0.03, outer: float = 0.05, height: float = 0.02) -> Mesh:
    """A closed mesh of a tube: the simplest object with a hole through it."""
    turn = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    corners = [(outer, 0.0), (outer, height), (inner, height), (inner, 0.0)]
    vertices = np.vstack([np.column_stack([circle * r, np.full(24, z)]) for r, z in corners])
    faces = []
    for side in range(4):
        for k in range(24):
            a, b = 24 * side + k, 24 * side + (k + 1) % 24
            c, d = 24 * ((side + 1) % 4) + k, 24 * ((side + 1) % 4) + (k + 1) % 24
            faces += [(a, b, d), (a, d, c)]
    return vertices, np.array(faces, dtype=np.int32)


def bowl(radius: float = 0.07, wall: float = 0.004) -> Mesh:
    """A closed mesh of a hemispherical bowl, its opening up."""
    turn = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    rise = np.radians(np.linspace(-89.9, 0, 12))
    profile = [(r * np.cos(up), r * np.sin(up)) for r in (radius, radius - wall) for up in rise]
    profile[12:] = profile[:11:-1]  # up outside, down inside
    vertices = np.vstack(
        [np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(48, z)]) for r, z in profile]
    )
    faces = []
    for level in range(len(profile) - 1):
        for k in range(48):
            a, b = 48 * level + k, 48 * level + (k + 1) % 48
            faces += [(a, b, b + 48), (a, b + 48, a + 48)]
    return vertices, np.array(faces, dtype=np.int32)


def total_volume(parts: list[ConvexPart]) -> float:
    return sum(part.moments()[0] for part in parts)


def covers(parts: list[ConvexPart], point: Array) -> bool:
    return any((normals @ point <= offsets).all() for normals, offsets in (p.planes for p in parts))


def test_a_convex_mesh_stays_whole() -> None:
    for mesh in (box((0.02, 0.03, 0.04), (0, 0, 0.04)), cylinder()):
        parts = parts_of_mesh(*mesh)
        assert len(parts) == 1
        assert np.allclose(np.ptp(parts[0].vertices, axis=0), np.ptp(mesh[0], axis=0))


def test_a_hole_stays_open() -> None:
    vertices, faces = ring()
    parts = parts_of_mesh(vertices, faces)
    enclosed = float(np.linalg.det(vertices[faces]).sum() / 6)
    assert 1 < len(parts) <= MAX_PARTS
    assert total_volume(parts) == pytest.approx(enclosed, rel=0.1)
    assert not covers(parts, np.array([0.0, 0.0, 0.01]))
    assert not covers(parts, np.array([0.02, 0.0, 0.01]))
    assert covers(parts, np.array([0.04, 0.0, 0.01]))


def test_a_bowl_keeps_its_wall_and_is_hollow() -> None:
    vertices, faces = bowl()
    parts = parts_of_mesh(vertices, faces)
    enclosed = 2 / 3 * np.pi * (0.07**3 - 0.066**3)
    full = 2 / 3 * np.pi * 0.07**3
    assert len(parts) <= MAX_PARTS
    assert enclosed < total_volume(parts) < 1.6 * enclosed < 0.3 * full
    for turn in np.radians([10, 130, 250]):
        across, up = np.array([np.cos(turn), np.sin(turn), 0]), np.array([0, 0, -0.005])
        assert covers(parts, 0.068 * across + up)  # within the wall, below the rim
        assert not covers(parts, 0.055 * across + up)
        assert not covers(parts, 0.03 * across + 3 * up)


def test_no_part_of_a_solid_is_lost_where_cuts_cross() -> None:
    vertices, faces = ring(inner=0.02)
    parts = parts_of_mesh(vertices, faces)
    rng = np.random.default_rng(3)
    turn, radius, height = rng.uniform((0, 0.021, 0), (2 * np.pi, 0.049, 0.02), (400, 3)).T
    inside = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])
    assert all(covers(parts, point) for point in inside)


def test_the_frame_and_the_side_of_the_faces_do_not_matter() -> None:
    vertices, faces = ring()
    expected = total_volume(parts_of_mesh(vertices, faces))
    elsewhere = parts_of_mesh(transform_points(CAMERA_FROM_WORLD, vertices), faces)
    inside_out = parts_of_mesh(vertices, faces[:, ::-1].copy())
    assert total_volume(elsewhere) == pytest.approx(expected, rel=0.05)
    assert total_volume(inside_out) == pytest.approx(expected, rel=0.05)


def test_an_open_mesh_is_accepted() -> None:
    vertices, faces = cylinder()
    side = np.ptp(vertices[faces][:, :, 2], axis=1) > 0
    assert total_volume(parts_of_mesh(vertices, faces[side])) == pytest.approx(4.2e-4, rel=0.05)


@pytest.mark.parametrize(
    "vertices",
    [np.random.default_rng(1).normal(size=(9, 3)) * [0.1, 0.1, 0.0], np.ones((9, 3))],
)
def test_a_flat_mesh_is_an_error(vertices: Array) -> None:
    with pytest.raises(DegenerateCloud, match="no volume"):
        parts_of_mesh(vertices, np.arange(9, dtype=np.int32).reshape(3, 3))


def test_any_triangle_soup_ends() -> None:
    rng = np.random.default_rng(2)
    vertices = rng.normal(scale=0.1, size=(200, 3))
    faces = rng.integers(0, 200, size=(300, 3)).astype(np.int32)
    assert 1 <= len(parts_of_mesh(vertices, faces)) <= MAX_PARTS
    degenerate = np.repeat(np.arange(200, dtype=np.int32)[:, None], 3, axis=1)
    assert len(parts_of_mesh(vertices, degenerate)) == 1


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), offset=st.floats(-0.1, 0.1))
def test_clipping_divides_the_area(seed: int, offset: float) -> None:
    rng = np.random.default_rng(seed)
    triangles = rng.normal(scale=0.1, size=(40, 3, 3))
    normal = np.array([0.0, 0.6, 0.8])
    upper, lower = clip(triangles, normal, offset), clip(triangles, -normal, -offset)
    assert (upper @ normal >= offset - 1e-12).all()
    assert (lower @ normal <= offset + 1e-12).all()
    assert area(upper) + area(lower) == pytest.approx(area(triangles))


def area(triangles: Array) -> float:
    edges = triangles[:, 1:] - triangles[:, :1]
    return float(np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum() / 2)


def test_a_superquadric_becomes_a_part_of_its_volume() -> None:
    (part,) = parts_of_primitives([STANDING_SUPERQUADRIC])
    exact = volume(Superquadric.from_vector(STANDING_SUPERQUADRIC))
    assert part.moments()[0] == pytest.approx(exact, rel=0.05)
