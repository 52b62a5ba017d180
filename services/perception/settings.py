"""What perception can be told, through `SPARGE_PERCEPTION_*`."""

from __future__ import annotations

from pydantic import Field

from shared.settings import ServiceSettings, environment


class PerceptionSettings(ServiceSettings):
    """Lengths in metres; thresholds written `*_sigmas` are in units of the measured noise.

    Attributes
    ----------
    min_points : int
        Fewer valid points than this are no cloud.
    max_points : int
        More points or pixels than this are refused with 413.
    plane_tolerance_m : float
        How far a point may lie from a plane hypothesis and still vote for it.
    plane_hypotheses : int
        RANSAC draws per plane.
    max_planes : int
        How many planes (floor, table, wall, faces of boxes) to consider.
    cell_m : float
        Grid of the plane over which heights are averaged; never finer than the points.
    seed_height_m, seed_sigmas : float
        A patch whose mean height exceeds both is certainly not the plane.
    grow_height_m, grow_sigmas : float
        A patch joined to a certain one belongs to it if it exceeds both.
    point_height_m, point_sigmas : float
        Within such patches a point higher than both always stands out.
    cluster_gap_m : float
        Points closer than this belong together; never finer than three point spacings.
    hidden_gap_m : float
        A minor cluster this close belongs to a larger one that hides what joins them.
    hidden_bar_m : float
        A slender cluster that a larger one's shadow cuts off goes on this far to meet it.
    min_object_points, min_object_extent_m : int, float
        A smaller cluster is a speck.
    max_object_extent_m : float
        A longer cluster or plane is furniture.
    obstacle_reach_m, obstacle_voxel_m : float
        How far around the object obstacles are reported, and how finely.
    """

    model_config = environment("perception")

    min_points: int = Field(default=30, ge=4)
    max_points: int = Field(default=5_000_000, gt=0)
    plane_tolerance_m: float = Field(default=0.008, gt=0)
    plane_hypotheses: int = Field(default=400, ge=10)
    max_planes: int = Field(default=4, ge=1)
    cell_m: float = Field(default=0.0025, gt=0)
    seed_height_m: float = Field(default=0.0015, gt=0)
    seed_sigmas: float = Field(default=6.0, gt=0)
    grow_height_m: float = Field(default=0.0008, gt=0)
    grow_sigmas: float = Field(default=3.0, gt=0)
    point_height_m: float = Field(default=0.0008, gt=0)
    point_sigmas: float = Field(default=2.5, gt=0)
    cluster_gap_m: float = Field(default=0.012, gt=0)
    hidden_gap_m: float = Field(default=0.06, gt=0)
    hidden_bar_m: float = Field(default=0.12, gt=0)
    min_object_points: int = Field(default=30, ge=1)
    min_object_extent_m: float = Field(default=0.015, gt=0)
    max_object_extent_m: float = Field(default=0.6, gt=0)
    obstacle_reach_m: float = Field(default=0.25, ge=0)
    obstacle_voxel_m: float = Field(default=0.005, gt=0)
