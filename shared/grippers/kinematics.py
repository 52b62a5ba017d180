"""Where a gripper's links are when its grasp frame is at a grasp, and how its joints stand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from shared.errors import InvalidInput
from shared.geometry.se3 import inverse, pose_matrix
from shared.schemas.gripper import Gripper
from shared.schemas.urdf import TCP, Link, Urdf

Matrix = NDArray[np.float64]


def choose_link(gripper: Gripper, name: str | None) -> Link:
    """Return a link of the gripper's, None: the one that MoveIt expects the pose of.

    The name `tcp` stands for the grasp frame itself.

    Raises
    ------
    InvalidInput
        There is none of that name; lists those that there are.
    """
    if name == TCP:
        return Link(name=TCP, xyz=(0.0, 0.0, 0.0))
    links = {link.name: link for link in gripper.urdf.links} if gripper.urdf else {}
    allowed = [TCP, *links]
    if name is None and links:
        return next(iter(links.values()))
    if name is None:
        raise InvalidInput(
            f"the file of the gripper {gripper.name!r} names no link (urdf.links), so only the "
            f"pose of its tool centre point is known: say pose_of={TCP}",
            field="pose_of",
            found=None,
            allowed=allowed,
        )
    if name not in links:
        raise InvalidInput(
            f"the gripper {gripper.name!r} has no link {name!r}; known are {', '.join(allowed)}",
            field="pose_of",
            found=name,
            allowed=allowed,
        )
    return links[name]


def tcp_from_link(gripper: Gripper, link: Link, opening: float) -> Matrix:
    """Return the pose (4, 4) of a link in the grasp frame, with the pads `opening` m apart.

    The pads of a linkage move forward as they close, and the grasp frame with them: it
    is between the pads where they hold.
    """
    forward = 0.0 if link.name == TCP else advance(gripper.urdf, opening)
    rotation = Rotation.from_euler("xyz", link.rpy).as_matrix()
    link_from_tcp = pose_matrix(np.asarray(link.xyz) + forward * rotation[:, 2], rotation)
    return inverse(link_from_tcp)


def advance(urdf: Urdf | None, opening: float) -> float:
    """Return by how many metres the pads are farther forward than when fully open."""
    if urdf is None or not urdf.strokes:
        return 0.0
    openings = [stroke.opening for stroke in urdf.strokes]
    return float(np.interp(opening, openings, [stroke.advance for stroke in urdf.strokes]))


def joint_positions(urdf: Urdf, opening: float) -> tuple[float, ...]:
    """Return where the joints stand with the pads `opening` metres apart."""
    if not urdf.joints:
        return ()
    openings = [stroke.opening for stroke in urdf.strokes]
    positions = np.array([stroke.positions for stroke in urdf.strokes])
    return tuple(float(np.interp(opening, openings, each)) for each in positions.T)
