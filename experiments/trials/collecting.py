"""Trying the grasps of many scenes, those that are missing."""

from __future__ import annotations

import contextlib
import logging
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple
from urllib.request import urlopen

from numpy.typing import NDArray
from rich.console import Console

from experiments.catalogue import CatalogueObject
from experiments.dataset.drop import body_of
from experiments.dataset.processes import carry_out
from experiments.framework.knowledge import added_tasks, affordances, name_prefix
from experiments.grasps.blind import blind_tasks
from experiments.trials.scenes import PER_ROUND, ROUND, draw_object, draw_scene
from experiments.trials.trials import Judge, try_out
from shared.client import Sparge, connect
from shared.errors import InvalidInput, StageUnavailable
from shared.output import write_whole
from shared.schemas.execution import EXECUTE
from shared.schemas.grasp import LIST_GRIPPERS
from shared.schemas.route import Nothing
from shared.wire.npz import write_npz

NAME = "{kind}-{number}-{view}.npz"
EMPTY = ".none"
"""Suffix of the mark that a scene has no grasp to try, so that it is not asked for again."""

logger = logging.getLogger(__name__)


class Job(NamedTuple):
    """Which object: of which kind of `PER_ROUND`, and which of them."""

    kind: str
    number: int


def jobs_of(rounds: range) -> list[Job]:
    """Return the objects of some rounds, round by round."""
    return [
        Job(kind, number * count + index)
        for number in rounds
        for kind, count in PER_ROUND.items()
        for index in range(count)
    ]


@dataclass(frozen=True)
class Collector:
    """Tries the grasps of any scene; one works in every process.

    Attributes
    ----------
    folder : Path
    url : str
        Of the backend.
    seed, each : int
        As for `try_out`.
    views : int
        Of each object.
    grippers, blind : tuple of str
        As for `try_out`.
    judge : callable
        Makes of a backend what judges a grasp.
    rehearse : bool
        As for `try_out`.
    """

    folder: Path
    url: str
    seed: int
    each: int
    views: int
    grippers: tuple[str, ...]
    blind: tuple[str, ...]
    judge: Callable[[Sparge], Judge]
    rehearse: bool = False

    def path(self, job: Job, view: int) -> Path:
        return self.folder / NAME.format(kind=job.kind, number=job.number, view=view)

    def is_done(self, job: Job) -> bool:
        paths = [self.path(job, view) for view in range(self.views)]
        return all(path.exists() or path.with_suffix(EMPTY).exists() for path in paths)

    def __call__(self, job: Job) -> None:
        thing = draw_object(job.kind, job.number, self.seed)
        for view in range(self.views):
            arrays = self._try_out(thing, view)
            path = self.path(job, view)
            if arrays is None:
                write_whole(path.with_suffix(EMPTY), b"")
            else:
                write_whole(path, write_npz(arrays, compress=True))

    def _try_out(self, thing: CatalogueObject, view: int) -> Mapping[str, NDArray[Any]] | None:
        try:
            scene = draw_scene(body_of(thing), view, self.seed)
        except InvalidInput:  # warped out of what fits into the view or rests on a table
            return None
        with connect(self.url) as sparge:
            return try_out(
                sparge,
                self.judge(sparge),
                scene,
                blind=self.blind,
                grippers=self.grippers,
                each=self.each,
                seed=self.seed,
                rehearse=self.rehearse,
            )


def wait_until_ready(url: str, seconds: float) -> None:
    """Return when the backend says that it is ready.

    Raises
    ------
    StageUnavailable
        It does not within so many seconds.
    """
    until = time.monotonic() + seconds
    while True:
        with contextlib.suppress(OSError), urlopen(f"{url}/health/ready", timeout=5.0):
            return  # anything but 200 is an OSError
        if time.monotonic() >= until:
            raise StageUnavailable(f"the backend at {url} is not ready after {seconds:g} s")
        time.sleep(1.0)


def by_backend(sparge: Sparge) -> Judge:
    """Return the judge that asks POST /execute."""
    return partial(sparge.call, EXECUTE)


def collect(
    folder: Path,
    url: str,
    *,
    rounds: range,
    each: int,
    views: int,
    seed: int,
    workers: int,
    judge: Callable[[Sparge], Judge] = by_backend,
    rehearse: bool = False,
) -> None:
    """Write a file for every object of every round that has none yet."""
    console = Console(stderr=True)
    with connect(url) as sparge:
        listed = sparge.call(LIST_GRIPPERS, Nothing()).grippers
        definitions = list(blind_tasks(affordances(sparge), name_prefix()).values())
        with added_tasks(sparge, console, definitions):
            work = Collector(
                folder,
                url,
                seed,
                each,
                views,
                tuple(each.name for each in listed if each.kind == "parallel"),
                tuple(each.name for each in definitions),
                judge,
                rehearse,
            )
            missing = [job for job in jobs_of(rounds) if not work.is_done(job)]
            started = time.perf_counter()
            for done, _ in enumerate(carry_out(work, missing, workers), start=1):
                if done % ROUND == 0 or done == len(missing):
                    spent = time.perf_counter() - started
                    logger.info("%d of %d objects, %.0f s", done, len(missing), spent)
