"""Household objects as recovered parts."""

from __future__ import annotations

from collections.abc import Sequence

from shared.schemas.primitive import Primitive, ShapeClass

Extents = tuple[float, float, float]


def part(
    number: int,
    extents: Extents,
    shape_class: ShapeClass = "cylinder",
    probability: float = 0.95,
    position: Extents = (0.0, 0.0, 0.8),
    quaternion: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
) -> Primitive:
    exponents = {"cuboid": (0.1, 0.1), "cylinder": (0.1, 1.0), "sphere": (1.0, 1.0)}[shape_class]
    semi_axes = [extent / 2 for extent in extents]
    return Primitive(
        id=number,
        parameters=(*exponents, *semi_axes, *position, *quaternion),
        shape_class=shape_class,
        shape_probability=probability,
        full_extents=extents,
        residual_mm=1.0,
        support=500,
    )


ALONG_X = (0.0, 0.5**0.5, 0.0, 0.5**0.5)
"""Turns a part's own z into x."""

# Parts lie as in the object: each tool in the middle, its handle beside it.
PAN = (
    part(0, (0.18, 0.18, 0.06)),
    part(1, (0.02, 0.03, 0.2), position=(0.19, 0.0, 0.8), quaternion=ALONG_X),
)
PAN_WITH_FAT_HANDLE = (
    part(0, (0.18, 0.18, 0.06)),
    part(1, (0.03, 0.054, 0.2), position=(0.19, 0.0, 0.8), quaternion=ALONG_X),
)
HAMMER = (
    part(0, (0.035, 0.025, 0.3), "cuboid"),
    part(1, (0.03, 0.03, 0.1), "cuboid", position=(0.0, 0.0, 0.965), quaternion=ALONG_X),
)
BOTTLE = (part(0, (0.07, 0.07, 0.2)), part(1, (0.03, 0.03, 0.03), position=(0.0, 0.0, 0.915)))
LADLE = (
    part(0, (0.08, 0.08, 0.05), "sphere"),
    part(1, (0.004, 0.02, 0.25), "cuboid", position=(0.165, 0.0, 0.8), quaternion=ALONG_X),
)
TURNER = (
    part(0, (0.005, 0.09, 0.1), "cuboid"),
    part(1, (0.02, 0.02, 0.25), position=(0.0, 0.0, 0.975)),
)
KNIFE = (
    part(0, (0.002, 0.03, 0.18), "cuboid"),
    part(1, (0.015, 0.025, 0.11), "cuboid", position=(0.0, 0.0, 0.945)),
)
MUG = (
    part(0, (0.085, 0.085, 0.09)),
    part(1, (0.03, 0.014, 0.07), "cuboid", position=(0.057, 0.0, 0.8)),
)
SCISSORS = (
    part(0, (0.035, 0.006, 0.11), "cuboid"),
    part(1, (0.11, 0.01, 0.08), position=(0.0, 0.0, 0.895)).model_copy(update={"holes": 2}),
)
SCREWDRIVER = (part(0, (0.006, 0.006, 0.1)), part(1, (0.03, 0.03, 0.1), position=(0.0, 0.0, 0.9)))
CAN = (part(0, (0.066, 0.066, 0.11)),)
CARTON = (part(0, (0.28, 0.19, 0.06), "cuboid"),)
