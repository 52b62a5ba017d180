"""Everyday objects as watertight parametric meshes whose parts are known by construction."""

from experiments.catalogue.mass import MassProperties, mass_properties
from experiments.catalogue.model import CatalogueObject, Mesh, Part, Surface
from experiments.catalogue.objects import ALIASES, CATALOGUE, CLASSES, build, variant
from experiments.catalogue.resting import RestingPose, resting_pose, resting_poses

__all__ = [
    "ALIASES",
    "CATALOGUE",
    "CLASSES",
    "CatalogueObject",
    "MassProperties",
    "Mesh",
    "Part",
    "RestingPose",
    "Surface",
    "build",
    "mass_properties",
    "resting_pose",
    "resting_poses",
    "variant",
]
