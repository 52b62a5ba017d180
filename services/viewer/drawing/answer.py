"""The whole answer: cloud, parts, region, grasps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import viser
from numpy.typing import ArrayLike, NDArray

from services.viewer.drawing.camera import Stage
from services.viewer.drawing.gripper import fork_mesh, gripper_mesh
from shared.client import GraspResult
from shared.geometry.points import bounds
from shared.geometry.rotation import matrix_from_quaternion
from shared.geometry.se3 import pose_from_matrix
from shared.palette import NO_PART, REGION, TABLE, Rgb, part_colour, rgb
from shared.schemas.gripper import Gripper
from shared.schemas.primitive import Primitive
from shared.superquadric import surface_mesh

Array = NDArray[np.float64]
Wxyz = tuple[float, float, float, float]

MAX_BACKGROUND = 12_000
NEAR = 1.7
"""How much around the object is shown of what is not the object, in radii of it."""
RINGS, SEGMENTS = 24, 48
POINT_M, GLOW_M = 0.0022, 0.0042
LOW, MIDDLE, HIGH = (0.80, 0.16, 0.16), (0.95, 0.77, 0.06), (0.10, 0.62, 0.30)
"""Colours of a grasp by its score: 0, 0.5, 1."""


class Hand(NamedTuple):
    """A gripper in full, and a hint of it."""

    full: viser.MeshHandle
    hint: viser.MeshHandle


@dataclass
class Shown:
    """What was drawn, to hide or take away again.

    Attributes
    ----------
    stage : Stage
        The world that it stands in, and from where to look.
    cloud, glow, background : handle or None
        The object's points by part, those of the region, and what else the sensor saw.
    parts, labels : dict
        By the part's id.
    grasps : list
        Best first.
    """

    stage: Stage
    cloud: viser.PointCloudHandle | None = None
    glow: viser.PointCloudHandle | None = None
    background: viser.PointCloudHandle | None = None
    parts: dict[int, viser.MeshHandle] = field(default_factory=dict)
    labels: dict[int, viser.LabelHandle] = field(default_factory=dict)
    grasps: list[Hand] = field(default_factory=list)

    def choose(self, best: int | None, *, with_others: bool = True) -> None:
        """Show the grasp of this rank in full, and hints of the others; None shows none."""
        for rank, hand in enumerate(self.grasps):
            hand.full.visible = rank == best
            hand.hint.visible = best is not None and rank != best and with_others


def draw_answer(
    scene: viser.SceneApi,
    result: GraspResult,
    points: Array,
    gripper: Gripper | None,
    *,
    viewpoint: ArrayLike = (0.0, 0.0, 0.0),
    best: int = 0,
    max_grasps: int = 100,
) -> Shown:
    """Draw an answer under `/answer` of a scene, whose frame is that of the view.

    Parameters
    ----------
    scene : viser.SceneApi
        Of a server or of one client; what was under `/answer` before is replaced.
    result : GraspResult
    points : (N, 3) array
        The points that the answer speaks about, metres; a depth image's row-major.
    gripper : Gripper or None
        Drawn at every grasp; None draws none.
    viewpoint : (3,) array_like
        Position of the sensor in the view's frame.
    best : int
        Rank of the grasp that is drawn in full; of the others there is a hint.
    max_grasps : int
        No more grasps than this.
    """
    scene.remove_by_name("/answer")
    scene.set_up_direction("+z")
    stage = Stage.of(
        points[result.point_primitive >= 0], result.answer.scene.up, viewpoint, _palm(result)
    )
    position, quaternion = pose_from_matrix(stage.world_from_view)
    scene.add_frame("/answer", show_axes=False, position=position, wxyz=wxyz(quaternion))
    shown = Shown(stage)
    _draw_points(scene, shown, result, points)
    _draw_parts(scene, shown, result)
    if gripper is not None:
        for rank, row in enumerate(result.grasps[:max_grasps]):
            shown.grasps.append(draw_grasp(scene, f"/answer/grasps/{rank}", row, gripper))
        shown.choose(best)
    return shown


def _palm(result: GraspResult) -> Array:
    """Return the direction from the best grasp to its palm; zero where there is none."""
    if not len(result.grasps):
        return np.zeros(3)
    return -matrix_from_quaternion(result.grasps[0, 3:7])[:, 2]


def draw_grasp(scene: viser.SceneApi, name: str, row: Array, gripper: Gripper) -> Hand:
    """Draw one gripper in full, and a hint of it; coloured by its score, neither is shown yet.

    Parameters
    ----------
    row : (9,) array
        x y z qx qy qz qw width score.
    """
    drawn = []
    for kind, (vertices, faces) in (
        ("full", gripper_mesh(gripper, row[7])),
        ("hint", fork_mesh(gripper, row[7])),
    ):
        drawn.append(
            scene.add_mesh_simple(
                f"{name}/{kind}",
                vertices,
                faces,
                color=score_colour(row[8]),
                flat_shading=True,
                wxyz=wxyz(row[3:7]),
                position=tuple(row[:3]),
                visible=False,
            )
        )
    return Hand(*drawn)


def score_colour(score: float) -> Rgb:
    """Return red for 0, yellow for a half, green for 1."""
    red, green, blue = (
        int(255 * np.interp(score, (0.0, 0.5, 1.0), channel))
        for channel in zip(LOW, MIDDLE, HIGH, strict=True)
    )
    return red, green, blue


def wxyz(quaternion: Array) -> Wxyz:
    """Return a quaternion [x, y, z, w] in viser's order."""
    x, y, z, w = map(float, quaternion)
    return w, x, y, z


