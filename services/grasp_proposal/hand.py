"""The hand's boxes, in coordinates of an oriented hand at a surface point."""

from __future__ import annotations

from dataclasses import dataclass

from services.grasp_proposal.settings import GraspProposalSettings
from shared.schemas.gripper import ParallelGripper


@dataclass(frozen=True)
class Hand:
    """A gripper and the distances that it keeps, metres and newtons.

    Attributes
    ----------
    max_opening, finger_width, finger_thickness, finger_length, tip_beyond_tcp, force
        As in `shared.schemas.gripper.ParallelGripper`.
    palm_size : tuple of float
        Along x, y, z.
    clearance, support_clearance, palm_clearance, pregrasp
        As in the settings. `clearance` is per pad.
    """

    max_opening: float
    finger_width: float
    finger_thickness: float
    finger_length: float
    tip_beyond_tcp: float
    palm_size: tuple[float, float, float]
    clearance: float
    support_clearance: float
    palm_clearance: float
    pregrasp: float
    force: float

    @classmethod
    def of(cls, gripper: ParallelGripper, settings: GraspProposalSettings) -> Hand:
        """Join a gripper's geometry and the service's settings."""
        return cls(
            max_opening=gripper.max_opening,
            finger_width=gripper.finger_width,
            finger_thickness=gripper.finger_thickness,
            finger_length=gripper.finger_length,
            tip_beyond_tcp=gripper.tip_beyond_tcp,
            palm_size=gripper.palm_size,
            clearance=min(settings.finger_clearance_m, gripper.max_opening / 4),
            support_clearance=settings.support_clearance_m,
            palm_clearance=settings.palm_clearance_m,
            pregrasp=settings.pregrasp_distance_m,
            force=gripper.force,
        )

    @property
    def max_width(self) -> float:
        """Widest part that the open hand passes with half its usual clearance."""
        return self.max_opening - self.clearance
