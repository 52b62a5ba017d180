"""Random objects on a table, as a camera of random noise sees them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import open3d as o3d
from numpy.typing import NDArray

from experiments.camera import StereoNoise
from experiments.catalogue import CLASSES, CatalogueObject, variant
from experiments.catalogue.bottles import any_sauce_bottle
from experiments.catalogue.mass import mass_properties, solid_properties
from experiments.dataset.drop import Body
from experiments.dataset.make import make_view
from experiments.dataset.randomness import generator
from experiments.framework import ShownView
from experiments.parts.warp import warped

Array = NDArray[np.float64]

SAUCE_BOTTLE = "sauce_bottle"
PER_ROUND = {**dict.fromkeys(CLASSES, 1), "box": 2, SAUCE_BOTTLE: 6}
"""How many objects of each kind a round of trials has: every class of the catalogue's variants,
boxes twice, whose edges are all that is narrow enough and never hold, and bottles that are asked
about for their caps, where weight, lever and shoulders decide (0020)."""
ROUND = sum(PER_ROUND.values())
"""Objects of a round."""
PLAIN = 0.4
"""Share of objects that are not warped."""
CLEAN = 0.35
"""Share of views without noise."""
TRIANGLES = 1500
"""Of the mesh that is executed: finer ones are merely slower to cut into convex parts."""
LIGHT = 400.0
"""kg/m3: what POST /execute takes things for that it knows nothing about."""
MASSES = (0.05, 0.6)
"""Kilograms: the range of POST /execute; a hand of 20 N lifts little more."""
SIGMA_AT_1M = (0.5e-3, 2.5e-3)
"""Metres: from which the noise of the depth at 1 m is drawn."""


@dataclass(frozen=True)
class Scene:
    """An object before the camera.

    Attributes
    ----------
    thing : CatalogueObject
    view : int
        Which view of it.
    shown : ShownView
        What the camera sees.
    vertices : (V, 3) array
        The object's true mesh, metres, in its own frame.
    faces : (F, 3) int32 array
        Its triangles, at most `TRIANGLES`.
    mass : float
        Kilograms.
    sigma_at_1m : float
        Of the sensor's noise, metres; 0: a clean view.
    """

    thing: CatalogueObject
    view: int
    shown: ShownView
    vertices: Array
    faces: NDArray[np.int32]
    mass: float
    sigma_at_1m: float


def draw_object(kind: str, number: int, seed: int) -> CatalogueObject:
    """Return object `number` of a kind of `PER_ROUND`; it depends on the three arguments alone."""
    rng = generator(seed, f"object to try grasps on: {kind}", number)
    thing = _capped(rng) if kind == SAUCE_BOTTLE else variant(kind, rng)
    if rng.random() > PLAIN:
        thing = warped(thing, rng)
    return replace(thing, name=f"{kind}-{number}")


def _capped(rng: np.random.Generator) -> CatalogueObject:
    """Return a bottle of which only the cap is asked for; others teach bodies."""
    thing = any_sauce_bottle(rng)
    return replace(thing, class_name=SAUCE_BOTTLE, regions={"handover": ("cap",)})


def draw_scene(body: Body, view: int, seed: int) -> Scene:
    """Return view `view` of an object on a table.

    Raises
    ------
    InvalidInput
        The object was warped out of what fits into the view.
    """
    thing = body.thing
    shown = make_view(body, view, seed)
    rng = generator(seed, f"sensor before {thing.name}", view)
    sigma = 0.0 if rng.random() < CLEAN else float(rng.uniform(*SIGMA_AT_1M))
    if sigma > 0:
        correlation = float(rng.choice([0.0, 1.5]))
        noise = StereoNoise(sigma_at_1m=sigma, correlation_px=correlation)
        shown = shown.with_noise(noise, rng)
    vertices, faces = simplified(thing)
    return Scene(
        thing=thing,
        view=view,
        shown=ShownView(shown),
        vertices=vertices,
        faces=faces,
        mass=draw_mass(thing, generator(seed, f"mass of {thing.name}", view)),
        sigma_at_1m=sigma,
    )


def draw_mass(thing: CatalogueObject, rng: np.random.Generator) -> float:
    """Return a mass in kilograms, log-uniform between a light guess and the truth.

    A camera sees no density: a pan of sheet steel weighs ten times its volume of wood, and
    the scorer has to learn grasps that hold either. Within `MASSES`, as all trials are.
    """
    meshes = [mesh for part in thing.parts for mesh in part.meshes]
    light = solid_properties(meshes, [LIGHT] * len(meshes)).mass
    low, high = np.clip(sorted([light, mass_properties(thing).mass]), *MASSES)
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def simplified(thing: CatalogueObject) -> tuple[Array, NDArray[np.int32]]:
    """Return an object's surface as vertices (V, 3) and at most about `TRIANGLES` faces (F, 3)."""
    surface = thing.surface
    if len(surface.faces) <= TRIANGLES:
        return surface.vertices, surface.faces
    mesh = o3d.geometry.TriangleMesh(
        o3d.utility.Vector3dVector(np.array(surface.vertices)),
        o3d.utility.Vector3iVector(np.array(surface.faces)),
    ).simplify_quadric_decimation(TRIANGLES)
    return np.asarray(mesh.vertices), np.asarray(mesh.triangles).astype(np.int32)
