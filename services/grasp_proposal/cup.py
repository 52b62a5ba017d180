"""A suction gripper's shape, and whether it touches anything on its way in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.boxes import any_inside
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.workspace import Workspace
from shared.schemas.gripper import SuctionGripper

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Cup:
    """A suction gripper and the distances that it keeps, metres and newtons.

    Attributes
    ----------
    radius, length, compliance, palm_size, force
        As in `shared.schemas.gripper.SuctionGripper`; `radius` is half the diameter.
    support_clearance, palm_clearance, pregrasp
        As in the settings.
    """

    radius: float
    length: float
    compliance: float
    palm_size: tuple[float, float, float]
    force: float
    support_clearance: float
    palm_clearance: float
    pregrasp: float

    @classmethod
    def of(cls, gripper: SuctionGripper, settings: GraspProposalSettings) -> Cup:
        """Join a gripper's geometry and the service's settings."""
        return cls(
            radius=gripper.cup_diameter / 2,
            length=gripper.cup_length,
            compliance=gripper.compliance,
            palm_size=gripper.palm_size,
            force=gripper.force,
            support_clearance=settings.support_clearance_m,
            palm_clearance=settings.palm_clearance_m,
            pregrasp=settings.pregrasp_distance_m,
        )

    def hits(self, centres: Array, rotations: Array, points: Array, above: float) -> Mask:
        """Say which cups (S,) meet a point (N, 3) on their straight way to `centres` (S, 3).

        The cup counts as a square as wide as its lip, from `above` metres before the lip's
        place on; the palm is the box behind it.
        """
        radius, back = self.radius, -self.length - self.pregrasp
        cup = self._boxes(len(centres), radius, back, -above)
        hit = any_inside(centres, rotations, radius, cup, points)
        front = self.palm_clearance - self.length
        palm = self._boxes(len(centres), self.palm_size[1] / 2, back - self.palm_size[2], front)
        return np.asarray(hit | any_inside(centres, rotations, self.palm_size[0] / 2, palm, points))

    @staticmethod
    def _boxes(number: int, half: float, back: float, front: float) -> Array:
        return np.tile([0.0, -half, half, back, front], (number, 1))

    def clearance(self, centres: Array, rotations: Array, workspace: Workspace) -> Array:
        """Return the lowest height (S,) of lip and palm on their way, inf without a plane."""
        if workspace.up is None:
            return np.full(len(centres), np.inf)
        rise = np.einsum("sij,i->sj", rotations, workspace.up)
        height = workspace.heights(centres)
        lip = height - self.radius * np.hypot(rise[:, 0], rise[:, 1])
        aside = np.abs(rise[:, :2]) @ np.array(self.palm_size[:2]) / 2
        ends = np.array([self.length, self.length + self.palm_size[2] + self.pregrasp])
        palm = (height[:, None] - rise[:, 2:] * ends).min(axis=1) - aside
        return np.asarray(np.minimum(lip, palm))
