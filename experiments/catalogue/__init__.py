"""Everyday objects as watertight parametric meshes whose parts are known by construction."""

from experiments.catalogue.model import CatalogueObject, Part
from experiments.catalogue.objects import CATALOGUE, build
from experiments.catalogue.resting import RestingPose, resting_pose, resting_poses

__all__ = [
    "CATALOGUE",
    "CatalogueObject",
    "Part",
    "RestingPose",
    "build",
    "resting_pose",
    "resting_poses",
]
