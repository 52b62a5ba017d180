"""Making a dataset: views of objects, those that are missing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from experiments.camera import StereoNoise
from experiments.catalogue import CatalogueObject
from experiments.dataset.choice import chosen_objects
from experiments.dataset.drop import Body, body_of
from experiments.dataset.manifest import NAME, check_same, encode, manifest_of, read_manifest
from experiments.dataset.options import DatasetOptions
from experiments.dataset.output import CLEAN, NOISY, claimed
from experiments.dataset.photograph import photograph
from experiments.dataset.processes import carry_out
from experiments.dataset.randomness import generator
from experiments.dataset.reader import read_view
from experiments.dataset.scene import draw_scene
from experiments.dataset.view import LabelledView
from shared.errors import InvalidInput
from shared.output import write_whole
from shared.wire.npz import write_npz

Progress = Callable[[int, int], None]
"""Called with how many views are done, and of how many."""

MIN_SEEN_PX, MAX_SCENES = 30, 20


class Summary(NamedTuple):
    """How much a dataset holds, and how much of it was there before."""

    objects: int
    made: int
    kept: int


class _Job(NamedTuple):
    thing: int
    number: int


@dataclass(frozen=True)
class _Photographer:
    """Makes any view of a dataset; one works in every process."""

    folder: Path
    seed: int
    noise: StereoNoise | None
    things: tuple[CatalogueObject, ...]
    bodies: dict[int, Body] = field(default_factory=dict)

    def paths(self, job: _Job) -> tuple[Path, ...]:
        kinds = (CLEAN,) if self.noise is None else (CLEAN, NOISY)
        name = f"{job.number}.npz"
        return tuple(self.folder / kind / self.things[job.thing].name / name for kind in kinds)

    def __call__(self, job: _Job) -> None:
        if job.thing not in self.bodies:
            self.bodies[job.thing] = body_of(self.things[job.thing])
        body = self.bodies[job.thing]
        views = [make_view(body, job.number, self.seed)]
        if self.noise is not None:
            rng = generator(self.seed, f"noise on {body.thing.name}", job.number)
            views.append(views[0].with_noise(self.noise, rng))
        for path, view in zip(self.paths(job), views, strict=True):
            write_whole(path, write_npz(view.arrays(), compress=True))


def make_dataset(
    folder: Path,
    options: DatasetOptions,
    *,
    workers: int = 1,
    progress: Progress | None = None,
) -> Summary:
    """Write the dataset of these options, or what is missing of it.

    A view depends on the seed, its object and its number alone, so that the
    number of processes, the order and interruptions do not matter.

    Parameters
    ----------
    folder : Path
        New, empty, or a dataset of the same options.
    options : DatasetOptions
        What to make.
    workers : int
        Processes; 1 works in this one. With more, a script that calls this
        needs the guard `if __name__ == "__main__"`.
    progress : callable, optional
        Called once at the start and after every view.

    Raises
    ------
    InvalidInput
        An unknown object, one that does not fit into the view, or a folder
        that cannot be used.
    Conflict
        Another process is writing to this folder.
    """
    if workers < 1:
        raise InvalidInput(f"workers is {workers}, at least 1 is needed")
    things = chosen_objects(options)
    noise = StereoNoise(correlation_px=options.correlation_px)
    manifest = manifest_of(options, noise, things)
    with claimed(folder):
        held = read_manifest(folder)
        if held is not None:
            check_same(folder, held, manifest)
        write_whole(folder / NAME, encode(manifest))
        work = _Photographer(folder, options.seed, noise if options.noise else None, things)
        jobs = [_Job(i, k) for i in range(len(things)) for k in range(options.views)]
        missing = [job for job in jobs if not all(map(_is_whole, work.paths(job)))]
        kept = len(jobs) - len(missing)
        report = progress or _silent
        report(kept, len(jobs))
        for done, _ in enumerate(carry_out(work, missing, workers), start=kept + 1):
            report(done, len(jobs))
        write_whole(folder / NAME, encode(manifest | {"complete": True}))
    return Summary(len(things), len(missing), kept)


def _silent(_done: int, _total: int) -> None:
    """Report to nobody."""


def make_view(body: Body, number: int, seed: int) -> LabelledView:
    """Return view `number` of an object: noiseless, alone on a table.

    A region that is not seen cannot be found, nor missed, so scenes are drawn
    until the region of every task shows `MIN_SEEN_PX` pixels. Where none of
    `MAX_SCENES` does, the view is the one whose smallest region is largest.

    Raises
    ------
    InvalidInput
        The object does not fit into the view.
    """
    rng = generator(seed, f"scene of {body.thing.name}", number)
    best, most = None, -1
    for _ in range(MAX_SCENES):
        view = photograph(body.thing, number, draw_scene(body, number, rng))
        seen = int(view.regions.sum(axis=(1, 2)).min(initial=MIN_SEEN_PX))
        if seen > most:
            best, most = view, seen
        if seen >= MIN_SEEN_PX:
            break
    assert best is not None
    return best


def _is_whole(path: Path) -> bool:
    if not path.exists():
        return False
    try:
        read_view(path)
    except InvalidInput:
        return False
    return True
