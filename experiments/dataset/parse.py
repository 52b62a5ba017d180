"""From the arrays of a file to a view, trusting nothing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.camera.render import FIRST_REGION
from experiments.dataset.view import MAX_TASKS, LabelledView
from shared.errors import InvalidInput

Array = NDArray[np.float64]

_RIGID_TOLERANCE = 1e-3


def view_from_arrays(object_name: str, number: int, arrays: Mapping[str, Any]) -> LabelledView:
    """Return the view that these arrays hold; `regions` may be missing.

    Raises
    ------
    InvalidInput
        An array is missing, of the wrong type or shape, or contradicts another.
    """
    depth = _array(arrays, "depth", np.uint16, (None, None))
    label = _array(arrays, "label", np.uint8, depth.shape)
    tasks = _tasks(arrays)
    intrinsics = _array(arrays, "K", np.floating, (3, 3)).astype(np.float64)
    if not (intrinsics[0, 0] > 0 and intrinsics[1, 1] > 0):
        raise InvalidInput("array 'K' has focal lengths that are not positive")
    if label.max(initial=0) > FIRST_REGION + len(tasks):
        raise InvalidInput(
            f"array 'label' goes up to {label.max()}, with {len(tasks)} tasks "
            f"at most {FIRST_REGION + len(tasks)} is allowed"
        )
    return LabelledView(
        object_name=object_name,
        number=number,
        depth=depth,
        label=label,
        intrinsics=intrinsics,
        tasks=tasks,
        regions=_regions(arrays, label, len(tasks)),
        camera_from_object=_pose(arrays, "T_cam_obj"),
        camera_from_world=_pose(arrays, "T_cam_world"),
        table_height=float(_array(arrays, "table_height", np.floating, ())),
    )


def _array(
    arrays: Mapping[str, Any], name: str, kind: Any, shape: tuple[int | None, ...]
) -> NDArray[Any]:
    if name not in arrays:
        raise InvalidInput(f"array {name!r} is missing; there are {sorted(arrays)}")
    value = np.asarray(arrays[name])
    if not np.issubdtype(value.dtype, kind):
        raise InvalidInput(f"array {name!r} is {value.dtype}, it should be {kind.__name__}")
    matches = value.ndim == len(shape) and all(
        wanted in (None, found) for wanted, found in zip(shape, value.shape, strict=True)
    )
    if not matches or 0 in value.shape:
        wanted_shape = tuple("any" if each is None else each for each in shape)
        raise InvalidInput(f"array {name!r} has shape {value.shape}, it should be {wanted_shape}")
    if np.issubdtype(value.dtype, np.floating) and not np.isfinite(value).all():
        raise InvalidInput(f"array {name!r} holds NaN or infinity")
    return value


def _tasks(arrays: Mapping[str, Any]) -> tuple[str, ...]:
    if "tasks" not in arrays:
        raise InvalidInput(f"array 'tasks' is missing; there are {sorted(arrays)}")
    value = np.asarray(arrays["tasks"])
    if value.dtype.kind != "U" or value.ndim != 1:
        raise InvalidInput(f"array 'tasks' is {value.dtype} {value.shape}, it should be strings")
    tasks = tuple(str(task) for task in value)
    if len(set(tasks)) < len(tasks) or "" in tasks or len(tasks) > MAX_TASKS:
        raise InvalidInput(f"array 'tasks' holds empty, repeated or too many names: {tasks[:20]}")
    return tasks


def _regions(arrays: Mapping[str, Any], label: NDArray[np.uint8], count: int) -> NDArray[np.bool_]:
    of_label = label == np.arange(FIRST_REGION, FIRST_REGION + count)[:, None, None]
    if "regions" not in arrays:
        return np.asarray(of_label)
    value = np.asarray(arrays["regions"])
    height, width = label.shape
    wanted = (count, height, -(-width // 8))
    if value.dtype != np.uint8 or value.shape != wanted:
        raise InvalidInput(
            f"array 'regions' is {value.dtype} {value.shape}, it should be uint8 {wanted}"
        )
    regions = np.unpackbits(value, axis=-1, count=width).astype(bool)
    if (of_label & ~regions).any() or (regions & (label < FIRST_REGION)).any():
        raise InvalidInput("arrays 'regions' and 'label' contradict each other")
    return np.asarray(regions)


def _pose(arrays: Mapping[str, Any], name: str) -> Array:
    pose = _array(arrays, name, np.floating, (4, 4)).astype(np.float64)
    rotation = pose[:3, :3]
    rigid = np.allclose(rotation @ rotation.T, np.eye(3), atol=_RIGID_TOLERANCE)
    upright = np.allclose(pose[3], [0, 0, 0, 1], atol=_RIGID_TOLERANCE)
    if not (rigid and upright and np.linalg.det(rotation) > 0):
        raise InvalidInput(f"array {name!r} is not a rigid motion")
    return pose
