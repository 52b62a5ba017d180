"""The film of an execution: it shows what happened, and changes nothing about it."""

from __future__ import annotations

import io
from functools import cache

import numpy as np
import pytest
from PIL import Image, ImageSequence

from services.execution.arm import HOME, Arm
from services.execution.body import rigid_body
from services.execution.bullet import physics
from services.execution.film import (
    HIGHLIGHT,
    LAST_FRAME_S,
    OBJECT,
    SIZE,
    bounded_gif,
    film,
    surfaces,
)
from services.execution.recording import FRAME_S, Recorder, Recording, Snapshot
from services.execution.scene import scene_from_request
from services.execution.scenery import BACKDROP, Scenery, Surface, scenery
from services.execution.world import World
from shared.errors import InvalidInput
from shared.geometry.se3 import pose_matrix
from shared.schemas.execution import ExecuteRequest, ExecuteResponse
from shared.wire.codec import validate
from tests.services.execution.scenes import (
    CAMERA_FROM_WORLD,
    STANDING_SUPERQUADRIC,
    box,
    cylinder,
    execute,
    from_above,
    from_side,
    request,
)

BASE = pose_matrix([-0.55, 0.0, 0.0], np.eye(3))
PUSHED = request((0, 0, 0.045), from_above(), box((0.05, 0.05, 0.03), (0, 0, 0.03)), width=0.03)
LIFTED = request((0, 0, 0.09), from_side(), cylinder(), seen_from=CAMERA_FROM_WORLD)


@cache
def filmed(which: str) -> ExecuteResponse:
    asked = {"pushed": PUSHED, "lifted": LIFTED}[which]
    return execute(asked.model_copy(update={"animate": True}))


def pictures(answer: ExecuteResponse) -> list[Image.Image]:
    assert answer.animation is not None
    with Image.open(io.BytesIO(answer.animation.tobytes())) as held:
        return [each.copy() for each in ImageSequence.Iterator(held)]


@pytest.mark.parametrize(("which", "asked"), [("pushed", PUSHED), ("lifted", LIFTED)])
def test_filming_changes_nothing_about_what_happens(which: str, asked: ExecuteRequest) -> None:
    alone = execute(asked)
    assert alone.animation is None
    assert filmed(which).model_copy(update={"animation": None}) == alone


def test_the_film_lasts_as_long_as_the_motion() -> None:
    answer = filmed("lifted")
    shown = pictures(answer)
    assert {each.size for each in shown} == {SIZE}
    assert shown[0].info["loop"] == 0
    lasts = sum(each.info["duration"] for each in shown) / 1000
    moves = answer.phases[-1].simulated_s - answer.phases[0].simulated_s
    assert lasts == pytest.approx(moves + LAST_FRAME_S, abs=FRAME_S)
    assert answer.animation is not None
    assert len(answer.animation) < 2**20


def test_all_films_have_the_same_backdrop() -> None:
    for which in ("pushed", "lifted"):
        for picture in pictures(filmed(which)):
            assert picture.convert("RGB").getpixel((SIZE[0] - 1, 0)) == BACKDROP


@pytest.mark.parametrize(
    "asked",
    [
        request((2, 0, 0.12), from_above(), cylinder(), animate=True),
        request((0, 0, 0.12), from_above(), cylinder(), width=0.081, animate=True),
    ],
)
def test_there_is_no_film_when_nothing_moves(asked: ExecuteRequest) -> None:
    answer = execute(asked)
    assert answer.outcome == "unreachable"
    assert answer.animation is None


def moments(*heights: float) -> Recording:
    return Recording(
        BASE,
        tuple(
            Snapshot("lift", HOME, 0.06, pose_matrix([0.0, 0.0, height], np.eye(3)))
            for height in heights
        ),
    )


def test_the_same_recording_gives_the_same_bytes() -> None:
    asked = request((0, 0, 0.09), from_side(), cylinder())
    scene = scene_from_request(asked)
    body = rigid_body(scene.parts)
    films = [film(asked, scene, body, moments(0.075, 0.2), "slipped_in_lift") for _ in range(2)]
    np.testing.assert_array_equal(films[0], films[1])
    assert bytes(films[0][:6]) == b"GIF89a"


def rows_of(picture: np.ndarray, colour: tuple[float, ...]) -> np.ndarray:
    """Return the rows of pixels in which `colour`, darker or lighter, is the hue."""
    pixels = picture.astype(float)
    hue = pixels / np.maximum(pixels.max(axis=2, keepdims=True), 1)
    wanted = np.array(colour[:3]) / max(colour[:3])
    return np.nonzero((np.abs(hue - wanted) < 0.05).all(axis=2))[0]


