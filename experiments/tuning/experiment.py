"""A.1.1 of the thesis: which parameters recover the primitives that rules need."""

from __future__ import annotations

from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from functools import partial

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from experiments.dataset import ViewFile
from experiments.framework import Context, Experiment, Findings, ViewSet
from experiments.tuning.evaluation import Evaluation, Evaluator, TuningView, tuning_views
from experiments.tuning.figures import history, parallel_coordinates
from experiments.tuning.outcome import (
    NAMES,
    counts_table,
    headline,
    meaning,
    objects_table,
    parameters_table,
    records,
    trials_csv,
)
from experiments.tuning.study import Trial, opened, study_name
from shared.errors import InvalidInput
from shared.schemas.primitive import PRESETS

TRIALS = 80
"""Six to seven minutes of two cores; the thesis made 300 (docs/decisions/0013-tuning.md)."""
TUNED_ON, CHECKED_ON = 4, 4
"""Views of each object: for the search, as in the thesis, and to check what it found."""
CLASSES = frozenset({"pan", "ladle", "hammer", "spatula", "bottle"})
"""Of the thesis's objects. Each should become two primitives."""


def run(context: Context, trials: int = TRIALS) -> Findings:
    """Search for the parameters that cost least, and compare them with the published ones.

    Parameters
    ----------
    context : Context
    trials : int
        The search goes on until there are so many. It begins where the last one
        with the same views, seed and backend ended.

    Raises
    ------
    InvalidInput
        There are no views of objects of the catalogue.
    Conflict
        Another process is tuning in the same folder.
    SpargeError
        The backend is down or failed.
    """
    if trials < 1:
        raise InvalidInput(f"trials is {trials}, at least 1 is needed", field="trials")
    files, other_files = split(context.catalogue(TUNED_ON + CHECKED_ON))
    views, others = tuning_views(files), tuning_views(other_files)
    with ThreadPoolExecutor(context.workers) as pool:
        evaluator = Evaluator(context.sparge, pool, context.seed)
        tuned = {
            NAMES[preset]: evaluator.evaluate(parameters, views)
            for preset, parameters in PRESETS.items()
        }
        found = _search(context, evaluator, views, trials, list(tuned.values()))
        best = min(found, key=lambda each: (each.cost, each.number))
        compared = {NAMES[preset]: parameters for preset, parameters in PRESETS.items()}
        compared[f"trial {best.number}"] = best.parameters
        tuned[f"trial {best.number}"] = evaluator.evaluate(best.parameters, views)
        checked = {
            name: evaluator.evaluate(parameters, others)
            for name, parameters in compared.items()
            if others
        }
    (context.folder / "trials.csv").write_text(trials_csv(found), encoding="utf-8")
    published = {name: each.cost for name, each in tuned.items() if name in NAMES.values()}
    which = "views that the search did not see" if checked else "views of the search"
    return Findings(
        meaning=meaning(tuned, checked, best, len(found)),
        tables=(
            headline(tuned, checked),
            parameters_table(best),
            counts_table(tuned),
            objects_table(checked or tuned, which),
        ),
        plots=(history(found, published), parallel_coordinates(found)),
        records=records(tuned, checked),
    )


def split(views: ViewSet) -> tuple[list[ViewFile], list[ViewFile]]:
    """Return the views to tune on, and others of the same objects to check the result on.

    Of each of the thesis's objects the first four, or the first half where there
    are fewer than eight; and up to four of the others. A set that knows no classes
    is taken whole.

    Raises
    ------
    InvalidInput
        The views are not of the catalogue, or of none of these objects.
    """
    if not views.is_catalogue:
        raise InvalidInput(
            f"{views.name} does not say which primitives its objects should be made of; "
            "parameters are tuned on views of the catalogue"
        )
    chosen = views.only(lambda file: views.thing(file).class_name in CLASSES | {""})
    if not chosen.files:
        raise InvalidInput(f"{views.name} has no views of {', '.join(sorted(CLASSES))}")
    held = Counter(each.object_name for each in chosen.files)
    seen: Counter[str] = Counter()
    first: list[ViewFile] = []
    rest: list[ViewFile] = []
    for each in chosen.files:
        seen[each.object_name] += 1
        half = min(TUNED_ON, (held[each.object_name] + 1) // 2)
        if seen[each.object_name] <= half:
            first.append(each)
        elif seen[each.object_name] <= half + CHECKED_ON:
            rest.append(each)
    return first, rest


def _search(
    context: Context,
    evaluator: Evaluator,
    views: tuple[TuningView, ...],
    trials: int,
    published: list[Evaluation],
) -> tuple[Trial, ...]:
    """Return the trials of the study, at least as many as asked for."""
    name = study_name(views, context.seed, published)
    with opened(context.folder, name, context.seed) as search, _progress(context.console) as bar:
        done = search.trials()
        task = bar.add_task("searching", total=trials, completed=len(done))
        while len(done) < trials:
            search.step(lambda parameters: evaluator.evaluate(parameters, views).cost)
            done = search.trials()
            lowest = min(each.cost for each in done)
            bar.update(task, completed=len(done), description=f"searching, lowest {lowest:.3f}")
        return done


def _progress(console: Console) -> Progress:
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(elapsed_when_finished=True),
        console=console,
        transient=True,
    )


def tuning(trials: int = TRIALS) -> Experiment:
    """Return the experiment with so many trials."""
    return Experiment(
        "tuning",
        "Parameters of the superquadric recovery",
        "Which of the recovery's eight parameters make the primitives that an object consists of, "
        "in size, place and number? A search with a Tree-structured Parzen Estimator, every trial "
        "asked over the public interface for the same views.",
        partial(run, trials=trials),
        thesis="A.1.1, Table A.1 and Figure A.1",
    )
