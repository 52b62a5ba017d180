"""What the grasp proposal service can be told."""

from __future__ import annotations

from pydantic import Field

from shared.grippers import GripperSettings
from shared.settings import environment


class GraspProposalSettings(GripperSettings):
    """Distances that a hand keeps, and how many grasps an answer holds.

    Attributes
    ----------
    finger_clearance_m : float
        Between each pad and the part before closing.
    support_clearance_m : float
        Between the finger tips and the support plane: they never touch it.
    palm_clearance_m : float
        Between the palm and anything, the support plane included.
    pregrasp_distance_m : float
        The straight approach along +z starts this far back.
    max_grasps : int
        Rows in an answer.
    """

    model_config = environment("grasp_proposal")

    finger_clearance_m: float = Field(default=0.005, gt=0, le=0.02)
    support_clearance_m: float = Field(default=0.0025, gt=0, le=0.02)
    palm_clearance_m: float = Field(default=0.004, gt=0, le=0.05)
    pregrasp_distance_m: float = Field(default=0.10, gt=0, le=0.5)
    max_grasps: int = Field(default=100, ge=1, le=1000)
