"""Smooth solids made of a few measures: limbs, shells, plates and cartons."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from experiments.catalogue.model import Mesh
from experiments.catalogue.shapes import loft, moved, superellipse, sweep
from shared.geometry.rotation import unit

Array = NDArray[np.float64]


def curve(knots: ArrayLike, steps: int = 24) -> Array:
    """Return `steps` points (steps, D) on a smooth curve through knots (K, D).

    Monotone cubic pieces over the chord length (Fritsch and Carlson, 1980):
    no coordinate swings beyond the knots on its two sides.
    """
    given = np.asarray(knots, dtype=np.float64)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(given, axis=0), axis=1))])
    share = np.linspace(0, along[-1], steps)
    return np.asarray(PchipInterpolator(along, given)(share))


def limb(
    spine: ArrayLike,
    profile: ArrayLike,
    side: ArrayLike,
    *,
    exponent: float = 2.5,
    steps: int = 28,
    round_start: float = 0.0,
    round_end: float = 0.0,
    segments: int = 28,
) -> Mesh:
    """Return a handle, a shank or a blade: a cross-section that varies along a curve.

    Parameters
    ----------
    spine : (K, 3) array_like
        Knots of the curve through the centres, metres.
    profile : (M, 3) array_like
        Share of the length from 0 to 1, width across `side`, thickness.
    side : (3,) array_like
        Where the width is measured, as far as the spine allows.
    exponent : float
        Of the cross-section: 2 is an ellipse, larger ones are rounded rectangles.
    steps : int
        Number of cross-sections, besides those of rounded ends.
    round_start, round_end : float
        Over which length an end is rounded off, metres.
    segments : int
        Points per cross-section.
    """
    dense = curve(spine, 400)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(dense, axis=0), axis=1))])
    length = float(along[-1])
    dome = 1 - np.cos(np.linspace(0, np.pi / 2, 7))  # from the tip inwards
    start = round_start * dome[:-1] if round_start else np.empty(0)
    end = length - round_end * dome[:-1] if round_end else np.empty(0)
    middle = np.linspace(round_start, length - round_end, steps)
    reach = np.sort(np.concatenate([start, middle, end]))
    centres = np.column_stack([np.interp(reach, along, dense[:, k]) for k in range(3)])
    given = np.asarray(profile, dtype=np.float64)
    sizes = PchipInterpolator(given[:, 0], given[:, 1:])(reach / length)
    for rounding, gap in ((round_start, reach), (round_end, length - reach)):
        if rounding:
            inside = np.clip(1 - gap / rounding, 0, 1)
            sizes = sizes * np.maximum(np.sqrt(1 - inside**2), 0.12)[:, None]
    sections = [superellipse(w, t, exponent, segments) for w, t in sizes]
    return sweep(centres, sections, side)


def shell(outside: ArrayLike, wall: float) -> Array:
    """Return the closed profile of a vessel, for `revolve`: outside, rounded rim, inside.

    Parameters
    ----------
    outside : (K, 2) array_like
        Radius and height from the axis at the bottom to the rim, metres. Where it
        bends inwards, its radius of curvature must exceed the wall.
    wall : float
        Thickness everywhere, metres.
    """
    outer = np.asarray(outside, dtype=np.float64)
    tangent = unit(np.gradient(outer, axis=0))
    tangent[0] = (1.0, 0.0)
    inwards = np.column_stack([-tangent[:, 1], tangent[:, 0]])
    inner = outer + wall * inwards
    inner[0, 0] = 0.0
    turn = np.linspace(0, np.pi, 7)[1:-1, None]
    rim = (outer[-1] + inner[-1]) / 2 + wall / 2 * (
        -np.cos(turn) * inwards[-1] + np.sin(turn) * tangent[-1]
    )
    return np.vstack([outer, rim, inner[::-1]])


def plate(outline: ArrayLike, thickness: float, *, sag: float = 0.0, steps: int = 24) -> Mesh:
    """Return a flat blade along +x, symmetric about y = 0, its middle at z = 0.

    Parameters
    ----------
    outline : (K, 2) array_like
        Distance along x and width there, metres.
    thickness : float
        Metres.
    sag : float
        How much lower the middle of the length is than its ends, metres.
    steps : int
        Number of cross-sections.
    """
    given = np.asarray(outline, dtype=np.float64)
    reach = np.linspace(given[0, 0], given[-1, 0], steps)
    width = PchipInterpolator(given[:, 0], given[:, 1])(reach)
    share = (reach - reach[0]) / np.ptp(reach)
    spine = np.column_stack([reach, 0 * reach, -4 * sag * share * (1 - share)])
    return sweep(spine, [superellipse(w, thickness, 9, 24) for w in width], side=(0, 1, 0))


def rounded_box(size: ArrayLike, edge: float) -> Mesh:
    """Return a box standing on z = 0 about the z axis, all edges rounded by about `edge` metres."""
    length, width, height = np.asarray(size, dtype=np.float64)
    turn = np.linspace(0, np.pi / 2, 5)
    inset = edge * (1 - np.sin(turn))
    lift = edge * (1 - np.cos(turn))
    corner = np.linspace(0, np.pi / 2, 5)
    rings = []
    for gap, z in zip(
        np.concatenate([inset, inset[::-1]]),
        np.concatenate([lift, height - lift[::-1]]),
        strict=True,
    ):
        radius = max(edge - gap, 0.15 * edge)
        at = np.array([length / 2 - gap - radius, width / 2 - gap - radius])
        arc = radius * np.column_stack([np.cos(corner), np.sin(corner)])
        flat = np.vstack(
            [
                arc + at,
                (arc @ [[0, 1], [-1, 0]]) + at * [-1, 1],
                -arc - at,
                (arc @ [[0, -1], [1, 0]]) + at * [1, -1],
            ]
        )
        rings.append(np.column_stack([flat, np.full(len(flat), z)]))
    return loft(rings)


def ring(centre: ArrayLike, radii: tuple[float, float], thickness: tuple[float, float]) -> Mesh:
    """Return an elliptic ring in the x-y plane, e.g. for a finger.

    Parameters
    ----------
    centre : (3,) array_like
        Metres.
    radii : tuple of float
        Of the middle line along x and y.
    thickness : tuple of float
        Of the rod along z and in the plane.
    """
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    spine = np.column_stack([radii[0] * np.cos(angle), radii[1] * np.sin(angle), 0 * angle])
    rod = superellipse(thickness[0], thickness[1], 2.3, 16)
    return moved(sweep(spine, [rod] * len(angle), side=(0, 0, 1), closed=True), centre)
