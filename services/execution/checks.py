"""What a request must satisfy before it is worth a simulation; cheap, NumPy only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shared.errors import InvalidInput, PayloadTooLarge, UnknownGripper, WrongUnits
from shared.grippers import choose_gripper
from shared.schemas.execution import ExecuteRequest
from shared.schemas.gripper import ParallelGripper, SuctionGripper

ARMED = "panda"
"""The gripper that comes with an arm here."""
MAX_FACES = 100_000
MAX_POINTS = 1_000_000
SIZE_RANGE = (0.004, 1.5)
"""Metres: the largest extent that an object may have."""
MILLIMETRES_FROM = 10.0
"""An extent from here on, in metres, reads as millimetres."""
EXPONENT_RANGE = (0.05, 2.0)
"""Exponents of a superquadric that is convex and has a finite mesh."""
FURTHEST = 1e4
"""Metres: no coordinate lies beyond."""


AnyGripper = ParallelGripper | SuctionGripper


def check_request(request: ExecuteRequest, grippers: Mapping[str, AnyGripper]) -> AnyGripper:
    """Return the gripper of a request; raise when it makes no sense as an execution.

    Raises
    ------
    UnknownGripper
        There is no such gripper, or none of that name with an arm.
    InvalidInput, WrongUnits, PayloadTooLarge
        Says which field, what was found, what is allowed.
    """
    gripper = choose_gripper(grippers, request.gripper)
    if request.actor == "arm" and request.gripper != ARMED:
        raise UnknownGripper(
            f"gripper {request.gripper!r} has no arm here, only {ARMED!r} has; "
            "actor 'hand' takes any gripper",
            field="gripper",
            found=request.gripper,
            allowed=[ARMED],
        )
    _check_near("pose.position", np.array(request.pose.position))
    if request.object_pose is not None:
        _check_near("object_pose.position", np.array(request.object_pose.position))
    if request.plane is not None:
        _check_near("plane.offset", np.array([request.plane.offset]))
    if request.vertices is not None and request.faces is not None:
        _check_mesh(request.vertices, request.faces)
    else:
        _check_primitives(request.primitives)
    if request.points is not None:
        _check_near("points", request.points)
        if len(request.points) > MAX_POINTS:
            raise PayloadTooLarge(
                f"points has {len(request.points)} rows; allowed are {MAX_POINTS}",
                field="points",
                found=len(request.points),
                allowed=MAX_POINTS,
            )
    return gripper


def _check_mesh(vertices: NDArray[Any], faces: NDArray[Any]) -> None:
    if len(faces) > MAX_FACES:
        raise PayloadTooLarge(
            f"the mesh has {len(faces)} faces, allowed are {MAX_FACES}: simplify it first",
            field="faces",
            found=len(faces),
            allowed=MAX_FACES,
        )
    used = vertices[np.unique(faces)]
    _check_near("vertices", used)
    _check_size("vertices", float(np.ptp(used, axis=0).max()))


def _check_primitives(primitives: Sequence[Sequence[float]]) -> None:
    low, high = EXPONENT_RANGE
    for index, vector in enumerate(primitives):
        field = f"primitives.{index}"
        e1, e2, a1, a2, a3 = vector[:5]
        if not (low <= min(e1, e2) and max(e1, e2) <= high):
            raise InvalidInput(
                f"{field} has exponents {e1:g} and {e2:g}, allowed are {low}..{high}",
                field=field,
                found=[e1, e2],
                allowed=list(EXPONENT_RANGE),
            )
        if min(a1, a2, a3) <= 0:
            raise InvalidInput(
                f"{field} has semi-axes {a1:g}, {a2:g}, {a3:g}; all must be positive",
                field=field,
                found=[a1, a2, a3],
            )
        _check_near(field, np.array(vector[5:8]))
        _check_direction(field, vector[8:])
        _check_size(field, 2 * max(a1, a2, a3))
    centres = np.array([vector[5:8] for vector in primitives])
    _check_size("primitives", float(np.ptp(centres, axis=0).max()), smallest=0.0)


def _check_size(field: str, extent: float, smallest: float = SIZE_RANGE[0]) -> None:
    if smallest <= extent <= SIZE_RANGE[1]:
        return
    kind, hint = InvalidInput, ""
    if extent >= MILLIMETRES_FROM:
        kind, hint = WrongUnits, "; that looks like millimetres, send metres"
    raise kind(
        f"{field} span {extent:.4g} m, allowed are {smallest}..{SIZE_RANGE[1]} m{hint}",
        field=field,
        found=extent,
        allowed=[smallest, SIZE_RANGE[1]],
    )


def _check_near(field: str, coordinates: NDArray[Any]) -> None:
    largest = float(np.abs(coordinates).max())
    if largest > FURTHEST:
        raise InvalidInput(
            f"{field} holds the coordinate {largest:.4g} m, allowed are up to {FURTHEST:g} m",
            field=field,
            found=largest,
            allowed=FURTHEST,
        )


def _check_direction(field: str, vector: Sequence[float]) -> None:
    length = float(np.linalg.norm(np.clip(vector, -FURTHEST, FURTHEST)))
    if length < 1e-6:
        raise InvalidInput(f"{field} has length {length:g}, it must not be zero", field=field)
