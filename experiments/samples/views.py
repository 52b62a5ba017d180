"""Which views are bundled, and how each is made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.camera import (
    D435,
    HeadCamera,
    StereoNoise,
    Table,
    label_image,
    place_on,
    render,
)
from experiments.catalogue import build, resting_pose
from shared.geometry.se3 import inverse

Arrays = dict[str, NDArray[Any]]

FOLDER = Path(__file__).parent
DEPTH_SCALE = 1e-4
"""Metres per unit of the depth images."""


@dataclass(frozen=True)
class SampleView:
    """How an object lies before the camera.

    Attributes
    ----------
    object_name : str
        In the catalogue.
    up : tuple of float
        About which direction of the object's frame points up; the nearest
        stable orientation is taken.
    position : tuple of float
        Where on the table its centre of mass is, (x, y) in metres.
    yaw_deg : float
        Turn about the vertical.
    seed : int
        Of the noise.
    """

    object_name: str
    up: tuple[float, float, float]
    yaw_deg: float
    position: tuple[float, float] = (0.65, 0.0)
    seed: int = 0


SAMPLES: Mapping[str, SampleView] = MappingProxyType(
    {
        "saucepan": SampleView("saucepan", up=(0, 0, 1), yaw_deg=205),
        "hammer": SampleView("hammer", up=(0, 0, 1), yaw_deg=60),
        "bottle": SampleView("bottle", up=(1, 0, 0), yaw_deg=155),
        "spatula": SampleView("spatula", up=(0, 0, 1), yaw_deg=50),
        "ladle": SampleView("ladle", up=(-1, 0, 0), yaw_deg=60),
    }
)


def make_view(sample: SampleView) -> tuple[Arrays, Arrays]:
    """Return the view's arrays and, apart from them, its truth.

    The view holds what a camera gives: `depth` (H, W) uint16, `intrinsics`
    (3, 3), `depth_scale`. The truth holds `label` (H, W) uint8 (0 background or
    no return, 1 table, 2 + i the part to hold for task i), `tasks`,
    `camera_from_object` and `camera_from_world` (4, 4).
    """
    thing, table, head = build(sample.object_name), Table(), HeadCamera()
    world_from_object = place_on(
        table,
        thing,
        resting_pose(thing, sample.up),
        position=sample.position,
        yaw_deg=sample.yaw_deg,
    )
    ideal = render(thing, world_from_object, table, D435, head.world_from_camera)
    noisy = StereoNoise().apply(ideal.depth, np.random.default_rng(sample.seed))
    depth = np.round(noisy / DEPTH_SCALE).astype(np.uint16)
    camera_from_world = inverse(head.world_from_camera)
    view: Arrays = {
        "depth": depth,
        "intrinsics": D435.intrinsics,
        "depth_scale": np.array(DEPTH_SCALE),
    }
    truth: Arrays = {
        "label": np.where(depth > 0, label_image(thing, ideal), np.uint8(0)),
        "tasks": np.array(thing.tasks),
        "camera_from_object": camera_from_world @ world_from_object,
        "camera_from_world": camera_from_world,
    }
    return view, truth
