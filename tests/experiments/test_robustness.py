"""Disturbances, as laws on views; and a slice of the experiment."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.framework import Share, ViewSet
from experiments.framework.views import ShownView, load
from experiments.robustness.disturbances import (
    AS_IT_IS,
    CONDITIONS,
    OCCLUDED,
    SCALES,
    occluded,
    rescaled,
    with_half_the_points,
    with_noise,
)
from experiments.robustness.experiment import run
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


def test_another_size_is_the_same_scene_scaled(view: ShownView, rng: np.random.Generator) -> None:
    other = rescaled(view, rng)
    factor = other.depth_scale / view.depth_scale
    assert SCALES[0] <= factor <= SCALES[1]
    np.testing.assert_allclose(other.object_points, factor * view.object_points)


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
    assert all(isinstance(row[-1], Share) for row in disturbances.rows[2:])
    assert [row[1] for row in motion.rows] == ["v1", "v2"]
    # The law itself: the region does not depend on the frame of the input.
    for row in motion.rows:
        assert row[2] == Share(1, 1)
        assert row[3] == row[4] == 0
    assert findings.records[0]["condition"] == AS_IT_IS
