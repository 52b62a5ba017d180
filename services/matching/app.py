"""The matching service over HTTP."""

from __future__ import annotations

from fastapi import FastAPI

from services.matching.region import find_region
from services.matching.select import select_grasps
from services.matching.settings import MatchingSettings
from shared.schemas.grasp import FIND_REGION, SELECT
from shared.service import bind, create_service


def create_app(settings: MatchingSettings | None = None) -> FastAPI:
    """Return the application; without settings, those of the environment."""
    return create_service(
        "matching",
        "Assign points to primitives and keep the grasps that hold the region",
        settings or MatchingSettings(),
        handlers=[bind(FIND_REGION, find_region), bind(SELECT, select_grasps)],
    )
