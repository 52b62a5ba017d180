"""From the request's frame to a world with gravity along -z and the table top at z = 0.

The world depends on the grasp, the object and the up direction only, never on
the request's axes: the same scene seen from elsewhere gives the same world.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.execution.believed import completed
from services.execution.convex import ConvexPart
from services.execution.decomposition import parts_of_mesh, parts_of_primitives
from services.execution.waypoints import LEFT
from shared.errors import InvalidInput
from shared.geometry.rotation import frame_from_z, unit
from shared.geometry.se3 import inverse, matrix_from_pose, pose_matrix
from shared.schemas.execution import ExecuteRequest

Array = NDArray[np.float64]

DIP = 0.002
"""Metres below the table from which an object is raised: no plane is known better."""
STEEP = 0.3
"""Below this horizontal share of the approach direction, a grasp comes from above."""
LEVEL = 1e-3
"""Below this horizontal share a direction heads nowhere."""


@dataclass(frozen=True)
class Scene:
    """A grasp on an object that stands on the plane z = 0, its centre above the origin.

    Attributes
    ----------
    world_from_mesh : (4, 4) array
        From the frame that the request gives the mesh in.
    world_from_grasp : (4, 4) array
        Its approach (+z) has no component along world y, unless it is nearly vertical.
    width : float
        Opening that the grasp needs, metres.
    parts : tuple of ConvexPart
        The object in the world's frame, nothing of it below z = 0.
    side : (3,) array
        Level, of length 1: to the left of who looks along the request's `heading`, or world y.
    raised : float
        How far it was raised for that, metres.
    """

    world_from_mesh: Array
    world_from_grasp: Array
    width: float
    parts: tuple[ConvexPart, ...]
    side: Array
    raised: float = 0.0


def scene_from_request(request: ExecuteRequest) -> Scene:
    """Build the world of a checked request.

    Without a plane, the table stands right under the object's lowest point. What
    dips below the plane (a primitive recovered from one view often does) is cut off.

    Raises
    ------
    DegenerateCloud
        The object spans no volume.
    InvalidInput
        The whole object lies below the plane.
    """
    if request.vertices is not None and request.faces is not None:
        parts = parts_of_mesh(request.vertices, request.faces)
    else:
        parts = _believed(request)
    frame_from_mesh = np.eye(4)
    if request.object_pose is not None:
        place = request.object_pose
        frame_from_mesh = matrix_from_pose(place.position, place.quaternion)
        parts = [part.moved(frame_from_mesh) for part in parts]
    frame_from_grasp = matrix_from_pose(request.pose.position, request.pose.quaternion)
    world_from_frame = _world_from_frame(request, frame_from_grasp, parts)
    solid, raised = _standing([part.moved(world_from_frame) for part in parts])
    if not solid:
        raise InvalidInput(
            "the object lies below the support plane: does plane.normal point to the objects?",
            field="plane",
        )
    return Scene(
        world_from_frame @ frame_from_mesh,
        world_from_frame @ frame_from_grasp,
        request.width,
        solid,
        _side(request, world_from_frame),
        raised,
    )


def _believed(request: ExecuteRequest) -> list[ConvexPart]:
    """Return the parts of an object of which there are primitives, and maybe points."""
    parts: list[ConvexPart] = []
    if request.points is not None and request.believed == "reflected":
        viewpoint = np.array(request.viewpoint)
        parts = completed(request.points, request.primitives, viewpoint)
    return parts or parts_of_primitives(request.primitives)


def _side(request: ExecuteRequest, world_from_frame: Array) -> Array:
    """Return the left of who looks along the heading; of one that is vertical there is none."""
    if request.heading is None:
        return LEFT
    heading = world_from_frame[:3, :3] @ unit(request.heading)
    level = float(np.hypot(heading[0], heading[1]))
    return LEFT if level < LEVEL else np.array([-heading[1], heading[0], 0.0]) / level


def _standing(parts: list[ConvexPart]) -> tuple[tuple[ConvexPart, ...], float]:
    """Return the parts above z = 0, raised as a whole when they dip a little or cut; how far."""
    dip = -min(float(part.vertices[:, 2].min()) for part in parts)
    if 0 < dip <= DIP:
        up = pose_matrix([0.0, 0.0, dip], np.eye(3))
        return tuple(part.moved(up) for part in parts), dip
    above = (part.above(0.0) for part in parts)
    return tuple(part for part in above if part is not None), 0.0


def _world_from_frame(
    request: ExecuteRequest, frame_from_grasp: Array, parts: list[ConvexPart]
) -> Array:
    vertices = np.vstack([part.vertices for part in parts])
    if request.plane is not None:
        length = float(np.linalg.norm(request.plane.normal))
        up = unit(request.plane.normal)
        ground = -request.plane.offset / length
    else:
        up = unit(request.up or (0.0, 0.0, 1.0))
        ground = float((vertices @ up).min())
    approach = frame_from_grasp[:3, 2]
    horizontal = approach - up * (approach @ up)
    slanted = np.linalg.norm(horizontal) > STEEP
    heading = horizontal if slanted else frame_from_grasp[:3, 0]
    axes = frame_from_z(up, heading)
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    return inverse(pose_matrix(middle + up * (ground - middle @ up), axes))
