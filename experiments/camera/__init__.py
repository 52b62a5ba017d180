"""A depth camera at a robot's head, looking down at one object on a table."""

from experiments.camera.noise import StereoNoise
from experiments.camera.pinhole import D435, PinholeCamera, look_at
from experiments.camera.render import Rendering, label_image, region_masks, render
from experiments.camera.scene import HeadCamera, Table, place_on

__all__ = [
    "D435",
    "HeadCamera",
    "PinholeCamera",
    "Rendering",
    "StereoNoise",
    "Table",
    "label_image",
    "look_at",
    "place_on",
    "region_masks",
    "render",
]
