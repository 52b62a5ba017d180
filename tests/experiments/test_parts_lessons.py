"""The objects that the judges of cuts learn from."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.catalogue import build
from experiments.parts.lessons import lessons, noise_level
from experiments.parts.warp import doubled, warped


def test_a_warped_object_keeps_its_parts_and_regions() -> None:
    hammer = build("hammer1")
    other = warped(hammer, np.random.default_rng(3))
    assert other.part_names == hammer.part_names
    assert other.regions == hammer.regions
    assert other.vertices.shape == hammer.vertices.shape
    assert np.isfinite(other.vertices).all()
    ratio = np.ptp(other.vertices, axis=0) / np.ptp(hammer.vertices, axis=0)
    assert ((ratio > 0.3) & (ratio < 3)).all()
    assert np.abs(ratio - 1).max() > 0.02


def test_the_same_state_warps_the_same_way() -> None:
    pan = build("pan1")
    one, same, other = (warped(pan, np.random.default_rng(seed)).vertices for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert np.abs(one - other).max() > 1e-3


def test_a_second_handle_is_opposite_the_first() -> None:
    mug = doubled(build("mug1"), "handle")
    assert mug.part_names[-1] == "second_handle"
    assert mug.regions["second"] == ("second_handle",)
    middles = [
        np.concatenate([mesh.vertices for mesh in part.meshes]).mean(axis=0) for part in mug.parts
    ]
    body, first, second = (
        middles[mug.part_names.index(n)] for n in ("body", "handle", "second_handle")
    )
    assert (first - body)[0] == pytest.approx(-(second - body)[0], abs=0.004)
    assert first[2] == pytest.approx(second[2])


def test_only_a_part_that_is_there_can_be_doubled() -> None:
    with pytest.raises(ValueError, match="no part 'spout'"):
        doubled(build("mug1"), "spout")


def test_rounds_do_not_depend_on_where_one_begins() -> None:
    both, second = list(lessons(4, 0, 2)), list(lessons(4, 1, 2))
    assert [thing.name for thing in both[-len(second) :]] == [thing.name for thing in second]
    for one, other in zip(both[-len(second) :], second, strict=True):
        np.testing.assert_array_equal(one.vertices, other.vertices)
    assert len({thing.name for thing in both}) == len(both)
    # The other opinion of every bottle, in every round.
    assert sum(thing.name.endswith("-b") for thing in both) == 2
    assert sum(thing.name.endswith("-b") for thing in second) == 1


def test_some_sensors_have_no_noise_and_others_much(rng: np.random.Generator) -> None:
    sigmas = np.array([noise_level(rng)[0] for _ in range(200)])
    assert 0.2 < (sigmas == 0).mean() < 0.5
    assert sigmas.max() > 2e-3
