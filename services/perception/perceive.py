"""The stage: a view in, the target object and its surroundings out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.perception.cloud import thin
from services.perception.degenerate import require_area, require_volume
from services.perception.observation import Observation, observe
from services.perception.settings import PerceptionSettings
from services.perception.support import choose_support
from services.perception.tabletop import Tabletop
from services.perception.things import Thing, most_appealing
from services.perception.units import checked_target
from services.perception.up import guess_up
from shared.deadline import check_deadline
from shared.geometry.passes import corners
from shared.geometry.points import points_from_depth
from shared.geometry.rotation import frame_from_z
from shared.schemas.scene import PerceiveRequest, PerceiveResponse, SupportPlane

Array = NDArray[np.float64]


class Perception:
    """Finds the object to grasp; holds settings only, so calls may run side by side."""

    def __init__(self, settings: PerceptionSettings | None = None) -> None:
        self.settings = settings or PerceptionSettings()

    def perceive(self, request: PerceiveRequest) -> PerceiveResponse:
        """Return the target object of a view.

        Raises
        ------
        PayloadTooLarge
            Too many points.
        EmptyCloud
            Too few valid points.
        WrongUnits
            Coordinates that look like millimetres, of the points or of the target.
        DegenerateCloud
            All points on a spot or a line, or for `input = object` exactly on a plane.
        NoObject
            Nothing of the size of an object on the support plane.
        """
        limits = self.settings.min_points, self.settings.max_points
        view = observe(request, request.input, *limits)
        if request.input == "object":
            return self._whole(view)
        require_area(view.points)
        target = None if request.target is None else checked_target(request.target, view.points)
        rng = np.random.default_rng(request.seed)
        check_deadline()
        top = choose_support(view, target, self.settings, rng)
        check_deadline()
        return self._answer(view, top, most_appealing(top.objects, view, target))

    def warm_up(self) -> None:
        """Run everything once, on a small table with a box on it: compiles what is not cached."""
        depth = np.full((81, 81), 0.8)
        depth[32:49, 32:49] = 0.75
        intrinsics = np.array([[160.0, 0, 40], [0, 160.0, 40], [0, 0, 1]])
        self.perceive(PerceiveRequest(depth=depth, intrinsics=intrinsics))
        self.perceive(PerceiveRequest(points=points_from_depth(depth, intrinsics, 1.0)))

    def _whole(self, view: Observation) -> PerceiveResponse:
        require_volume(view.points)
        return PerceiveResponse(
            object_points=view.points,
            object_indices=view.rows.astype(np.int32),
            obstacle_points=np.empty((0, 3)),
            plane=None,
            up=_triple(guess_up(view)),
            input_points=view.total,
            dropped={"invalid": view.total - len(view.rows), "support": 0, "other": 0},
            clusters=1,
        )

    def _answer(self, view: Observation, top: Tabletop, chosen: Thing) -> PerceiveResponse:
        plane = None
        up = guess_up(view)
        if top.plane is not None:
            up = top.plane.normal
            plane = SupportPlane(
                normal=_triple(up),
                offset=top.plane.offset,
                inliers=top.inliers,
                residual_mm=1e3 * top.residual,
            )
        support = int(np.count_nonzero(top.on_plane))
        return PerceiveResponse(
            object_points=chosen.points,
            object_indices=view.rows[chosen.members].astype(np.int32),
            obstacle_points=self._obstacles(view, top, chosen, up),
            plane=plane,
            up=_triple(up),
            input_points=view.total,
            dropped={
                "invalid": view.total - len(view.rows),
                "support": support,
                "other": len(view.rows) - support - len(chosen.members),
            },
            clusters=len(top.objects),
        )

    def _obstacles(self, view: Observation, top: Tabletop, chosen: Thing, up: Array) -> Array:
        """Return what else stands within reach of the object's box, thinned."""
        things = [thing.members for thing in top.things if thing is not chosen]
        rows = np.concatenate([*things, np.flatnonzero(top.furniture)]).astype(np.intp)
        rows = np.sort(rows)
        frame = frame_from_z(up)
        low, high = corners(chosen.points @ frame)
        reach = self.settings.obstacle_reach_m
        others = view.points.take(rows, axis=0)
        placed = np.ascontiguousarray((others @ frame).T)
        near = (placed > (low - reach)[:, None]) & (placed < (high + reach)[:, None])
        return thin(others.compress(near.all(axis=0), axis=0), self.settings.obstacle_voxel_m)


def _triple(vector: Array) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
