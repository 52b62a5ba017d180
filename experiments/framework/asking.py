"""Asking a backend about views, and scoring what it answers."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from experiments.dataset import ViewFile
from experiments.framework.scoring import RegionScore, holds, score_region
from experiments.framework.views import ShownView, Thing, ViewSet, load
from shared.client import GraspResult, Sparge
from shared.errors import (
    DeadlineExceeded,
    InternalError,
    SpargeError,
    StageUnavailable,
    TooBusy,
    UnknownTask,
)
from shared.schemas.task import Version

VERSIONS: tuple[Version, Version] = ("v1", "v2")
VERSION_NAMES = {"v1": "Version 1", "v2": "Version 2"}

NOT_THE_VIEW = (InternalError, StageUnavailable, DeadlineExceeded, TooBusy)
"""Errors that say nothing about the view: an experiment stops at them."""

Item = TypeVar("Item")
Result = TypeVar("Result")


@dataclass(frozen=True)
class Asked:
    """One question to POST /grasp and what came of it.

    Attributes
    ----------
    source, thing, class_name, view : str
        The set of views, the object, its class, the file.
    task : str
    reasoning : str
        Version of the reasoning, v1 or v2.
    afforded : bool
        Whether the object serves the task, so that a region should be found.
    found : bool
    code : str or None
        Why nothing was found, or of the error that was answered.
    error : bool
        An error was answered, which counts neither as found nor as refused.
    score : RegionScore or None
        Where a region was found for a task that is afforded.
    grasped : bool
        There is at least one grasp.
    grasp_in_region : bool
        The object point nearest to the best grasp is in the labelled region.
    known : bool
        Whether the version knows the task at all; if not, the question does not count.
    seconds : float
        As the client saw it.
    """

    source: str
    thing: str
    class_name: str
    view: str
    task: str
    reasoning: str
    afforded: bool
    found: bool = False
    code: str | None = None
    error: bool = False
    score: RegionScore | None = None
    grasped: bool = False
    grasp_in_region: bool = False
    known: bool = True
    seconds: float = 0.0

    @property
    def refused(self) -> bool:
        """The answer is that no part fits the task."""
        return not self.found and not self.error

    @property
    def good(self) -> bool:
        """A region was found and overlaps the labelled one well."""
        return self.score is not None and self.score.good

    def record(self) -> dict[str, str]:
        """Return it as a line of a CSV file."""
        score = self.score
        return {
            "source": self.source,
            "object": self.thing,
            "class": self.class_name,
            "view": self.view,
            "task": self.task,
            "reasoning": self.reasoning,
            "afforded": str(self.afforded).lower(),
            "known": str(self.known).lower(),
            "found": str(self.found).lower(),
            "code": self.code or "",
            "error": str(self.error).lower(),
            "accuracy": f"{score.accuracy:.6f}" if score else "",
            "precision": f"{score.precision:.6f}" if score else "",
            "thesis_tpr": f"{score.precision:.6f}" if score else "",
            "recall": f"{score.recall:.6f}" if score else "",
            "iou": f"{score.iou:.6f}" if score else "",
            "good": str(self.good).lower(),
            "grasped": str(self.grasped).lower(),
            "grasp_in_region": str(self.grasp_in_region).lower(),
        }


@dataclass(frozen=True)
class Source:
    """Where a view is from; the beginning of every `Asked`."""

    set_name: str
    file: ViewFile
    thing: Thing

    def asked(self, task: str, reasoning: str, afforded: bool, **outcome: Any) -> Asked:
        """Return the record of a question about this view."""
        return Asked(
            source=self.set_name,
            thing=self.file.object_name,
            class_name=self.thing.class_name,
            view=str(self.file.number),
            task=task,
            reasoning=reasoning,
            afforded=afforded,
            **outcome,
        )


def ask(
    sparge: Sparge,
    source: Source,
    view: ShownView,
    task: str,
    reasoning: Version,
    *,
    truth_task: str | None = None,
    arrays: Mapping[str, ArrayLike] | None = None,
    **parameters: Any,
) -> tuple[Asked, GraspResult | None]:
    """Ask about a view and score the answer.

    Parameters
    ----------
    sparge : Sparge
    source : Source
    view : ShownView
    task : str
        To ask for.
    reasoning : str
    truth_task : str, optional
        The task whose labels are the truth, where it is another one.
    arrays : mapping, optional
        What to send instead of the depth image; the points must be the same ones.
    **parameters
        Further ones of POST /grasp.

    Returns
    -------
    asked : Asked
        An answer that is an error about the view counts as not found.
    result : GraspResult or None
        None for an error.

    Raises
    ------
    SpargeError
        The backend is down, failed or came to no end: nothing to be measured.
    """
    truth_task = truth_task or task
    afforded = truth_task in view.tasks
    started = time.perf_counter()
    try:
        result = sparge.grasp(arrays or view.arrays(), task, reasoning=reasoning, **parameters)
    except NOT_THE_VIEW:
        raise
    except SpargeError as error:
        known = not isinstance(error, UnknownTask)
        seconds = time.perf_counter() - started
        asked = source.asked(
            task, reasoning, afforded, code=error.code, error=True, known=known, seconds=seconds
        )
        return asked, None
    seconds = time.perf_counter() - started
    answer = result.answer
    scored: dict[str, Any] = {}
    if answer.found and afforded:
        truth = view.truth(truth_task)
        scored["score"] = score_region(truth, result.point_region[view.on_object])
        scored["grasp_in_region"] = grasp_is_right(result, view, truth)
    return (
        source.asked(
            task,
            reasoning,
            afforded,
            found=answer.found,
            code=answer.reason.code if answer.reason else None,
            grasped=len(result.grasps) > 0,
            seconds=seconds,
            **scored,
        ),
        result,
    )


def grasp_is_right(result: GraspResult, view: ShownView, truth: NDArray[np.bool_]) -> bool:
    """Say whether the best grasp is nearest to an object point of the labelled region (N,)."""
    if not len(result.grasps):
        return False
    return holds(result.grasps[0, :3], view.object_points, truth)


def each_view(
    work: Callable[[Source, ShownView], Sequence[Result]],
    sets: Sequence[ViewSet],
    *,
    workers: int,
    console: Console,
    describe: str,
) -> list[Result]:
    """Return what `work` makes of every view, in the order of the views.

    Views are worked on `workers` at a time, with a progress bar.
    """
    sources = [
        Source(views.name, file, views.thing(file)) for views in sets for file in views.files
    ]

    def one(source: Source) -> Sequence[Result]:
        return work(source, load(source.file))

    results = mapped(one, sources, workers=workers, console=console, describe=describe)
    return [each for part in results for each in part]


def mapped(
    work: Callable[[Item], Result],
    items: Sequence[Item],
    *,
    workers: int,
    console: Console,
    describe: str,
) -> list[Result]:
    """Return `work` of every item in order, `workers` at a time, with a progress bar.

    The first error ends it; work that has not begun is dropped.
    """
    with progress_bar(console) as progress, ThreadPoolExecutor(workers) as pool:
        bar = progress.add_task(describe, total=len(items))
        try:
            return list(_advancing(pool.map(work, items), progress, bar))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _advancing(results: Iterator[Result], progress: Progress, bar: Any) -> Iterator[Result]:
    for result in results:
        progress.advance(bar)
        yield result


def progress_bar(console: Console, *, visible: bool = True) -> Progress:
    """Return the progress display of every experiment."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(elapsed_when_finished=True),
        console=console,
        transient=True,
        disable=not visible,
    )
