"""The grasp proposal service over HTTP."""

from __future__ import annotations

from fastapi import FastAPI

from services.grasp_proposal.proposer import GraspProposer
from services.grasp_proposal.settings import GraspProposalSettings
from shared.schemas.grasp import LIST_GRIPPERS, PROPOSE
from shared.service import bind, create_service


def create_app(settings: GraspProposalSettings | None = None) -> FastAPI:
    """Return the application; without settings, those of the environment."""
    settings = settings or GraspProposalSettings()
    proposer = GraspProposer(settings)
    return create_service(
        "grasp_proposal",
        "Propose 6-DOF grasps of a parallel gripper that collide with nothing",
        settings,
        handlers=[
            bind(LIST_GRIPPERS, proposer.list_grippers),
            bind(PROPOSE, proposer.propose),
        ],
        warm_up=proposer.warm_up,
    )