def test_a_picture_shows_the_object_where_it_is_and_the_part_to_hold() -> None:
    vertices, faces = box((0.04, 0.04, 0.08), (0, 0, 0))
    upper = vertices[faces].mean(axis=1)[:, 2] > 0.079
    drawn = [
        Surface(vertices, faces[~upper], OBJECT),
        Surface(vertices, faces[upper], HIGHLIGHT),
    ]
    recording = moments(0.08, 0.3)
    with scenery(recording.world_from_base, drawn) as stage:
        low, high = (stage.draw(each) for each in recording.snapshots)
    assert rows_of(high, OBJECT).mean() < rows_of(low, OBJECT).mean() - 50
    assert 0 < rows_of(low, HIGHLIGHT).mean() < rows_of(low, OBJECT).mean()


def test_the_picture_does_not_depend_on_where_the_robot_stands() -> None:
    turned = pose_matrix([0.3, -0.2, 0.0], [[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    place = pose_matrix([0.55, 0.0, 0.08], np.eye(3))
    drawn = [Surface(*box((0.04, 0.04, 0.08), (0, 0, 0)), OBJECT)]
    shown = []
    for base in (np.eye(4), turned):
        with scenery(base, drawn) as stage:
            shown.append(stage.draw(Snapshot("drive", HOME, 0.06, base @ place)).astype(int))
    assert (np.abs(shown[0] - shown[1]).max(axis=2) > 8).mean() < 0.01


def test_the_robot_of_the_film_holds_what_the_simulated_one_holds() -> None:
    with physics() as bullet:
        simulated = Arm(bullet)
        simulated.stand_at(BASE)
        simulated.set_joints(HOME)
        expected = simulated.world_from_grasp()
        stage = Scenery(bullet, BASE, [])
        stage.draw(moments(0.0).snapshots[0])
        assert stage.robot is not None
        np.testing.assert_allclose(stage.robot.world_from_grasp(), expected, atol=1e-6)


def test_a_recorder_of_a_world_that_diverges_stops() -> None:
    with physics() as bullet:
        asked = request((0, 0, 0.09), from_side(), cylinder())
        world = World(bullet, rigid_body(scene_from_request(asked).parts))
        recorder = Recorder(world, Arm(bullet))
        assert recorder.recording() is None
        recorder.watch("drive")
        bullet.resetBasePositionAndOrientation(world.object, [np.nan, 0, 0], [0, 0, 0, 1])
        recording = recorder.recording()
    assert recording is not None
    assert len(recording.snapshots) == 1


def test_primitives_and_fine_meshes_are_drawn_as_they_are_simulated() -> None:
    coarse = request((0, 0, 0.09), from_side(), cylinder())
    assert coarse.faces is not None
    fine = coarse.model_copy(update={"faces": np.tile(coarse.faces, (400, 1))})
    primitives = request((0, 0, 0.1), from_side(), primitives=(STANDING_SUPERQUADRIC,))
    for asked, as_parts in ((coarse, False), (fine, True), (primitives, True)):
        scene = scene_from_request(asked)
        body = rigid_body(scene.parts)
        drawn = surfaces(asked, scene, body)
        assert [len(each.faces) for each in drawn] == (
            [len(part.faces) for part in body.parts] if as_parts else [len(coarse.faces)]
        )
        corners = np.concatenate([each.vertices for each in drawn])
        solid = np.concatenate([part.vertices for part in body.parts])
        np.testing.assert_allclose(corners.min(axis=0), solid.min(axis=0), atol=1e-9)


def test_a_long_film_is_thinned_out(rng: np.random.Generator) -> None:
    noise = [Image.fromarray(rng.integers(0, 255, (64, 64, 3), dtype=np.uint8)) for _ in range(40)]
    data = bounded_gif(noise, 0.1, 50_000)
    assert len(data) <= 50_000
    with Image.open(io.BytesIO(data)) as held:
        lasts = [each.info["duration"] for each in ImageSequence.Iterator(held)]
    assert 2 <= len(lasts) < 40
    assert sum(lasts) / 1000 == pytest.approx(39 * 0.1 + LAST_FRAME_S, abs=1.0)


@pytest.mark.parametrize("change", [{"highlight": np.ones(3, dtype=bool)}, {"faces": None}])
def test_highlight_needs_an_entry_for_each_face(change: dict[str, object]) -> None:
    vertices, faces = cylinder()
    fields = {
        **request((0, 0, 0.09), from_side(), (vertices, faces)).model_dump(),
        "highlight": np.zeros(len(faces), dtype=bool),
    }
    validate(ExecuteRequest, fields)
    if change.get("faces", 0) is None:
        change = {
            "faces": None, "vertices": None, "primitives": (STANDING_SUPERQUADRIC,)
        }  # fmt: skip
    with pytest.raises(InvalidInput, match="every face"):
        validate(ExecuteRequest, fields | change)
