"""Inverse kinematics of the arm: damped least squares that prefers the rest posture."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.execution.arm import HOME, Arm

Array = NDArray[np.float64]

MAX_POSITION_ERROR = 0.002
MAX_ANGLE_ERROR = np.radians(1.0)
ITERATIONS = 60
PATIENCE = 8
"""Iterations without a tenth's progress before a start is given up."""
DAMPING = 0.1
"""Times the error: bold steps close to the goal, cautious ones near singular postures."""
MAX_STEP = 0.35
"""Radians that a joint may turn per iteration."""
REST_PULL = 0.3
SAME = 0.1
"""Radians: closer postures count as one."""
REACH = 1.15
"""Metres: from the shoulder, the tool centre point never gets further."""
SHOULDER = np.array([0.0, 0.0, 0.333])


def pose_error(base_from_goal: Array, base_from_grasp: Array) -> Array:
    """Return the error (6,): metres over radians, base axes, from the pose to the goal."""
    turn = base_from_goal[:3, :3] @ base_from_grasp[:3, :3].T
    shift = base_from_goal[:3, 3] - base_from_grasp[:3, 3]
    return np.concatenate([shift, Rotation.from_matrix(turn).as_rotvec()])


def is_reached(error: Array) -> bool:
    """Whether a pose error (6,) is below 2 mm and 1 degree."""
    return bool(
        np.linalg.norm(error[:3]) < MAX_POSITION_ERROR
        and np.linalg.norm(error[3:]) < MAX_ANGLE_ERROR
    )


def solve(arm: Arm, base_from_goal: Array, start: Array) -> Array | None:
    """Return joints (7,) within their limits that reach a pose, or None.

    Damped least squares (Wampler 1986) with a pull towards `HOME` in the null
    space; a step that leaves the limits is clipped. PyBullet's own solver, with
    its null-space option, misses most reachable poses (docs/decisions/0006-execution.md);
    only its Jacobian and its forward kinematics are used.

    Parameters
    ----------
    arm : Arm
    base_from_goal : (4, 4) array
        Goal of the grasp frame, in the robot base's frame.
    start : (7,) array
        Where the search starts.
    """
    joints = np.clip(start, arm.lower, arm.upper)
    best, stuck = np.inf, 0
    for _ in range(ITERATIONS):
        error = pose_error(base_from_goal, arm.base_from_grasp(joints))
        if np.linalg.norm(error[:3]) < 2e-4 and np.linalg.norm(error[3:]) < 2e-3:
            return joints
        size = float(np.linalg.norm(error))
        stuck = 0 if size < 0.9 * best else stuck + 1
        best = min(best, size)
        if stuck > PATIENCE:
            break
        size = min(1.0, size)
        jacobian = arm.jacobian(joints)
        pull = REST_PULL * size * (HOME - joints)
        damped = jacobian @ jacobian.T + (DAMPING * size) ** 2 * np.eye(6)
        step = pull + jacobian.T @ np.linalg.solve(damped, error - jacobian @ pull)
        step *= min(1.0, MAX_STEP / max(float(np.abs(step).max()), 1e-12))
        joints = np.clip(joints + step, arm.lower, arm.upper)
    return joints if is_reached(pose_error(base_from_goal, arm.base_from_grasp(joints))) else None


def solutions(arm: Arm, base_from_goal: Array) -> Iterator[Array]:
    """Yield the different solutions that several starting postures lead to; maybe none."""
    if np.linalg.norm(base_from_goal[:3, 3] - SHOULDER) > REACH:
        return
    known: list[Array] = []
    heading = float(np.arctan2(base_from_goal[1, 3], base_from_goal[0, 3]))
    for elbow, wrist in ((0.0, 0.0), (0.0, np.pi / 2), (0.0, -np.pi / 2), (0.8, 0.0), (-0.8, 0.0)):
        start = HOME.copy()
        start[0] += heading - elbow
        start[2] += elbow
        start[6] += wrist
        joints = solve(arm, base_from_goal, start)
        if joints is None or any(np.abs(joints - other).max() < SAME for other in known):
            continue
        known.append(joints)
        yield joints


def straight_line(arm: Arm, base_from_goals: list[Array], start: Array) -> Array | None:
    """Return joints (K, 7) through closely spaced poses, or None where the arm cannot follow.

    A jump between neighbours, which would leave the line, counts as not following.
    """
    path = [start]
    for goal in base_from_goals:
        joints = solve(arm, goal, path[-1])
        if joints is None or np.abs(joints - path[-1]).max() > MAX_STEP:
            return None
        path.append(joints)
    return np.array(path[1:])
