"""Pieces that the rules take for one part, as one part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.reasoning.bodies import Bodies
from shared.geometry.rotation import quaternion_from_matrix
from shared.schemas.primitive import Joint, Primitive

Array = NDArray[np.float64]

IN_A_ROW = 0.8
"""Length of a box over that of its pieces together, from which on they lie end to end."""


@dataclass(frozen=True)
class Wholes:
    """The parts of an object as the rules see them.

    Attributes
    ----------
    primitives : tuple of Primitive
        The parts. One of several pieces has the id of its largest piece.
    joints : tuple of Joint
        Between them.
    pieces : mapping
        The ids of the pieces of each part of more than one, by the part's id.
    """

    primitives: tuple[Primitive, ...]
    joints: tuple[Joint, ...]
    pieces: Mapping[int, tuple[int, ...]]

    def ids(self, parts: Sequence[int]) -> tuple[int, ...]:
        """Return the ids of the primitives that these parts are made of."""
        return tuple(piece for part in parts for piece in self.pieces.get(part, (part,)))

    def part(self, number: int) -> Primitive:
        """Return the part of this id."""
        return next(each for each in self.primitives if each.id == number)


def as_they_are(primitives: Sequence[Primitive], joints: Sequence[Joint]) -> Wholes:
    """Return every primitive as a part of its own."""
    return Wholes(tuple(primitives), tuple(joints), {})


def joined(
    primitives: Sequence[Primitive], joints: Sequence[Joint], groups: Sequence[Sequence[int]]
) -> Wholes:
    """Return the parts where the primitives of each group are one.

    Parameters
    ----------
    primitives : sequence of Primitive
    joints : sequence of Joint
    groups : sequence of sequence of int
        Ids of primitives, each in one group at most.
    """
    by_id = {primitive.id: primitive for primitive in primitives}
    pieces: dict[int, tuple[int, ...]] = {}
    parts: dict[int, Primitive] = {}
    for group in groups:
        whole = _one_of([by_id[number] for number in group])
        pieces[whole.id] = tuple(sorted(group))
        parts[whole.id] = whole
    part_of = {piece: whole for whole, group in pieces.items() for piece in group}
    kept = [each for each in primitives if part_of.get(each.id, each.id) == each.id]
    ends = [
        (joint, tuple(part_of.get(number, number) for number in joint.primitive_ids))
        for joint in joints
    ]
    return Wholes(
        tuple(parts.get(each.id, each) for each in kept),
        tuple(
            joint.model_copy(update={"primitive_ids": between})
            for joint, between in ends
            if between[0] != between[1]
        ),
        pieces,
    )


def _one_of(pieces: Sequence[Primitive]) -> Primitive:
    """Return the box around pieces along the axes of the one that gives the smallest.

    A row of pieces that bends is as thick and wide as they are, not as its box. Shape
    class and exponents are the largest piece's.
    """
    shapes = [piece.superquadric for piece in pieces]
    largest = pieces[int(np.argmax([np.prod(shape.full_extents) for shape in shapes]))]
    bodies = Bodies.of(shapes)
    lowest, highest = bodies.boxes(bodies.rotations)
    low, high = lowest.min(axis=0), highest.max(axis=0)
    best = int((high - low).prod(axis=1).argmin())
    low, high, frame = low[best], high[best], bodies.rotations[best]
    own = largest.superquadric
    turn = _turn_to(own.rotation[:, 2], frame)
    frame = frame[:, turn]
    size = _no_wider_than_its_pieces((high - low)[turn], [shape.full_extents for shape in shapes])
    middle, half = frame @ ((low + high) / 2)[turn], size / 2
    points = sum(piece.support for piece in pieces)
    mean_square = sum(piece.support * piece.residual_mm**2 for piece in pieces) / max(points, 1)
    return largest.model_copy(
        update={
            "parameters": (
                *own.exponents,
                *half.tolist(),
                *middle.tolist(),
                *quaternion_from_matrix(frame).tolist(),
            ),
            "full_extents": tuple((2 * half).tolist()),
            "residual_mm": float(np.sqrt(mean_square)),
            "support": points,
            "holes": sum(piece.holes for piece in pieces),
            "deformation": None,
        }
    )


def _turn_to(axis: Array, frame: Array) -> Array:
    """Return the cyclic order of a frame's axes that makes the one nearest to `axis` the third.

    A superquadric's exponents tell its third axis from the others.
    """
    return np.roll(np.arange(3), 2 - int(np.abs(axis @ frame).argmax()))


def _no_wider_than_its_pieces(size: Array, pieces: Sequence[Sequence[float]]) -> Array:
    """Return the extents (3,) of a box; of pieces end to end, the two smaller of the largest piece.

    They are end to end if the box is nearly as long as all of them in a row.
    """
    ascending = np.sort(np.array(pieces), axis=1)
    order = np.argsort(size)
    if size[order[2]] < IN_A_ROW * ascending[:, 2].sum():
        return size
    slim = size.copy()
    slim[order[:2]] = np.minimum(size[order[:2]], ascending[:, :2].max(axis=0))
    return slim
