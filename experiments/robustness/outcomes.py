"""Asking about a view as it is, disturbed, and in another frame."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from experiments.framework import Asked, Context, ShownView, ask
from experiments.framework.asking import Source
from experiments.framework.scoring import GOOD_IOU, overlap
from experiments.robustness.disturbances import AS_IT_IS, CONDITIONS, OTHER_SIZE, Mask
from shared.client import GraspResult
from shared.schemas.task import Version


@dataclass(frozen=True)
class Disturbed:
    """The answer about a disturbed view, beside that about the view as it was.

    Attributes
    ----------
    condition : str
    asked : Asked
    same : bool or None
        Both found nothing, or both regions overlap by `GOOD_IOU` or more; None where
        their pixels are not of the same scene.
    """

    condition: str
    asked: Asked
    same: bool | None


@dataclass(frozen=True)
class Moved:
    """The answer about a cloud that was moved as a whole, beside that about the same at rest.

    Attributes
    ----------
    asked : Asked
        About the cloud at rest.
    changed, points : int
        How many of the object's points entered or left the region, and how many
        it has.
    flipped : bool
        Whether a region was found in one of the two only.
    """

    asked: Asked
    changed: int
    points: int
    flipped: bool


def ask_disturbed(
    context: Context, source: Source, view: ShownView, task: str, version: Version
) -> list[Disturbed]:
    """Return the answers to one question about a view under every condition."""
    rows: list[Disturbed] = []
    before: GraspResult | None = None
    for condition, change in CONDITIONS.items():
        other = change(view, _rng(context.seed, source, condition))
        if other is None or not other.on_object.any() or not other.truth(task).any():
            continue  # nothing is left to hold
        asked, after = ask(
            context.sparge, source, other, task, version, max_grasps=0, explain=False
        )
        if not asked.known:
            return []
        if condition == AS_IT_IS:
            before = after
        same = (
            None
            if condition == OTHER_SIZE  # other pixels: nothing to compare
            else _same(before, after, other.on_object)
        )
        rows.append(Disturbed(condition, asked, same))
    return rows


def ask_moved(
    context: Context, source: Source, view: ShownView, task: str, version: Version
) -> Moved:
    """Ask about the view's points at rest and after a random rigid motion."""
    rng = _rng(context.seed, source, "motion")
    rotation = Rotation.from_quat(rng.standard_normal(4)).as_matrix()
    offset = rng.uniform(-1, 1, 3)
    rest, there = (
        ask(
            context.sparge,
            source,
            view,
            task,
            version,
            arrays={"points": points},
            viewpoint=[float(value) for value in viewpoint],
            max_grasps=0,
            explain=False,
        )
        for points, viewpoint in (
            (view.points, np.zeros(3)),
            (view.points @ rotation.T + offset, offset),
        )
    )
    one, other = (
        np.zeros(int(view.on_object.sum()), dtype=np.bool_)
        if result is None
        else result.point_region[view.on_object]
        for _, result in (rest, there)
    )
    return Moved(rest[0], int((one != other).sum()), len(one), rest[0].found != there[0].found)


def _same(before: GraspResult | None, after: GraspResult | None, on_object: Mask) -> bool:
    one, other = (
        np.zeros(int(on_object.sum()), dtype=np.bool_)
        if each is None
        else each.point_region[on_object]
        for each in (before, after)
    )
    return overlap(one, other) >= GOOD_IOU


def _rng(seed: int, source: Source, use: str) -> np.random.Generator:
    text = f"{source.file.object_name}/{source.file.number}/{use}"
    digest = hashlib.sha256(text.encode()).digest()
    return np.random.default_rng([seed, int.from_bytes(digest[:8], "little")])
