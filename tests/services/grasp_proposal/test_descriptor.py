from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from services.grasp_proposal.closing_region import ClosingRegions, closing_regions, upright
from services.grasp_proposal.descriptor import (
    CHANNELS,
    HIDDEN_CELLS,
    PER_PROJECTION,
    SIZE,
    describe,
)
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.training.mirror import mirror_images
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace, build_workspace
from shared.geometry.rotation import matrix_from_quaternion
from shared.grippers import load_grippers
from shared.schemas.gripper import ParallelGripper
from tests.services.grasp_proposal.scenes import lying_cylinder


@pytest.fixture(scope="module")
def workspace() -> Workspace:
    return build_workspace(lying_cylinder().request())


@pytest.fixture(scope="module")
def sight(workspace: Workspace) -> SightMap:
    assert workspace.viewpoint is not None
    return SightMap.of(workspace.points, workspace.viewpoint)


def some_regions(workspace: Workspace, count: int = 12) -> ClosingRegions:
    rng = np.random.default_rng(1)
    rotation = matrix_from_quaternion(_unit_rows(rng.normal(size=(count, 4))))
    centre = workspace.points[rng.choice(len(workspace.points), count)]
    centre = centre + rng.normal(0.0, 0.005, centre.shape)
    gripper = load_grippers()["panda"]
    assert isinstance(gripper, ParallelGripper)
    hand = Hand.of(gripper, GraspProposalSettings())
    return closing_regions(hand, centre, rotation, rng.uniform(0.005, 0.06, count))


def _unit_rows(rows: np.ndarray) -> np.ndarray:
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))


def reference(workspace: Workspace, regions: ClosingRegions, sight: SightMap | None) -> np.ndarray:
    """The same images, one point and one cell at a time."""
    images = np.zeros((len(regions.centre), CHANNELS, SIZE, SIZE))
    cells = (2 * np.arange(HIDDEN_CELLS) + 1) / HIDDEN_CELLS - 1
    grid = np.stack(np.meshgrid(cells, cells, cells, indexing="ij"), -1)
    for g, (centre, rotation, half) in enumerate(zip(*regions, strict=True)):
        local = (workspace.points - centre) @ rotation / half
        inside = (np.abs(local) < 1).all(axis=1)
        local, normals = local[inside], workspace.normals[inside] @ rotation
        pixel = np.minimum(((local + 1) / 2 * SIZE).astype(int), SIZE - 1)
        hidden = np.zeros((HIDDEN_CELLS,) * 3, dtype=np.bool_)
        if sight is not None:
            places = centre + (grid * half) @ rotation.T
            hidden = (sight.depth_behind(places) > 0) & (workspace.heights(places) > 0)
        for axis in range(3):
            shown = [other for other in range(3) if other != axis]
            first = PER_PROJECTION * axis
            for row, column in np.unique(pixel[:, shown], axis=0):
                here = (pixel[:, shown] == [row, column]).all(axis=1)
                images[g, first : first + 3, row, column] = normals[here].mean(axis=0)
                images[g, first + 3, row, column] = local[here, axis].mean()
            share = hidden.mean(axis=axis)
            images[g, first + 4] = share.repeat(SIZE // HIDDEN_CELLS, 0).repeat(
                SIZE // HIDDEN_CELLS, 1
            )
    return images


def test_kernels_agree_with_numpy(workspace: Workspace, sight: SightMap) -> None:
    regions = some_regions(workspace)
    expected = reference(workspace, regions, sight)
    assert describe(workspace, regions, sight) == pytest.approx(expected, abs=1e-5)
    assert (expected[:, 4] > 0).any()
    assert (np.abs(expected[:, :4]) > 0.1).any()


def test_without_a_viewpoint_nothing_is_hidden(workspace: Workspace) -> None:
    images = describe(workspace, some_regions(workspace), None)
    assert not images[:, 4::PER_PROJECTION].any()
    assert images[:, 0].any()


@pytest.mark.parametrize("axis", [0, 1])
def test_a_mirrored_scene_gives_the_images_that_training_shows_for_it(
    workspace: Workspace, axis: int
) -> None:
    regions = some_regions(workspace, 1)
    mirror = np.eye(3) - 2 * np.outer(regions.rotation[0, :, axis], regions.rotation[0, :, axis])
    centre = regions.centre[0]
    mirrored = replace(
        workspace,
        points=(workspace.points - centre) @ mirror + centre,
        normals=workspace.normals @ mirror,
    )
    expected = mirror_images(describe(workspace, regions, None), axis)
    assert describe(mirrored, regions, None) == pytest.approx(expected, abs=1e-6)


def test_upright_hands_are_the_same_grasp_by_half_a_turn() -> None:
    rotation = matrix_from_quaternion(_unit_rows(np.random.default_rng(0).normal(size=(20, 4))))
    turned = rotation * np.array([-1.0, -1.0, 1.0])
    assert upright(turned) == pytest.approx(upright(rotation))
    assert (upright(rotation)[:, 1, 1] >= 0).all()


def test_the_pads_are_at_the_same_pixels_whatever_the_width(workspace: Workspace) -> None:
    gripper = load_grippers()["panda"]
    assert isinstance(gripper, ParallelGripper)
    hand = Hand.of(gripper, GraspProposalSettings())
    width = np.array([0.02, 0.04, 0.08])
    regions = closing_regions(hand, np.zeros((3, 3)), np.tile(np.eye(3), (3, 1, 1)), width)
    assert width / 2 / regions.half[:, 1] == pytest.approx(2 / 3)
    tips = hand.tip_beyond_tcp - regions.centre[:, 2]
    assert tips / regions.half[:, 2] == pytest.approx(0.5)
