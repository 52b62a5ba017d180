"""The best grasp whatever the task, through the public contract."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from experiments.framework import Asked, ShownView, ask
from experiments.framework.asking import Source, grasp_is_right
from shared.client import GraspResult, Sparge
from shared.schemas.task import TaskDefinition

BLIND = "blind"
_RAREST_FIRST = ("cut", "scoop", "support")


@dataclass(frozen=True)
class Blind:
    """Asks for the best grasp on the whole object.

    Attributes
    ----------
    sparge : Sparge
    tasks : mapping
        Affordance -> the task that avoids it alone, the rarest affordance first.
    """

    sparge: Sparge
    tasks: Mapping[str, str]

    def ask(self, source: Source, view: ShownView) -> tuple[GraspResult | None, bool]:
        """Return the answer about the largest region that can be asked for, and if it is all.

        The labels in a first answer tell which affordance no part has. Where
        every affordance is some part's, the first answer stands, and the parts
        that it leaves out are not tried. None stands for an error about the view.
        """
        first, *_ = self.tasks.values()
        result = self._ask(source, view, first)
        if result is None or _is_whole(result):
            return result, result is not None
        taken = {label for part in result.answer.primitives for label in part.labels}
        free = [task for affordance, task in self.tasks.items() if affordance not in taken]
        if not free or not result.answer.primitives:
            return result, False
        result = self._ask(source, view, free[0])
        return result, result is not None and _is_whole(result)

    def _ask(self, source: Source, view: ShownView, task: str) -> GraspResult | None:
        return ask(self.sparge, source, view, task, "v2", max_grasps=1, explain=False)[1]


def blind_tasks(known: Sequence[str], prefix: str) -> dict[str, TaskDefinition]:
    """Return for each affordance the task that avoids it alone, the rarest affordance first."""
    ordered = sorted(known, key=lambda name: (name not in _RAREST_FIRST, name))
    return {
        name: TaskDefinition(
            name=f"{prefix}_{name}"[:64], description="hold any part", avoids=(name,)
        )
        for name in ordered
    }


def _is_whole(result: GraspResult) -> bool:
    region = result.answer.region
    return region is not None and len(region.primitive_ids) == len(result.answer.primitives)


def blind_row(source: Source, view: ShownView, task: str, result: GraspResult | None) -> Asked:
    """Return the blind answer about a view, judged by the labels of a task."""
    grasped = result is not None and len(result.grasps) > 0
    right = result is not None and grasp_is_right(result, view, view.truth(task))
    return source.asked(
        task,
        BLIND,
        True,
        found=result is not None and result.answer.found,
        grasped=grasped,
        grasp_in_region=right,
    )
