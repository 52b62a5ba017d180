"""The stage as its caller sees it: which object, how completely, at which noise."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.perception.perceive import Perception
from shared.errors import NoObject
from shared.geometry.se3 import inverse, transform_points
from shared.schemas.scene import PerceiveResponse
from tests.services.perception.scenes import Shot, Stage, head_camera, small_view, spoon

SPOON = ("bowl", "handle")


@pytest.fixture(scope="module")
def stage() -> Perception:
    return Perception()


def mask(shot: Shot, answer: PerceiveResponse) -> NDArray[np.bool_]:
    found = np.zeros(shot.depth.size, dtype=bool)
    found[answer.object_indices] = True
    return found


def overlap(found: NDArray[np.bool_], true: NDArray[np.bool_]) -> tuple[float, float]:
    """Return intersection over union, and recall."""
    both = np.count_nonzero(found & true)
    return both / np.count_nonzero(found | true), both / np.count_nonzero(true)


def tilt_deg(shot: Shot, answer: PerceiveResponse) -> float:
    cosine = float(shot.world_from_camera[2, :3] @ answer.up)
    return float(np.rad2deg(np.arccos(np.clip(cosine, -1, 1))))


def test_a_spoon_of_10_mm_survives_noise_of_1_5_mm(
    stage: Perception, rng: np.random.Generator
) -> None:
    clean = spoon(Stage().table()).shoot()
    for _ in range(3):
        shot = clean.with_noise(rng, 0.0015)
        answer = stage.perceive(shot.request())
        found = mask(shot, answer)
        iou, recall = overlap(found, shot.pixels(*SPOON))
        assert iou > 0.95
        assert recall > 0.99
        assert overlap(found, shot.pixels("handle"))[1] > 0.98
        assert tilt_deg(shot, answer) < 0.05
        assert answer.plane is not None
        assert 0.9 < answer.plane.residual_mm < 1.6  # 1.5 mm of depth, seen at 50 degrees


@pytest.mark.parametrize(("sigma_mm", "iou"), [(0.0, 0.95), (0.5, 0.95), (1.0, 0.85), (1.5, 0.8)])
def test_a_card_of_2_mm_is_found(
    stage: Perception, rng: np.random.Generator, sigma_mm: float, iou: float
) -> None:
    shot = Stage().table().box("card", (0.054, 0.085, 0.002), (0, 0, 0)).shoot()
    shot = shot.with_noise(rng, 1e-3 * sigma_mm)
    answer = stage.perceive(shot.request())
    assert overlap(mask(shot, answer), shot.pixels("card"))[0] > iou


def test_a_blade_of_3_mm_stays_with_its_handle(stage: Perception, rng: np.random.Generator) -> None:
    knife = Stage().table().box("grip", (0.02, 0.09, 0.012), (0, 0.045, 0))
    clean = knife.box("blade", (0.014, 0.1, 0.003), (0, -0.05, 0)).shoot()
    for sigma, least in ((0.0, 0.9), (0.0015, 0.75)):
        shot = clean.with_noise(rng, sigma)
        found = mask(shot, stage.perceive(shot.request()))
        assert overlap(found, shot.pixels("blade"))[1] > least
        assert np.count_nonzero(found & shot.pixels("table")) < 0.05 * np.count_nonzero(found)


def test_noise_alone_is_no_object(stage: Perception, rng: np.random.Generator) -> None:
    bare = Stage().table().shoot()
    for sigma in (0.0, 0.0015, 0.004):
        with pytest.raises(NoObject, match="nothing stands out"):
            stage.perceive(bare.with_noise(rng, sigma).request())


def test_a_blot_too_thin_for_an_object_is_reported(stage: Perception) -> None:
    shot = Stage().table().box("coin", (0.01, 0.01, 0.003), (0, 0, 0)).shoot()
    with pytest.raises(NoObject, match=r"largest thing off it has \d+ points") as caught:
        stage.perceive(shot.request())
    assert "15 to 600 mm" in caught.value.details["allowed"]


def test_the_central_object_is_picked_and_the_others_are_obstacles(stage: Perception) -> None:
    shot = small_view()
    answer = stage.perceive(shot.request())
    assert overlap(mask(shot, answer), shot.pixels("box"))[0] > 0.95
    assert answer.clusters == 3
    true = transform_points(inverse(shot.world_from_camera), np.array([[0.05, 0.2, 0.035]]))
    nearest = np.linalg.norm(answer.obstacle_points - true, axis=1).min()
    assert nearest < 0.036  # on the ball
    assert answer.dropped["invalid"] == np.count_nonzero(shot.depth == 0)
    assert len(answer.object_indices) + sum(answer.dropped.values()) == answer.input_points


@pytest.mark.parametrize(
    ("name", "at"), [("ball", (0.05, 0.2, 0.035)), ("can", (0.08, -0.18, 0.05)), ("box", (0, 0, 0))]
)
def test_a_target_point_picks_the_object_next_to_it(
    stage: Perception, name: str, at: tuple[float, ...]
) -> None:
    shot = small_view()
    target = transform_points(inverse(shot.world_from_camera), np.array([at], dtype=float))[0]
    answer = stage.perceive(shot.request(target=tuple(target.tolist())))
    assert overlap(mask(shot, answer), shot.pixels(name))[0] > 0.95


def test_the_points_are_the_rows_of_the_input(stage: Perception) -> None:
    shot = small_view()
    answer = stage.perceive(shot.request())
    np.testing.assert_allclose(answer.object_points, shot.cloud()[answer.object_indices], atol=1e-4)
    assert (np.diff(answer.object_indices) > 0).all()


def test_the_plane_faces_the_objects(stage: Perception) -> None:
    answer = stage.perceive(small_view().request())
    assert answer.plane is not None
    heights = answer.object_points @ answer.plane.normal + answer.plane.offset
    assert 0.0 < heights.min() < 0.006  # one row of pixels
    assert heights.max() == pytest.approx(0.05, abs=1e-3)
    assert answer.plane.normal == answer.up


def test_a_handle_hidden_behind_its_pan_belongs_to_it(stage: Perception) -> None:
    """The rim hides the handle's root, so that the view shows two pieces."""
    pan = Stage().table().cylinder("pan", 0.09, 0.09, (0, 0, 0))
    shot = pan.box("handle", (0.16, 0.02, 0.012), (0.17, 0, 0.07)).shoot(head_camera(20.0, 0.9))
    found = mask(shot, stage.perceive(shot.request()))
    handle = shot.pixels("handle")
    assert np.count_nonzero(handle) > 100
    assert overlap(found, handle)[1] > 0.95
    assert overlap(found, shot.pixels("pan"))[1] > 0.95


