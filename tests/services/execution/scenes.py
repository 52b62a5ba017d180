"""Objects standing on z = 0 and grasps on them, in any frame one likes to see them from."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.execution import protocol
from services.execution.convex import convex_hull
from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import matrix_from_pose, pose_from_matrix, pose_matrix
from shared.grippers import load_grippers
from shared.schemas.execution import ExecuteRequest, ExecuteResponse
from shared.schemas.grasp import Pose
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]
Mesh = tuple[Array, NDArray[np.int32]]

CAMERA_FROM_WORLD = pose_matrix(
    [0.1, 0.3, 0.9], Rotation.from_euler("xyz", [2.1, 0.2, -0.4]).as_matrix()
)
STANDING_SUPERQUADRIC = (0.1, 1.0, 0.03, 0.03, 0.08, 0.0, 0.0, 0.08, 0.0, 0.0, 0.0, 1.0)
"""Like a cylinder: 6 cm thick, 16 cm tall."""


def execute(asked: ExecuteRequest) -> ExecuteResponse:
    """Carry a request out with the gripper that it names."""
    return protocol.execute(asked, load_grippers()[asked.gripper])


def hull_mesh(points: Array) -> Mesh:
    part = convex_hull(points)
    assert part is not None
    return part.vertices, part.faces


def box(half: tuple[float, float, float], centre: tuple[float, float, float]) -> Mesh:
    corners = np.stack(np.meshgrid([-1, 1], [-1, 1], [-1, 1]), axis=-1).reshape(-1, 3)
    return hull_mesh(corners * np.array(half) + centre)


def cylinder(radius: float = 0.03, height: float = 0.15) -> Mesh:
    turn = np.linspace(0, 2 * np.pi, 32, endpoint=False)
    ring = np.column_stack([np.cos(turn), np.sin(turn)]) * radius
    levels = [np.column_stack([ring, np.full(len(ring), z)]) for z in (0.0, height)]
    return hull_mesh(np.vstack(levels))


def joined(*meshes: Mesh) -> Mesh:
    offsets = np.cumsum([0] + [len(vertices) for vertices, _ in meshes[:-1]])
    faces = [mesh[1] + offset for mesh, offset in zip(meshes, offsets, strict=True)]
    return np.vstack([vertices for vertices, _ in meshes]), np.vstack(faces).astype(np.int32)


def from_above(yaw: float = 0.0) -> Array:
    """Approach straight down, closing along y turned by `yaw`."""
    return np.asarray(Rotation.from_euler("z", yaw).as_matrix() @ np.diag([1.0, -1.0, -1.0]))


def from_side(yaw: float = 0.0) -> Array:
    """Approach horizontally along x turned by `yaw`, closing horizontally."""
    ahead = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    return np.asarray(Rotation.from_euler("z", yaw).as_matrix() @ ahead)


def request(
    position: tuple[float, float, float],
    rotation: Array,
    mesh: Mesh | None = None,
    primitives: tuple[tuple[float, ...], ...] = (),
    width: float = 0.06,
    seen_from: Array | None = None,
    with_plane: bool = False,
    **changes: Any,
) -> ExecuteRequest:
    """Return a request whose content is given in the world, `seen_from` a camera (4, 4)."""
    camera = np.eye(4) if seen_from is None else seen_from
    turn, shift = camera[:3, :3], camera[:3, 3]
    up = turn[:, 2]
    fields: dict[str, Any] = {
        "pose": Pose(
            position=tuple(turn @ position + shift),
            quaternion=tuple(quaternion_from_matrix(turn @ rotation)),
        ),
        "width": width,
        "primitives": tuple(_moved(vector, camera) for vector in primitives),
        "up": tuple(up),
    }
    if mesh is not None:
        fields |= {"vertices": mesh[0] @ turn.T + shift, "faces": mesh[1]}
    if with_plane:
        fields["plane"] = SupportPlane(
            normal=tuple(up), offset=float(-up @ shift), inliers=1000, residual_mm=0.5
        )
    return ExecuteRequest(**(fields | changes))


def _moved(vector: tuple[float, ...], motion: Array) -> tuple[float, ...]:
    if np.array_equal(motion, np.eye(4)):
        return vector
    pose = motion @ matrix_from_pose(vector[5:8], vector[8:])
    position, quaternion = pose_from_matrix(pose)
    return (*vector[:5], *position.tolist(), *quaternion.tolist())