def describe(part: Primitive) -> str:
    """Return what a part is in a few words: `0  cylinder  63 x 65 x 160 mm`."""
    sizes = " × ".join(f"{1e3 * extent:.0f}" for extent in part.full_extents)
    return f"{part.id}  {part.shape_class}  {sizes} mm"


def _draw_points(scene: viser.SceneApi, shown: Shown, result: GraspResult, points: Array) -> None:
    part, region = result.point_primitive, result.point_region
    seen = np.isfinite(points).all(axis=1) & (points != 0).any(axis=1)
    on_object = seen & (part >= 0)
    rest = np.flatnonzero(seen & ~on_object)
    if on_object.any():  # what is near says where the object stands; more would hide it
        low, extents = bounds(points[on_object])
        middle, radius = low + extents / 2, float(np.linalg.norm(extents)) / 2
        rest = rest[np.linalg.norm(points[rest] - middle, axis=1) < NEAR * radius]
    rest = rest[:: 1 + len(rest) // MAX_BACKGROUND]
    colour_of = {each.id: rgb(part_colour(k)) for k, each in enumerate(result.answer.primitives)}
    shown.background = _cloud(scene, "/answer/background", points[rest], rgb(TABLE), 0.5 * POINT_M)
    plain = np.flatnonzero(on_object & ~region)
    colours = [colour_of.get(int(each), rgb(NO_PART)) for each in part[plain]]
    shown.cloud = _cloud(scene, "/answer/cloud", points[plain], colours, POINT_M)
    shown.glow = _cloud(scene, "/answer/region", points[on_object & region], rgb(REGION), GLOW_M)


def _cloud(
    scene: viser.SceneApi, name: str, points: Array, colours: Sequence[Rgb] | Rgb, size: float
) -> viser.PointCloudHandle | None:
    if not len(points):
        return None
    return scene.add_point_cloud(
        name,
        points.astype(np.float32),
        np.asarray(colours, dtype=np.uint8),
        point_size=size,
        point_shape="circle",
        precision="float32",
    )


def _draw_parts(scene: viser.SceneApi, shown: Shown, result: GraspResult) -> None:
    region = result.answer.region
    held = region.primitive_ids if region else ()
    for number, part in enumerate(result.answer.primitives):
        vertices, faces = surface_mesh(part.superquadric, RINGS, SEGMENTS)
        is_held = part.id in held
        shown.parts[part.id] = scene.add_mesh_simple(
            f"/answer/parts/{part.id}",
            vertices,
            faces,
            color=rgb(REGION) if is_held else rgb(part_colour(number)),
            opacity=0.42 if is_held else 0.22,
            side="double",
            cast_shadow=False,
        )
        shown.labels[part.id] = scene.add_label(
            f"/answer/labels/{part.id}",
            describe(part) + (" · hold" if is_held else ""),
            position=part.superquadric.position,
            anchor="center-center",
            font_screen_scale=0.85,
        )
