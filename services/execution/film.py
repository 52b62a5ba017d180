"""An animated GIF of what happened, for people."""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageColor, ImageDraw, ImageFont

from services.execution.body import RigidBody
from services.execution.recording import FRAME_S, Recording
from services.execution.scene import Scene
from services.execution.scenery import BACKDROP, Surface, scenery
from shared.geometry.se3 import inverse, transform_points
from shared.schemas.execution import ExecuteRequest, Outcome
from shared.schemas.gripper import ParallelGripper, SuctionGripper

Array = NDArray[np.float64]

SIZE = (480, 360)
MAX_BYTES = 4 * 2**20
LAST_FRAME_S = 2.0
"""How long the outcome stays before the film begins anew."""
MAX_DRAWN_FACES = 20_000
"""A finer mesh is drawn as the convex parts that it is simulated as."""
OBJECT, HIGHLIGHT = (0.42, 0.72, 0.80, 1.0), (1.0, 0.50, 0.08, 1.0)
WORDS = {
    "drive": "moving there",
    "approach": "approaching",
    "close": "closing the fingers",
    "lift": "lifting",
    "hold": "holding",
    "shake": "shaking",
    "tilt": "tilting",
}
"""What people call the phases."""
COLOURS = 160
INK, PAPER, GOOD, BAD = "#1F2933", "#FFFFFF", "#1B7F4B", "#B3261E"


def film(
    request: ExecuteRequest,
    scene: Scene,
    body: RigidBody,
    recording: Recording,
    outcome: Outcome,
    gripper: ParallelGripper | SuctionGripper | None = None,
) -> NDArray[np.uint8]:
    """Return the bytes (B,) of an animated GIF; the same ones for the same recording.

    Parameters
    ----------
    request : ExecuteRequest
        Its mesh, if it has one, is what is drawn.
    scene : Scene
    body : RigidBody
        As simulated.
    recording : Recording
    outcome : str
        Is written on the last picture.
    gripper : ParallelGripper or SuctionGripper, optional
        What flies by itself, where no arm moves.
    """
    shown = surfaces(request, scene, body)
    with scenery(recording.world_from_base, shown, gripper) as stage:
        pictures = [_picture(stage.draw(snapshot)) for snapshot in recording.snapshots]
    for picture, snapshot in zip(pictures[:-1], recording.snapshots[:-1], strict=True):
        _write(picture, WORDS[snapshot.phase], INK)
    _write(pictures[-1], outcome.replace("_", " "), GOOD if outcome in ("lifted", "held") else BAD)
    return np.frombuffer(bounded_gif(pictures, FRAME_S, MAX_BYTES), dtype=np.uint8)


def surfaces(request: ExecuteRequest, scene: Scene, body: RigidBody) -> list[Surface]:
    """Return what is drawn of the object, in the body's frame."""
    vertices, faces = request.vertices, request.faces
    if vertices is None or faces is None or len(faces) > MAX_DRAWN_FACES:
        return [Surface(part.vertices, part.faces, OBJECT) for part in body.parts]
    body_from_mesh = inverse(body.world_from_body) @ scene.world_from_mesh
    placed = transform_points(body_from_mesh, vertices)
    chosen = np.zeros(len(faces), dtype=bool) if request.highlight is None else request.highlight
    return [
        Surface(placed, faces[which], colour)
        for which, colour in ((~chosen, OBJECT), (chosen, HIGHLIGHT))
        if which.any()
    ]


def bounded_gif(pictures: Sequence[Image.Image], pace_s: float, max_bytes: int) -> bytes:
    """Return an animation of at most `max_bytes`: with fewer pictures if need be, two at least."""
    while len(data := gif(pictures, pace_s)) > max_bytes and len(pictures) > 2:
        pictures, pace_s = [*pictures[:-1:2], pictures[-1]], 2 * pace_s
    return data


def gif(pictures: Sequence[Image.Image], pace_s: float) -> bytes:
    """Return pictures of one size as an animation that repeats, with one palette for all.

    One palette and no dithering: what does not move does not flicker, and takes no space.
    """
    palette = _palette(pictures)
    frames = [_indexed(picture, palette) for picture in pictures]
    pace, last = round(1000 * pace_s), round(1000 * LAST_FRAME_S)
    stream = io.BytesIO()
    frames[0].save(
        stream,
        format="GIF",
        save_all=True,
        append_images=frames[1:],
        duration=[pace] * (len(frames) - 1) + [last],
        loop=0,
        optimize=True,
    )
    return stream.getvalue()


def _indexed(picture: Image.Image, palette: Image.Image) -> Image.Image:
    """Return a picture in the colours of `palette`, the backdrop exactly as it is.

    Pillow looks a colour up in cells of several, so that an exact match may lose to a
    close one of the same cell.
    """
    frame = picture.quantize(palette=palette, dither=Image.Dither.NONE)
    numbers = np.asarray(frame).copy()
    numbers[(np.asarray(picture) == BACKDROP).all(axis=2)] = COLOURS
    exact = Image.frombytes("P", frame.size, numbers.tobytes())
    exact.putpalette(frame.getpalette() or [])
    return exact


def _palette(pictures: Sequence[Image.Image]) -> Image.Image:
    """Return an image with a palette for all pictures; backdrop and paper are in it as they are.

    Every colour that occurs counts once, not by how many pixels have it: the
    object is small and its colours matter.
    """
    occurs = np.zeros((64, 64, 64), dtype=bool)
    for picture in (*pictures[::6], pictures[-1]):
        occurs[tuple(np.asarray(picture).reshape(-1, 3).T // 4)] = True
    distinct = (4 * np.argwhere(occurs) + 2).astype(np.uint8)
    found = Image.fromarray(distinct[None]).quantize(COLOURS, Image.Quantize.MEDIANCUT)
    colours = found.getpalette() or []
    palette = Image.new("P", (1, 1))
    palette.putpalette([*colours[: 3 * COLOURS], *BACKDROP, *ImageColor.getrgb(PAPER)])
    return palette


def _picture(drawn: NDArray[np.uint8]) -> Image.Image:
    return Image.fromarray(drawn).resize(SIZE, Image.Resampling.LANCZOS)


def _write(picture: Image.Image, text: str, colour: str) -> None:
    """Write a word in the lower left corner of a picture."""
    draw = ImageDraw.Draw(picture)
    font = ImageFont.load_default(20)
    left, top, right, bottom = draw.textbbox((16, picture.height - 40), text, font=font)
    draw.rounded_rectangle((left - 8, top - 6, right + 8, bottom + 6), 6, fill=PAPER)
    draw.text((16, picture.height - 40), text, fill=colour, font=font)
