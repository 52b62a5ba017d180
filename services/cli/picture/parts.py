"""The recovered superquadrics as wires, with their numbers and sizes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from services.cli.picture.style import darker
from services.cli.picture.view import View
from shared.schemas.primitive import Primitive
from shared.superquadric import Superquadric, surface_mesh

Array = NDArray[np.float64]

RINGS, SEGMENTS = 23, 48


def vertices_of(primitive: Primitive) -> Array:
    """Return points (K, 3) of its surface."""
    return surface_mesh(primitive.superquadric, RINGS, SEGMENTS)[0]


def _wires(superquadric: Superquadric) -> list[Array]:
    """Return latitudes and longitudes of the surface as lines (K, 3)."""
    vertices, _ = surface_mesh(superquadric, RINGS, SEGMENTS)
    rings = vertices[1:-1].reshape(RINGS, SEGMENTS, 3)
    latitudes = [np.vstack([ring, ring[:1]]) for ring in rings[2::3]]
    longitudes = [
        np.vstack([vertices[:1], rings[:, k], vertices[-1:]]) for k in range(0, SEGMENTS, 4)
    ]
    return latitudes + longitudes


def draw_parts(
    axes: Axes,
    view: View,
    primitives: Sequence[Primitive],
    colour_of: Mapping[int, str],
    *,
    front: bool,
) -> None:
    """Draw the wires that face the eye (`front`), or those behind the cloud."""
    for each in primitives:
        if each.id not in colour_of:
            continue
        solid, pieces = each.superquadric, []
        for line in _wires(solid):
            segments = np.stack([line[:-1], line[1:]], axis=1)
            local = solid.to_local(segments.mean(axis=1)) / np.square(solid.semi_axes)
            facing = (local @ solid.rotation.T) @ view.axes[2] > 0
            pieces.append(segments[facing == front])
        axes.add_collection(
            LineCollection(
                list(view.flat(np.concatenate(pieces))),
                colors=[to_rgba(darker(colour_of[each.id]), 0.8 if front else 0.4)],
                linewidths=0.8 if front else 0.6,
                zorder=4 if front else 2,
            ),
            autolim=False,
        )


def number_parts(
    axes: Axes, view: View, primitives: Sequence[Primitive], colour_of: Mapping[int, str]
) -> None:
    """Write each part's id at its centre."""
    for each in primitives:
        x, y = view.flat(np.array(each.superquadric.position))
        axes.text(
            x,
            y,
            str(each.id),
            ha="center",
            va="center",
            fontsize=12,
            fontweight="bold",
            color=darker(colour_of[each.id]),
            bbox={"boxstyle": "circle,pad=0.2", "fc": "white", "ec": darker(colour_of[each.id])},
            zorder=6,
        )


def list_parts(
    figure: Figure, primitives: Sequence[Primitive], colour_of: Mapping[int, str]
) -> None:
    """Write the legend: id, shape class and sizes of each part."""
    handles = []
    for each in primitives:
        sizes = " × ".join(f"{1e3 * extent:.0f}" for extent in sorted(each.full_extents)[::-1])
        handles.append(
            Line2D(
                [],
                [],
                marker="o",
                linestyle="",
                markersize=8,
                color=colour_of[each.id],
                label=f"{each.id}  {each.shape_class}, {sizes} mm",
            )
        )
    if handles:
        figure.legend(
            handles=handles,
            loc="center",
            bbox_to_anchor=(0.25, 0.065),
            ncols=min(len(handles), 2),
            fontsize=11,
            frameon=False,
            handletextpad=0.3,
            columnspacing=1.6,
        )
    else:
        figure.text(0.25, 0.065, "no parts were recovered", ha="center", va="center", fontsize=12)
