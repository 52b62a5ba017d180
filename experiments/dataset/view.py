"""A labelled view, and the arrays that it is on disk (docs/dataset.md)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.camera import StereoNoise
from experiments.camera.render import BACKGROUND, FIRST_REGION
from shared.errors import InvalidInput

Array = NDArray[np.float64]
Arrays = dict[str, NDArray[Any]]

DEPTH_SCALE = 1e-4
"""Metres per unit of the depth images."""

MAX_TASKS = 255 - FIRST_REGION


@dataclass(frozen=True)
class LabelledView:
    """What a camera sees of one object, and what it should make of it.

    Attributes
    ----------
    object_name : str
        The object.
    number : int
        Which view of it.
    depth : (H, W) uint16 array
        Distance along the optical axis in units of `DEPTH_SCALE`; 0: no return.
    label : (H, W) uint8 array
        0 background, 1 table, 2 + i the region of `tasks[i]`, 2 + T the object
        outside all regions. Where regions overlap, the first task's label.
    intrinsics : (3, 3) array
        Pinhole matrix, pixels.
    tasks : tuple of str
        The T tasks that the object serves.
    regions : (T, H, W) bool array
        Where the region of each task is seen, overlaps and all.
    camera_from_object, camera_from_world : (4, 4) array
        Poses; the world's z is up.
    table_height : float
        Of the table top above the world's origin, metres.
    """

    object_name: str
    number: int
    depth: NDArray[np.uint16]
    label: NDArray[np.uint8]
    intrinsics: Array
    tasks: tuple[str, ...]
    regions: NDArray[np.bool_]
    camera_from_object: Array
    camera_from_world: Array
    table_height: float

    @property
    def on_object(self) -> NDArray[np.bool_]:
        """Where the object is seen (H, W)."""
        return self.label >= FIRST_REGION

    def region(self, task: str) -> NDArray[np.bool_]:
        """Return where the region of a task is seen (H, W).

        Raises
        ------
        InvalidInput
            The object does not serve this task.
        """
        if task not in self.tasks:
            raise InvalidInput(
                f"{self.object_name!r} has no region for {task!r}, it has {list(self.tasks)}",
                found=task,
                allowed=list(self.tasks),
            )
        return np.asarray(self.regions[self.tasks.index(task)])

    def with_noise(self, noise: StereoNoise, rng: np.random.Generator) -> LabelledView:
        """Return the view as a stereo camera would see it; lost pixels lose their labels."""
        noisy = noise.apply(DEPTH_SCALE * self.depth.astype(np.float64), rng)
        depth = to_depth_units(noisy)
        seen = depth > 0
        return replace(
            self,
            depth=depth,
            label=np.where(seen, self.label, np.uint8(BACKGROUND)),
            regions=self.regions & seen,
        )

    def arrays(self) -> Arrays:
        """Return the arrays that make the view's file; POST /grasp takes it as it is."""
        return {
            "depth": self.depth,
            "label": self.label,
            "regions": np.packbits(self.regions, axis=-1),
            "K": self.intrinsics,
            "intrinsics": self.intrinsics,
            "depth_scale": np.array(DEPTH_SCALE),
            "tasks": np.array(self.tasks, dtype=np.str_),
            "T_cam_obj": self.camera_from_object,
            "T_cam_world": self.camera_from_world,
            "table_height": np.array(self.table_height),
        }


def to_depth_units(depth: Array) -> NDArray[np.uint16]:
    """Return a depth image (H, W) in metres as it is stored; out of range is no return."""
    units = np.round(depth / DEPTH_SCALE)
    return np.where(units <= np.iinfo(np.uint16).max, units, 0).astype(np.uint16)
