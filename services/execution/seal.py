"""Whether a suction cup seals on a surface, and what pulls it off again."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shared.schemas.gripper import SuctionGripper

Array = NDArray[np.float64]

RIM_SAMPLES = 32
RUBBER_FRICTION = 0.5
"""Of a cup on most surfaces (Mahler et al., Dex-Net 3.0, 2018)."""


class Seal(NamedTuple):
    """What the lip finds.

    Attributes
    ----------
    sealed : bool
    message : str
        Why not, with numbers.
    """

    sealed: bool
    message: str


def seal(gripper: SuctionGripper, triangles: Array) -> Seal:
    """Return whether the lip closes all round on triangles (T, 3, 3) in the grasp frame, metres.

    The rim is projected along +z. It seals when it meets the surface everywhere, the
    heights differ by no more than the compliance of the lip, and none lies further from
    the lip than the compliance.
    """
    turn = np.linspace(0, 2 * np.pi, RIM_SAMPLES, endpoint=False)
    rim = gripper.cup_diameter / 2 * np.column_stack([np.cos(turn), np.sin(turn)])
    heights = first_heights(rim, triangles, above=-gripper.cup_length)
    open_share = float(np.isinf(heights).mean())
    if open_share:
        return Seal(False, f"{100 * open_share:.0f} % of the lip meet no surface")
    uneven = float(np.ptp(heights))
    if uneven > gripper.compliance:
        return Seal(
            False,
            f"the surface under the lip varies by {1000 * uneven:.1f} mm in height, "
            f"the cup follows {1000 * gripper.compliance:.1f} mm",
        )
    gap = float(heights.max())
    if gap > gripper.compliance:
        return Seal(False, f"the surface lies {1000 * gap:.1f} mm before the lip")
    return Seal(True, "")


def first_heights(points: Array, triangles: Array, above: float) -> Array:
    """Return where rays along +z first meet triangles, from height `above` on.

    Parameters
    ----------
    points : (P, 2) array
        x, y of the rays.
    triangles : (T, 3, 3) array
    above : float

    Returns
    -------
    (P,) array
        Heights z, inf where a ray meets nothing.
    """
    a, b, c = np.moveaxis(triangles, 1, 0)
    ab, ac = b[:, :2] - a[:, :2], c[:, :2] - a[:, :2]
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    facing = np.abs(area) > 1e-14
    a, b, c, ab, ac, area = (each[facing] for each in (a, b, c, ab, ac, area))
    way = points[:, None] - a[None, :, :2]
    u = (way[..., 0] * ac[:, 1] - way[..., 1] * ac[:, 0]) / area
    v = (ab[:, 0] * way[..., 1] - ab[:, 1] * way[..., 0]) / area
    height = a[:, 2] + u * (b - a)[:, 2] + v * (c - a)[:, 2]
    inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (height >= above)
    return np.asarray(np.where(inside, height, np.inf).min(axis=1, initial=np.inf))


def pulled_off(gripper: SuctionGripper, force: Array, moment: Array) -> str | None:
    """Return what a load does to a sealed cup, or None when it holds.

    The vacuum presses the lip on the surface with V, a pull p leaves N = V - p. Along a
    ring of radius r that carries N and a bending moment M the line load is
    N / (2 pi r) + M cos(t) / (pi r^2); it vanishes at one side, and air gets in, when
    M = N r / 2. Sideways and about its axis the lip holds by friction: mu N and mu N r
    (the limits of Mahler et al. 2018, without their factors for a pyramid).

    Parameters
    ----------
    force, moment : (3,) arrays
        Of the cup on the object about the tool centre point, in the grasp frame; N, N m.
    """
    radius = gripper.cup_diameter / 2
    pull = -float(force[2])
    left = gripper.force - pull
    if left <= 0:
        return f"a pull of {pull:.1f} N, more than its {gripper.force:g} N"
    peel = float(np.hypot(moment[0], moment[1]))
    if peel > left * radius / 2:
        return f"a peeling moment of {peel:.2f} N m, more than {left * radius / 2:.2f} N m"
    aside = float(np.hypot(force[0], force[1]))
    if aside > RUBBER_FRICTION * left:
        return f"a sideways force of {aside:.1f} N, more than {RUBBER_FRICTION * left:.1f} N"
    if abs(moment[2]) > RUBBER_FRICTION * left * radius:
        return f"a twist of {abs(float(moment[2])):.2f} N m"
    return None
