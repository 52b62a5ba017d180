"""Disturbances, as laws on views; and a slice of the experiment."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from experiments.catalogue import build, variant
from experiments.framework import Share, ViewSet
from experiments.framework.views import ShownView, load
from experiments.robustness.disturbances import (
    AS_IT_IS,
    CONDITIONS,
    OCCLUDED,
    OTHER_SIZE,
    occluded,
    with_half_the_points,
    with_noise,
)
from experiments.robustness.experiment import run
from experiments.robustness.sizes import largest_extent, of_other_size, scaled
from shared.geometry.se3 import inverse, transform_points
from tests.experiments.conftest import MakeContext


@pytest.fixture(scope="module")
def view(few_things: ViewSet) -> ShownView:
    return load(few_things.files[0])


@pytest.mark.parametrize("share", OCCLUDED)
@pytest.mark.parametrize("seed", range(3))
def test_the_occluded_share_of_the_object_is_hidden(
    view: ShownView, share: float, seed: int
) -> None:
    hidden = occluded(view, share, np.random.default_rng(seed))
    left = hidden.on_object.sum() / view.on_object.sum()
    assert left == pytest.approx(1 - share, abs=0.03)
    lost = (view.view.depth > 0) & (hidden.view.depth == 0)
    assert lost.mean() < 0.2  # around the object alone


def test_half_the_points_are_left(view: ShownView, rng: np.random.Generator) -> None:
    thinned = with_half_the_points(view, rng)
    assert thinned.on_object.sum() / view.on_object.sum() == pytest.approx(0.5, abs=0.03)


def test_noise_grows_with_its_factor(view: ShownView) -> None:
    errors = []
    for factor in (1, 2, 4):
        noisy = with_noise(view, factor, np.random.default_rng(0))
        seen = (noisy.view.depth > 0) & view.view.on_object
        errors.append(np.std(noisy.view.depth[seen].astype(float) - view.view.depth[seen]))
    assert errors[0] < errors[1] < errors[2]
    assert errors[2] / errors[0] == pytest.approx(4, rel=0.25)


def extents(view: ShownView) -> np.ndarray:
    """Return the reach of what is seen along the world's axes (3,)."""
    world_from_camera = inverse(view.view.camera_from_world)
    points = view.object_points[np.isfinite(view.object_points).all(axis=1)]
    return np.asarray(np.ptp(transform_points(world_from_camera, points), axis=0))


@pytest.mark.parametrize("seed", range(3))
def test_another_size_is_the_same_thing_on_the_same_table(view: ShownView, seed: int) -> None:
    other = of_other_size(view, np.random.default_rng(seed))
    assert other is not None
    assert other.depth_scale == view.depth_scale
    assert other.view.table_height == view.view.table_height
    np.testing.assert_allclose(
        other.view.camera_from_world, view.view.camera_from_world, atol=1e-12
    )
    before, after = view.view.camera_from_object, other.view.camera_from_object
    np.testing.assert_allclose(after[:3, :3], before[:3, :3], atol=1e-9)
    thing = build(view.view.object_name)
    drawn = variant(thing.class_name, np.random.default_rng(seed))
    factor = largest_extent(drawn) / largest_extent(thing)
    assert abs(factor - 1) > 0.01
    # What is seen grows with it (a part may come into sight or go), the table does not.
    assert (extents(other) / extents(view)).max() == pytest.approx(factor, rel=0.1)
    np.testing.assert_array_equal(
        *(each.view.depth[:100][each.view.label[:100] == 1][:50] for each in (view, other))
    )


def test_a_scaled_object_is_scaled(view: ShownView) -> None:
    thing = build("ladle1")
    other = scaled(thing, 1.3)
    np.testing.assert_allclose(other.vertices, 1.3 * thing.vertices)
    np.testing.assert_allclose(other.centre_of_mass, 1.3 * thing.centre_of_mass, atol=1e-12)
    assert largest_extent(other) == pytest.approx(1.3 * largest_extent(thing))


def test_what_is_not_in_the_catalogue_has_no_other_size(view: ShownView) -> None:
    stranger = replace(view, view=replace(view.view, object_name="drill"))
    assert of_other_size(stranger, np.random.default_rng(0)) is None


def test_every_condition_leaves_the_view_itself_alone(view: ShownView) -> None:
    depth = view.view.depth.copy()
    for change in CONDITIONS.values():
        change(view, np.random.default_rng(0))
    assert (view.view.depth == depth).all()


def test_robustness_of_one_view(make_context: MakeContext) -> None:
    findings = run(make_context("can1"))
    disturbances, motion = findings.tables
    assert [row[1] for row in disturbances.rows[::2]] == list(CONDITIONS)
    assert disturbances.rows[0][-1] is None
    for row in disturbances.rows[2:]:
        assert isinstance(row[-1], Share) != (row[1] == OTHER_SIZE)
    assert [row[1] for row in motion.rows] == ["v1", "v2"]
    # The law itself: the region does not depend on the frame of the input.
    for row in motion.rows:
        assert row[2] == Share(1, 1)
        assert row[3] == row[4] == 0
    assert findings.records[0]["condition"] == AS_IT_IS
