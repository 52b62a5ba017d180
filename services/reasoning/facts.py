"""What Prolog is told about an object's primitives."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

from services.reasoning.layout import layout_of
from shared.errors import InvalidInput, JsonObject
from shared.schemas.primitive import Joint, Primitive
from shared.schemas.scene import SupportPlane

_SMALLEST_M, _LARGEST_M = 1e-6, 1e3
_SMALLEST_EXPONENT, _LARGEST_EXPONENT = 0.01, 2.0
_TOLERANCE = 1e-3


def facts_of(primitives: Sequence[Primitive], max_primitives: int) -> list[JsonObject]:
    """Return the arguments of the `primitive_values` facts.

    Raises
    ------
    InvalidInput
        Too many primitives, an id given twice, extents that are not lengths or
        not twice the semi-axes, exponents that no superquadric has.
    """
    if len(primitives) > max_primitives:
        raise InvalidInput(
            f"{len(primitives)} primitives are too many to reason about, "
            f"allowed are {max_primitives}",
            field="primitives",
            found=len(primitives),
            allowed=max_primitives,
        )
    counts = Counter(primitive.id for primitive in primitives)
    twice = sorted(each for each, count in counts.items() if count > 1)
    if twice:
        raise InvalidInput(
            f"primitive ids must differ; given more than once: {twice}",
            field="primitives",
            found=twice,
        )
    return [_fact(index, primitive) for index, primitive in enumerate(primitives)]


def layout_facts(
    primitives: Sequence[Primitive],
    joints: Sequence[Joint],
    plane: SupportPlane | None,
    gripper_opening: float | None = None,
) -> JsonObject | None:
    """Return the arguments of the facts of rules/quantities.pl; None without primitives."""
    if not primitives:
        return None
    layout = layout_of(primitives, joints, plane)
    ids = [primitive.id for primitive in primitives]
    reaches, offsets = layout.reaches.tolist(), layout.offsets.tolist()
    seen = max(1, sum(primitive.support for primitive in primitives))
    return {
        "opening": gripper_opening,
        "length": float(layout.intervals.max()),
        "parts": [
            {
                "id": primitive.id,
                "extents": layout.extents[row].tolist(),
                "interval": layout.intervals[row].tolist(),
                "slant": float(layout.slants[row]),
                "holes": primitive.holes,
                "seen": primitive.support / seen,
                "residual": primitive.residual_mm / 1e3,
                "heights": None if layout.heights is None else layout.heights[row].tolist(),
            }
            for row, primitive in enumerate(primitives)
        ],
        "pairs": [
            [one, other, reaches[i][j], offsets[i][j]]
            for i, one in enumerate(ids)
            for j, other in enumerate(ids)
            if i != j
        ],
        "meeting": [
            [ids[one], ids[other], *continuity]
            for (one, other), continuity in zip(layout.meeting, layout.continuities, strict=True)
        ],
    }


def _fact(index: int, primitive: Primitive) -> JsonObject:
    shape = primitive.superquadric
    _check_extents(f"primitives.{index}.full_extents", primitive)
    for exponent in shape.exponents:
        if not _SMALLEST_EXPONENT <= exponent <= _LARGEST_EXPONENT * (1 + _TOLERANCE):
            raise InvalidInput(
                f"primitives.{index}.parameters: the exponents of a superquadric lie in "
                f"{_SMALLEST_EXPONENT:g}..{_LARGEST_EXPONENT:g}, found {exponent:g}",
                field=f"primitives.{index}.parameters",
                found=exponent,
                allowed=[_SMALLEST_EXPONENT, _LARGEST_EXPONENT],
            )
    return {
        "id": primitive.id,
        "position": [float(value) for value in shape.position],
        "dimensions": [float(value) for value in primitive.full_extents],
        "exponents": [float(value) for value in shape.exponents],
        "shape": primitive.shape_class,
        "probability": float(primitive.shape_probability),
    }


def _check_extents(field: str, primitive: Primitive) -> None:
    for extent, expected in zip(
        primitive.full_extents, primitive.superquadric.full_extents, strict=True
    ):
        if not _SMALLEST_M <= extent <= _LARGEST_M:
            raise InvalidInput(
                f"{field}: extents are metres in {_SMALLEST_M:g}..{_LARGEST_M:g}, found {extent:g}",
                field=field,
                found=extent,
                allowed=[_SMALLEST_M, _LARGEST_M],
            )
        if not math.isclose(extent, expected, rel_tol=_TOLERANCE):
            raise InvalidInput(
                f"{field}: {extent:g} is not twice the semi-axis of the parameters, "
                f"which gives {expected:g}",
                field=field,
                found=extent,
                expected=expected,
            )
