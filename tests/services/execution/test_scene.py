from __future__ import annotations

import numpy as np
import pytest

from services.execution.scene import Scene, scene_from_request
from shared.errors import InvalidInput
from shared.schemas.scene import SupportPlane
from tests.services.execution.scenes import (
    CAMERA_FROM_WORLD,
    STANDING_SUPERQUADRIC,
    box,
    cylinder,
    from_above,
    from_side,
    request,
)


def vertices_of(scene: Scene) -> np.ndarray:
    return np.vstack([part.vertices for part in scene.parts])


@pytest.mark.parametrize("rotation", [from_above(0.3), from_side(0.7)])
@pytest.mark.parametrize("with_plane", [True, False])
def test_the_camera_does_not_matter(rotation: np.ndarray, with_plane: bool) -> None:
    here, there = (
        scene_from_request(
            request(
                (0.01, 0.02, 0.1), rotation, cylinder(), seen_from=camera, with_plane=with_plane
            )
        )
        for camera in (None, CAMERA_FROM_WORLD)
    )
    assert here.world_from_grasp == pytest.approx(there.world_from_grasp, abs=1e-6)
    low, high = vertices_of(here).min(axis=0), vertices_of(here).max(axis=0)
    assert vertices_of(there).min(axis=0) == pytest.approx(low, abs=2e-3)
    assert vertices_of(there).max(axis=0) == pytest.approx(high, abs=2e-3)


def test_the_object_stands_on_the_table_above_the_origin() -> None:
    scene = scene_from_request(
        request((0, 0, 0.1), from_side(), cylinder(), seen_from=CAMERA_FROM_WORLD)
    )
    low, high = vertices_of(scene).min(axis=0), vertices_of(scene).max(axis=0)
    assert low[2] == pytest.approx(0.0, abs=1e-9)
    assert high[2] == pytest.approx(0.15)
    assert (low + high)[:2] == pytest.approx([0, 0], abs=1e-3)


def test_a_sideways_approach_runs_along_x() -> None:
    scene = scene_from_request(request((0, 0, 0.1), from_side(2.0), cylinder()))
    assert scene.world_from_grasp[:3, 2] == pytest.approx([1, 0, 0], abs=1e-9)


def test_an_unnormalised_plane_means_the_same() -> None:
    plane = SupportPlane(normal=(0, 0, 10), offset=0.2, inliers=3, residual_mm=1)
    scene = scene_from_request(request((0, 0, 0.1), from_above(), cylinder(), plane=plane))
    assert vertices_of(scene)[:, 2].min() == pytest.approx(0.02)
    assert scene.world_from_grasp[2, 3] == pytest.approx(0.12)


def test_what_dips_below_the_plane_is_cut_off() -> None:
    mesh = box((0.02, 0.02, 0.05), (0.0, 0.0, 0.04))
    scene = scene_from_request(request((0, 0, 0.05), from_above(), mesh, with_plane=True))
    assert vertices_of(scene)[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert vertices_of(scene)[:, 2].max() == pytest.approx(0.09)


def test_an_object_below_the_plane_is_an_error() -> None:
    mesh = box((0.02, 0.02, 0.05), (0.0, 0.0, -0.2))
    with pytest.raises(InvalidInput, match=r"plane\.normal"):
        scene_from_request(request((0, 0, 0.05), from_above(), mesh, with_plane=True))


def test_several_primitives_are_several_parts() -> None:
    upper = (0.3, 0.3, 0.01, 0.01, 0.05, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0)
    primitives = (STANDING_SUPERQUADRIC, upper)
    scene = scene_from_request(request((0, 0, 0.1), from_side(), primitives=primitives))
    assert len(scene.parts) == 2


@pytest.mark.parametrize("turn", [0.0, 1.1, np.pi])
def test_the_side_is_to_the_left_of_where_the_robot_faces(turn: float) -> None:
    """In a world whose x is the approach; the camera does not matter."""
    heading = np.array([np.cos(0.7 + turn), np.sin(0.7 + turn), -0.8])
    for camera in (np.eye(4), CAMERA_FROM_WORLD):
        faces = tuple((camera[:3, :3] @ (2 * heading)).tolist())
        asked = request((0, 0, 0.1), from_side(0.7), cylinder(), seen_from=camera, heading=faces)
        side = scene_from_request(asked).side
        assert side == pytest.approx([-np.sin(turn), np.cos(turn), 0.0], abs=1e-6)


@pytest.mark.parametrize("heading", [None, (0.0, 0.0, -3.0)])
def test_without_a_heading_the_side_is_that_of_the_approach(
    heading: tuple[float, float, float] | None,
) -> None:
    asked = request((0, 0, 0.1), from_side(0.7), cylinder(), heading=heading)
    assert scene_from_request(asked).side.tolist() == [0.0, 1.0, 0.0]