@pytest.mark.parametrize(("start", "joined"), [(0.03, True), (0.15, False)])
def test_a_long_handle_cut_off_by_the_bowl_before_it_belongs_to_it(
    stage: Perception, start: float, joined: bool
) -> None:
    """A ladle on the table shows bowl and handle far apart; with its end in sight, a spoon."""
    ladle = Stage().table().cylinder("bowl", 0.04, 0.07, (0, 0, 0))
    shot = ladle.box("handle", (0.2, 0.02, 0.008), (start + 0.1, 0, 0.003)).shoot()
    answer = stage.perceive(shot.request())
    assert answer.clusters == (1 if joined else 2)
    found = mask(shot, answer)
    assert (overlap(found, shot.pixels("bowl", "handle"))[0] > 0.95) == joined


def test_a_can_in_front_of_a_box_is_not_joined_to_it(stage: Perception) -> None:
    pair = Stage().table().cylinder("can", 0.03, 0.1, (-0.06, 0, 0))
    shot = pair.box("box", (0.06, 0.09, 0.15), (0.1, 0.04, 0)).shoot()
    answer = stage.perceive(shot.request())
    found = mask(shot, answer)
    assert answer.clusters == 2
    assert max(overlap(found, shot.pixels(name))[0] for name in ("can", "box")) > 0.95
