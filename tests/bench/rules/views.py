"""Objects on a table, seen once, with the part of every point."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from experiments.camera import D435, StereoNoise, render
from experiments.catalogue import CLASSES, CatalogueObject, variant
from experiments.dataset.drop import body_of
from experiments.dataset.photograph import photograph
from experiments.dataset.randomness import generator
from experiments.dataset.scene import draw_scene
from experiments.dataset.view import LabelledView
from shared.errors import InvalidInput
from tests.bench.rules.odd import odd

MIN_SEEN_PX = 60
"""A region of fewer pixels is not asked for, and of an object that shows fewer another
scene is drawn."""
_SCENES = 12


@dataclass(frozen=True)
class PartView:
    """A view, and which part of the object each pixel shows.

    Attributes
    ----------
    thing : CatalogueObject
    view : LabelledView
    part : (H, W) int16 array
        A number for each set of the object's parts that are in the same regions; -1
        where no object is seen.
    """

    thing: CatalogueObject
    view: LabelledView
    part: NDArray[np.int16]


def part_views(seed: int, per_class: int, *, kind: str, noisy: bool) -> Iterator[PartView]:
    """Yield one view of so many random objects of each class.

    Parameters
    ----------
    seed : int
    per_class : int
    kind : str
        `variants`, in dimensions that belong together, or `odd`.
    noisy : bool
        Through the noise of a stereo camera.
    """
    draw = {"variants": variant, "odd": odd}[kind]
    for class_name in CLASSES:
        for number in range(per_class):
            rng = generator(seed, f"rules on {kind} of {class_name}", number)
            thing = replace(draw(class_name, rng), name=f"{class_name}-{kind}-{number}")
            try:
                yield _seen(thing, number, rng, noisy=noisy)
            except InvalidInput:  # too large for the table
                continue


def _seen(
    thing: CatalogueObject, number: int, rng: np.random.Generator, *, noisy: bool
) -> PartView:
    body = body_of(thing)
    groups = _groups(thing)
    best: tuple[int, LabelledView, NDArray[np.int16]] | None = None
    for _ in range(_SCENES):
        scene = draw_scene(body, number, rng)
        view = photograph(thing, number, scene)
        least = int(view.regions.sum(axis=(1, 2)).min())
        if best is None or least > best[0]:
            ideal = render(
                thing, scene.world_from_object, scene.table, D435, scene.world_from_camera
            )
            best = (least, view, np.asarray(groups[ideal.part], dtype=np.int16))
        if least >= MIN_SEEN_PX:
            break
    assert best is not None
    _, view, part = best
    if noisy:
        view = view.with_noise(StereoNoise(), rng)
    return PartView(thing, view, np.where(view.on_object, part, np.int16(-1)))


def _groups(thing: CatalogueObject) -> NDArray[np.int16]:
    """Return the number of the group of each part; the last entry is for pixels without."""
    member = [tuple(part in held for held in thing.regions.values()) for part in thing.part_names]
    known = list(dict.fromkeys(member))
    return np.array([*(known.index(each) for each in member), -1], dtype=np.int16)
