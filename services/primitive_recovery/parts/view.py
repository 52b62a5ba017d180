"""What the cuts of an object are judged by, gathered once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.hidden import Hidden, bridges, fillings, hidden_by
from services.primitive_recovery.parts.projection import Projection, projected
from services.primitive_recovery.parts.silhouette import Silhouette, silhouette, spacing
from services.primitive_recovery.points import farthest, third_moments
from shared.geometry.passes import about_mean
from shared.geometry.rotation import unit
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PartView:
    """Points of an object, or of a piece of it, as the sensor saw them.

    Attributes
    ----------
    points : (N, 3) array
        Metres.
    viewpoint : (3,) array
        Where the sensor was.
    middle : (3,) array
        Mean of the points.
    centred : (N, 3) array
        The points about it.
    ray : (3,) array
        Unit vector from the sensor to that mean.
    axes : (3, 3) array
        Rows: principal axes, longest first.
    depth : (N,) array
        Along the mean ray, from the sensor; from the mean without one. Metres.
    height : (N,) array
        Above the support plane; towards the sensor where there is none. Metres.
    up : (3,) array or None
        Unit normal of the support plane.
    picture : Silhouette
        Of the points.
    seen_by : Projection
        Into the picture.
    hidden : Hidden
        Cells of the picture where other things hide what is behind them.
    spacing : float
        About how far neighbouring points are apart, metres.
    amid : bool
        The viewpoint lies among the points, so that they show all sides.
    is_piece : bool
        Whether this is a part already, cut from a larger object. Of what stands on a
        table most has more than one part; of what was cut from it little has.
    """

    points: Array
    viewpoint: Array
    middle: Array
    centred: Array
    ray: Array
    axes: Array
    depth: Array
    height: Array
    up: Array | None
    picture: Silhouette
    seen_by: Projection
    hidden: Hidden
    spacing: float
    amid: bool
    is_piece: bool

    @property
    def nearness(self) -> Array:
        """Return how far towards the sensor each point (N,) lies, metres."""
        return -(self.centred @ self.ray)

    def bridges(self) -> Array:
        """Return points (B, 3) where the object goes on behind what hides it, metres."""
        return self.middle + bridges(self.hidden, self.picture, self.seen_by, self.depth)

    def fillings(self) -> list[Array]:
        """Return points (F, 3) where a simple object would go on, in several ways, metres."""
        return [self.middle + way for way in fillings(self.hidden, self.picture, self.seen_by)]


def part_view(
    points: Array,
    viewpoint: Array,
    plane: SupportPlane | None,
    *,
    others: Array | None = None,
    is_piece: bool = False,
) -> PartView:
    """Return the view of points (N, 3) from a viewpoint (3,), above a plane if there is one.

    `others` (M, 3) are points of other things, which may hide some of the object.
    """
    middle, centred = about_mean(points)
    axes = principal_axes(centred)
    ahead = middle - viewpoint
    amid = float(np.linalg.norm(ahead)) <= farthest(centred)
    ray = axes[2] if amid else unit(ahead)
    eye = None if amid else viewpoint - middle
    seen_by, flat, depth = projected(centred, eye, ray, axes[0])
    apart = spacing(flat)
    picture = silhouette(flat, apart, seen_by.metres)
    up = None
    if plane is None:
        height = -(centred @ ray)
        height = height - height.min()
    else:
        up = unit(plane.normal)
        height = points @ up + plane.offset
    return PartView(
        points=points,
        viewpoint=viewpoint,
        middle=middle,
        centred=centred,
        ray=ray,
        axes=axes,
        depth=depth,
        height=height,
        up=up,
        picture=picture,
        seen_by=seen_by,
        hidden=hidden_by(None if others is None else others - middle, picture, seen_by, depth),
        spacing=apart * seen_by.metres,
        amid=amid,
        is_piece=is_piece,
    )


def principal_axes(centred: Array) -> Array:
    """Return the principal axes (3, 3) of points (N, 3) about their mean as rows, longest first.

    Each points to where the points reach farther, by the third moment, so that
    the axes move with the points.
    """
    axes = np.linalg.eigh(centred.T @ centred)[1][:, ::-1].T
    backward = third_moments(centred @ axes.T) < 0
    return np.asarray(np.where(backward, -1.0, 1.0)[:, None] * axes)
