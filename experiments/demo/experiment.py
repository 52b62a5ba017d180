"""The experiment: every pose, view, task and version."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

from experiments.catalogue import build
from experiments.demo.films import side_by_side, strips
from experiments.demo.scenes import POSES, Scene, make_scene
from experiments.demo.tables import one_by_one, summary
from experiments.demo.trials import Trial, attempt
from experiments.framework import Context, Experiment, Findings
from experiments.framework.asking import VERSIONS, mapped
from experiments.framework.replay import Replays
from shared.schemas.task import Version

BOTTLE = "bottle"
TASKS = ("handover", "pouring")
VIEWS = 5
FILM = "demo.gif"


def run(context: Context) -> Findings:
    """Ask about the bottle in every pose, let the arm execute the answers, keep the films."""
    thing, views = build(BOTTLE), context.limit or VIEWS
    scenes = [
        make_scene(thing, pose, number, views, context.seed)
        for pose in POSES
        for number in range(views)
    ]

    arm = Replays(context.sparge)

    def tried(question: tuple[Scene, str, Version]) -> Trial:
        return attempt(context.sparge, arm, *question)

    questions = [
        (scene, task, version) for task in TASKS for version in VERSIONS for scene in scenes
    ]
    # one after the other: a backend has one simulation process unless told otherwise
    trials = mapped(
        tried, questions, workers=1, console=context.console, describe="grasping bottles"
    )
    order = {pose: index for index, pose in enumerate(POSES)}
    trials.sort(key=lambda each: order[each.pose])
    return findings(trials, context.folder)


def findings(trials: Sequence[Trial], folder: Path) -> Findings:
    """Return what the trials show; their films are written to `folder`."""
    keep_films(trials, folder)
    told = [trial for trial in _shown(trials) if trial.film]
    return Findings(
        meaning=_meaning(trials),
        tables=(summary(trials), one_by_one(trials)),
        plots=(strips(told),) if told else (),
        records=[trial.record() for trial in trials],
    )


def keep_films(trials: Sequence[Trial], folder: Path) -> None:
    """Write the film of each trial, and the one that shows both poses; older ones go."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.gif"):
        old.unlink()
    for trial in trials:
        if trial.film:
            (folder / f"{trial.name}.gif").write_bytes(trial.film)
    handover = [trial for trial in trials if trial.film and trial.task == TASKS[0]]
    both = [_best(list(own)) for _, own in groupby(handover, key=lambda trial: trial.pose)]
    if both:
        (folder / FILM).write_bytes(side_by_side(both))


def _best(trials: Sequence[Trial]) -> Trial:
    """Return the trial to show: the last that succeeded, else was lifted, else has a film."""
    return max(reversed(trials), key=lambda each: (each.succeeded, each.lifted, bool(each.film)))


def _shown(trials: Sequence[Trial]) -> list[Trial]:
    """Return the best trial of each pose and task, and the first that failed in the act."""
    best = [
        _best([each for each in trials if (each.pose, each.task) == key])
        for key in dict.fromkeys((each.pose, each.task) for each in trials)
    ]
    failed = [each for each in trials if each.film and each not in best]
    failed.sort(key=lambda each: (each.succeeded, each.lifted))
    return [*best, *failed[:1]] if failed and not failed[0].succeeded else best


def _meaning(trials: Sequence[Trial]) -> str:
    handover = [each for each in trials if each.task == TASKS[0]]
    found, right = sum(each.found for each in trials), sum(each.succeeded for each in trials)
    return (
        f"In {found} of {len(trials)} trials a part to hold was found, and in {right} the arm "
        f"lifted the bottle by the right part; for handover alone, in "
        f"{sum(each.succeeded for each in handover)} of {len(handover)}. The camera is noisy, the "
        "bottle that is grasped is the true one, and nothing that failed is left out."
    )


DEMO = Experiment(
    name="demo",
    title="A bottle is picked up",
    question=(
        "Does the answer work in the end? A bottle lies flat or stands upright; the arm executes "
        "the best grasp for handover and for pouring in a physics simulation."
    ),
    run=run,
    thesis="experiment 5, section 6.6",
    views_per_object=None,
)
