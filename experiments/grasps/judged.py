"""A question, its best grasp, and what came of it when a hand tried."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from experiments.catalogue import CatalogueObject
from experiments.framework import Asked, Share, ShownView
from experiments.framework.replay import Replays, free_hand
from shared.client import GraspResult
from shared.schemas.execution import Outcome

LIFTED: tuple[Outcome, ...] = ("lifted", "held", "slipped_in_shake")
"""Outcomes of a strict trial in which the lift was passed."""
NO_GRASP = "no_grasp"


@dataclass(frozen=True)
class Judged:
    """What a method answered about a view, and what physics made of its best grasp.

    Attributes
    ----------
    asked : Asked
    grasp : (9,) array or None
        The best one, in the camera's frame.
    outcome : str or None
        Of POST /execute; `no_grasp` where there was none; None where the object's mesh
        is not known, so that nothing was tried.
    message : str
        The same in a sentence.
    """

    asked: Asked
    grasp: NDArray[np.float64] | None = None
    outcome: str | None = None
    message: str = ""

    @property
    def tried(self) -> bool:
        """Physics had its say; no grasp is a failed trial."""
        return self.outcome is not None

    @property
    def lifted(self) -> bool:
        """The object rose and stayed between the fingers."""
        return self.outcome in LIFTED

    @property
    def held(self) -> bool:
        """It stayed there when it was shaken and tilted, too."""
        return self.outcome == "held"

    @property
    def right_and_held(self) -> bool:
        return self.held and self.asked.grasp_in_region

    def record(self) -> dict[str, str]:
        """Return it as a line of a CSV file."""
        tried = {"lifted": str(self.lifted).lower(), "held": str(self.held).lower()}
        return {
            **self.asked.record(),
            "outcome": self.outcome or "",
            **(tried if self.tried else dict.fromkeys(tried, "")),
            "message": self.message,
        }


def judge(
    replays: Replays,
    view: ShownView,
    thing: CatalogueObject | None,
    asked: Asked,
    result: GraspResult | None,
) -> Judged:
    """Have a hand try the best grasp of an answer, where the object's mesh is known."""
    grasp = result.grasps[0] if result is not None and len(result.grasps) else None
    if thing is None:
        return Judged(asked, grasp)
    if grasp is None:
        return Judged(asked, None, NO_GRASP, asked.code or "")
    surface = thing.surface
    happened = replays.execute(free_hand(view, surface.vertices, surface.faces, grasp))
    return Judged(asked, grasp, happened.outcome, happened.message)


def shares(judged: Sequence[Judged]) -> tuple[Share, Share, Share, Share]:
    """Return how often: right part, lifted, held in shake and tilt, right part and held."""
    tried = [each for each in judged if each.tried]
    return (
        Share.of(each.asked.grasp_in_region for each in tried),
        Share.of(each.lifted for each in tried),
        Share.of(each.held for each in tried),
        Share.of(each.right_and_held for each in tried),
    )
