"""What came of the search, as tables."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence

import numpy as np

from experiments.framework import MeanStd, Share, Table
from experiments.framework.cells import Cell
from experiments.tuning.evaluation import Evaluation
from experiments.tuning.figures import THESIS_COST
from experiments.tuning.space import SPACE
from experiments.tuning.study import Trial
from shared.schemas.primitive import PRESETS, EmsParameters

Evaluations = Mapping[str, Evaluation]
"""By the name of the parameters."""

NAMES = {"simulation": "thesis, simulation", "real_world": "thesis, real-world"}
"""Of the published parameters, by preset."""


def headline(tuned: Evaluations, checked: Evaluations) -> Table:
    """Return one line for each set of parameters.

    Parameters
    ----------
    tuned : mapping
        On the views of the search.
    checked : mapping
        On other views of the same objects; empty where there are none.
    """
    rows: list[tuple[Cell, ...]] = []
    for name, evaluation in tuned.items():
        other = checked.get(name)
        rows.append(
            (
                name,
                evaluation.cost,
                THESIS_COST if name == NAMES["simulation"] else None,
                *_parts(evaluation),
                other.cost if other else None,
                _expected_number(other) if other else None,
                Share.of(each.good for each in other.outcomes) if other else None,
            )
        )
    views = len(next(iter(tuned.values())).outcomes)
    others = len(next(iter(checked.values())).outcomes) if checked else 0
    return Table(
        "tuning",
        "Tuning of the superquadric recovery",
        (
            "parameters",
            "cost",
            "thesis cost",
            "expected number",
            "size error",
            "spatial error",
            "cost, other views",
            "expected number, other views",
            "good regions, other views",
        ),
        tuple(rows),
        f"Cost of Eq. A.1 to A.3: the mean over {views} views of (size error + spatial error) / 2, "
        "or 1 where the number of primitives is not the expected one; both errors, tanh of a sum "
        "of differences in metres, are shown for the views with the expected number. The "
        f"parameters found were chosen on these views; the columns at the right are {others} other "
        "views of the same objects. Good regions: IoU >= 0.7 for the object's first task, Version "
        "2. The thesis's 0.2 is of its own objects, cloud density and hand-made expected sizes.",
    )


def parameters_table(best: Trial) -> Table:
    """Return Table A.1 with a column of ours."""
    rows = tuple(
        (
            tuned.thesis_name,
            tuned.description,
            tuned.range_text,
            *(_shown(each, tuned.name) for each in PRESETS.values()),
            _shown(best.parameters, tuned.name),
        )
        for tuned in SPACE
    )
    return Table(
        "parameters",
        f"Parameters beside Table A.1; ours are of trial {best.number}",
        ("parameter", "meaning", "range", *(f"thesis {name}" for name in PRESETS), "ours"),
        rows,
        "As POST /grasp takes the best ones: recovery=" + best.parameters.model_dump_json(),
    )


def counts_table(evaluations: Evaluations) -> Table:
    """Return how many primitives were recovered."""
    numbers = {name: [each.recovered for each in e.outcomes] for name, e in evaluations.items()}
    most = max(max(each) for each in numbers.values())
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (name, *(held.count(number) for number in range(most + 1)))
        for name, held in numbers.items()
    )
    expected = {len(each.view.expected) for each in next(iter(evaluations.values())).outcomes}
    return Table(
        "counts",
        "Views by the number of primitives recovered",
        ("parameters", *(str(number) for number in range(most + 1))),
        rows,
        f"Expected: {', '.join(map(str, sorted(expected)))}. Views of the search.",
    )


def objects_table(evaluations: Evaluations, which: str) -> Table:
    """Return the cost by object and set of parameters."""
    first = next(iter(evaluations.values()))
    things = list(dict.fromkeys(each.view.thing for each in first.outcomes))
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            thing,
            *(
                MeanStd.of(e.cost.total for e in evaluation.outcomes if e.view.thing == thing)
                for evaluation in evaluations.values()
            ),
        )
        for thing in things
    )
    return Table("objects", f"Cost by object, {which}", ("object", *evaluations), rows, detail=True)


def meaning(tuned: Evaluations, checked: Evaluations, best: Trial, trials: int) -> str:
    """Return the findings in a few sentences; the last of `tuned` are the parameters found."""
    judged = checked or tuned
    published, found = judged[NAMES["simulation"]], list(judged.values())[-1]
    change = [
        new.cost.total - old.cost.total
        for new, old in zip(found.outcomes, published.outcomes, strict=True)
    ]
    error = float(np.std(change, ddof=1) / np.sqrt(len(change))) if len(change) > 1 else np.nan
    where = "views that the search did not see" if checked else "the views of the search"
    good = [Share.of(e.good for e in each.outcomes) for each in (published, found)]
    return (
        f"Of {trials} trials, number {best.number} costs least, {best.cost:.3f}. On {where} its "
        f"parameters cost {found.cost:.3f} instead of the {published.cost:.3f} of the thesis's "
        f"simulation column (difference {np.mean(change):+.3f}, standard error {error:.3f}), and "
        f"{good[1].count} instead of {good[0].count} of {good[0].total} regions are good."
    )


def records(tuned: Evaluations, checked: Evaluations) -> list[dict[str, str]]:
    """Return one line for each view and set of parameters."""
    return [
        {
            "parameters": name,
            "views": kind,
            "object": each.view.thing,
            "view": str(each.view.number),
            "expected": str(len(each.view.expected)),
            "recovered": str(each.recovered),
            "size_error": _number(each.cost.size),
            "spatial_error": _number(each.cost.spatial),
            "cost": _number(each.cost.total),
            "good_region": str(each.good).lower(),
        }
        for kind, evaluations in (("search", tuned), ("other", checked))
        for name, evaluation in evaluations.items()
        for each in evaluation.outcomes
    ]


def trials_csv(trials: Sequence[Trial]) -> str:
    """Return all trials as CSV."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["trial", "cost", *(tuned.name for tuned in SPACE)])
    for each in trials:
        values = (_shown(each.parameters, tuned.name) for tuned in SPACE)
        writer.writerow([each.number, f"{each.cost:.6f}", *values])
    return stream.getvalue()


def _parts(evaluation: Evaluation) -> tuple[Share, MeanStd, MeanStd]:
    return (
        _expected_number(evaluation),
        MeanStd.of(each.cost.size for each in evaluation.outcomes),
        MeanStd.of(each.cost.spatial for each in evaluation.outcomes),
    )


def _expected_number(evaluation: Evaluation) -> Share:
    return Share.of(each.recovered == len(each.view.expected) for each in evaluation.outcomes)


def _shown(parameters: EmsParameters, name: str) -> str:
    value = getattr(parameters, name)
    return f"{value:.3g}" if isinstance(value, float) else str(value).lower()


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.6f}"
