"""Synthetic views: meshes on a table, cast by Open3D, with the noise of stereo depth.

World: the table's top is z = 0, z is up, metres. Camera: optical frame, z ahead, y down.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import open3d as o3d
from numpy.typing import NDArray

from shared.geometry.points import points_from_depth
from shared.geometry.se3 import inverse
from shared.schemas.scene import PerceiveRequest

Array = NDArray[np.float64]

Size = tuple[float, float, float]

SCALE = 1e-4


def head_camera(pitch_deg: float = 50.0, distance: float = 0.85) -> Array:
    """Return world_from_camera (4, 4) of a camera that looks down at the origin."""
    pitch = np.deg2rad(pitch_deg)
    ahead = np.array([np.cos(pitch), 0.0, -np.sin(pitch)])
    right = np.array([0.0, -1.0, 0.0])
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([right, np.cross(ahead, right), ahead])
    pose[:3, 3] = -distance * ahead
    return pose


@dataclass
class Shot:
    """A rendered view: depth (H, W) in metres, 0 for no return, and what each pixel shows."""

    depth: Array
    shows: NDArray[np.int64]
    intrinsics: Array
    names: list[str]
    world_from_camera: Array

    def pixels(self, *names: str) -> NDArray[np.bool_]:
        """Return the mask (H*W,) of the named things."""
        wanted = [self.names.index(name) for name in names]
        return np.isin(self.shows, wanted).ravel()

    def with_noise(self, rng: np.random.Generator, sigma_m: float, at_m: float = 0.85) -> Shot:
        """Return the view with depth noise of `sigma_m` at depth `at_m`, growing with z^2."""
        sigma = sigma_m * (self.depth / at_m) ** 2
        noisy = np.where(self.depth > 0, rng.normal(self.depth, sigma), 0.0)
        return Shot(noisy, self.shows, self.intrinsics, self.names, self.world_from_camera)

    def request(self, **more: object) -> PerceiveRequest:
        """Return the request with a 16-bit depth image."""
        units = np.rint(self.depth / SCALE).astype(np.uint16)
        fields = {"depth": units, "intrinsics": self.intrinsics, "depth_scale": SCALE, **more}
        return PerceiveRequest.model_validate(fields)

    def cloud(self) -> Array:
        """Return the points (H*W, 3) in the camera's frame, NaN for no return."""
        return points_from_depth(self.depth, self.intrinsics, 1.0)


@dataclass
class Stage:
    """Things to be seen; thin walls are boxes."""

    meshes: list[tuple[str, Any]] = field(default_factory=list)

    def box(self, name: str, size: Size, at: Size) -> Stage:
        """Add an upright box whose bottom face is centred at `at`."""
        mesh: Any = o3d.geometry.TriangleMesh.create_box(*size)
        corner = np.array([-size[0] / 2, -size[1] / 2, 0.0]) + at
        self.meshes.append((name, mesh.translate(corner)))
        return self

    def ellipsoid(self, name: str, radii: Size, at: Size) -> Stage:
        """Add an ellipsoid whose lowest point is `at`."""
        mesh: Any = o3d.geometry.TriangleMesh.create_sphere(1.0, 40)
        vertices = np.asarray(mesh.vertices) * radii + np.array([0.0, 0.0, radii[2]]) + at
        mesh.vertices = o3d.utility.Vector3dVector(vertices)
        self.meshes.append((name, mesh))
        return self

    def cylinder(self, name: str, radius: float, height: float, at: Size) -> Stage:
        """Add an upright cylinder whose bottom is centred at `at`."""
        mesh: Any = o3d.geometry.TriangleMesh.create_cylinder(radius, height, 40)
        self.meshes.append((name, mesh.translate(np.array([0.0, 0.0, height / 2]) + at)))
        return self

    def table(self, width: float = 1.2, depth: float = 0.8) -> Stage:
        """Add a table top, 3 cm thick."""
        return self.box("table", (depth, width, 0.03), (0.0, 0.0, -0.03))

    def shoot(
        self, camera: Array | None = None, size: tuple[int, int] = (480, 640), focal: float = 615.0
    ) -> Shot:
        """Render the view; a smaller `size` keeps the field of view of 640x480."""
        camera = head_camera() if camera is None else camera
        height, width = size
        focal *= width / 640
        intrinsics = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1.0]])
        scene = o3d.t.geometry.RaycastingScene(nthreads=1)
        for _, mesh in self.meshes:
            scene.add_triangles(o3d.t.geometry.TriangleMesh.from_legacy(mesh))
        rays = scene.create_rays_pinhole(
            _tensor(intrinsics), _tensor(inverse(camera)), width, height
        )
        cast = scene.cast_rays(rays, nthreads=1)
        depth = cast["t_hit"].numpy().astype(np.float64)
        shows = cast["geometry_ids"].numpy().astype(np.int64)
        hit = np.isfinite(depth)
        on_centres = intrinsics - np.array([[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]])
        return Shot(
            np.where(hit, depth, 0.0),
            np.where(hit, shows, -1),
            on_centres,  # Open3D counts pixels from their corner
            [name for name, _ in self.meshes],
            camera,
        )


def _tensor(matrix: Array) -> o3d.core.Tensor:
    return o3d.core.Tensor(matrix, o3d.core.float64, o3d.core.Device("CPU:0"))


def spoon(stage: Stage) -> Stage:
    """Add a spoon 10 mm high: a bowl, and a handle 8 mm wide and 4 mm thick."""
    stage.ellipsoid("bowl", (0.03, 0.02, 0.005), (0.0, 0.0, 0.0))
    return stage.box("handle", (0.008, 0.13, 0.004), (0.0, -0.085, 0.004))


def small_view() -> Shot:
    """Return a quick view: a box in the middle, a ball and a can beside it."""
    stage = Stage().table().box("box", (0.06, 0.09, 0.05), (0.0, 0.0, 0.0))
    stage.ellipsoid("ball", (0.035, 0.035, 0.035), (0.05, 0.2, 0.0))
    return stage.cylinder("can", 0.033, 0.11, (0.08, -0.18, 0.0)).shoot(size=(240, 320))
