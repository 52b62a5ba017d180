from __future__ import annotations

import numpy as np

from services.grasp_proposal.surface import estimate_normals, local_frames
from services.grasp_proposal.thinning import thin
from tests.services.grasp_proposal.scenes import about_z, box, lying_cylinder


def test_normals_follow_the_surface_and_face_the_sensor() -> None:
    scene = lying_cylinder()
    normals = estimate_normals(scene.points, scene.points, scene.sensor)
    cosines = (normals * scene.normals).sum(axis=1)
    assert np.median(cosines) > 0.995
    assert cosines.min() > 0.7
    assert (((scene.sensor - scene.points) * normals).sum(axis=1) >= 0).all()


def test_without_a_viewpoint_normals_point_away_from_the_centroid() -> None:
    directions = np.random.default_rng(0).normal(size=(2000, 3))
    ball = 0.05 * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    normals = estimate_normals(ball, ball, None)
    assert ((normals * ball).sum(axis=1) > 0.04).all()


def test_the_curvature_axis_of_a_cylinder_is_its_axis() -> None:
    scene = lying_cylinder(turn=0.5)
    inner = np.linalg.norm(scene.points[:, :2], axis=1) < 0.05
    surface = thin(scene.points, (0.003,), 0)
    frames = local_frames(
        scene.points[inner][::50],
        scene.normals[inner][::50],
        scene.points[surface],
        scene.normals[surface],
    )
    axis = about_z(0.5)[:, 1]
    assert np.abs(frames.curvature_axes @ axis).min() > 0.95
    assert np.abs(frames.part_axes @ axis).min() > 0.95


def test_on_a_flat_bar_the_hand_straddles_the_long_axis() -> None:
    scene = box((0.02, 0.15, 0.01), turn=0.3)
    top = (scene.normals[:, 2] > 0.9) & (np.linalg.norm(scene.points[:, :2], axis=1) < 0.04)
    frames = local_frames(
        scene.points[top][::20], scene.normals[top][::20], scene.points, scene.normals
    )
    assert np.abs(frames.part_axes @ about_z(0.3)[:, 1]).min() > 0.95
    assert np.abs((frames.curvature_axes * frames.normals).sum(axis=1)).max() < 1e-6
