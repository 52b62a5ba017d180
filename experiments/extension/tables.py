"""The tables and the plot of experiment 1."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.extension.lesson import AFTER, BEFORE, BUILT_IN, REMOVED, Taught
from experiments.extension.teaching import CUT, Lesson, Took
from experiments.framework import Plot, Share, Table
from experiments.framework.asking import VERSION_NAMES, VERSIONS
from experiments.framework.cells import Cell
from experiments.framework.plots import new_figure, share_bars
from shared.schemas.rule import RuleDefinition

_COLOURS = ("#9A9A9A", "#2F6DB5", "#A9C7E8", "#C4C4C4", "#D9792B", "#F0B98A")
"""Before, after and built in, of Version 1 and then of Version 2."""


def lessons(outcomes: Sequence[Taught]) -> Table:
    """Return one line for each object, version and stage."""
    keys = dict.fromkeys((each.asked.source, each.asked.thing) for each in outcomes)
    rows: list[tuple[Cell, ...]] = []
    for source, thing in keys:
        for version in VERSIONS:
            for stage in (BEFORE, AFTER, REMOVED, BUILT_IN):
                mine = [
                    each.asked
                    for each in outcomes
                    if (each.asked.source, each.asked.thing) == (source, thing)
                    and (each.asked.reasoning, each.stage) == (version, stage)
                ]
                known = Share.of(each.known for each in mine)
                rows.append(
                    (
                        source,
                        thing,
                        version,
                        stage,
                        _answer(known),
                        Share.of(each.found for each in mine),
                        Share.of(each.good for each in mine),
                        Share.of(each.grasp_in_region for each in mine),
                    )
                )
    return Table(
        "extension",
        "Cutting, taught at run time",
        ("views", "object", "reasoning", "task", "task is", "found", "good", "grasp in region"),
        tuple(rows),
        "Before, after and removed again are one and the same new task, taught under a name of "
        "its own; built in is cutting as it is shipped, for comparison.",
    )


def _answer(known: Share) -> str:
    if known.count == known.total:
        return "known"
    return "unknown" if not known.count else "partly known"


def steps(lesson: Lesson, outcomes: Sequence[Taught], took: Took) -> Table:
    """Return what had to be done for each version."""
    task = lesson.task
    conditions = " and ".join(str(len(rule.conditions)) for rule in lesson.rules)
    parts = " and ".join(sorted({str(_parts(rule)) for rule in lesson.rules}))
    rules = f"{len(lesson.rules)} rules with {conditions} conditions on {parts} parts each"
    requires, grasp, avoids = (
        _listed([CUT if name == lesson.affordance.name else name for name in names])
        for names in (task.requires, task.grasp, task.avoids)
    )
    by_rule = f"{rules}, one POST /rules each (the structure of Code 6.1)"
    relations = (
        f"a new affordance {CUT} with {rules}, in one POST /affordances (Code 6.3); "
        f"{len(task.requires) + len(task.grasp) + len(task.avoids)} relations in one POST /tasks: "
        f"requires {requires}; grasp {grasp}; avoids {avoids}. The affordance to grasp is used "
        "again"
    )
    return Table(
        "steps",
        "What it takes to add a task",
        ("reasoning", "at run time", "what has to be written", "learned in", "result"),
        (
            ("v1", "yes", by_rule, f"{took.version_1_ms:.0f} ms", _as_built_in(outcomes, "v1")),
            ("v2", "yes", relations, f"{took.version_2_ms:.0f} ms", _as_built_in(outcomes, "v2")),
        ),
        "All of it is JSON; nobody writes Prolog and nothing is started anew. The affordance's "
        "rules are those of Version 1, asked for the other part. A task whose affordances all "
        "exist takes POST /tasks alone. The thesis shows the structure of the rules and reports "
        "no figures for this experiment.",
    )


def _parts(rule: RuleDefinition) -> int:
    return len({rule.part, *(name for each in rule.conditions for name in each.of)})


def _as_built_in(outcomes: Sequence[Taught], version: str) -> str:
    mine = [each for each in outcomes if each.asked.reasoning == version]
    built_in = {_key(each): each.region for each in mine if each.stage == BUILT_IN}
    same = Share.of(each.region == built_in[_key(each)] for each in mine if each.stage == AFTER)
    return f"the same region as the shipped task, point by point, in {same.brief()} views"


def _key(taught: Taught) -> tuple[str, str, str, str]:
    asked = taught.asked
    return asked.source, asked.thing, asked.view, asked.reasoning


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names) or "nothing"


def bars(outcomes: Sequence[Taught]) -> Plot:
    """Draw how often the best grasp is on the handle, by object and stage."""
    source = outcomes[0].asked.source
    things = list(
        dict.fromkeys(each.asked.thing for each in outcomes if each.asked.source == source)
    )
    figure = new_figure(9.0, 3.8)
    axes = figure.subplots()
    bars = {
        f"{VERSION_NAMES[version]}, {stage}": [
            Share.of(
                each.asked.grasp_in_region
                for each in outcomes
                if (each.asked.source, each.asked.thing) == (source, thing)
                and (each.asked.reasoning, each.stage) == (version, stage)
            )
            for thing in things
        ]
        for version in VERSIONS
        for stage in (BEFORE, AFTER, BUILT_IN)
    }
    colours = dict(zip(bars, _COLOURS, strict=True))
    share_bars(axes, things, bars, colours=colours)
    figure.legend(loc="outside upper center", ncols=3, fontsize=9, frameon=False)
    return Plot(
        "extension",
        f"Views ({source}) in which the best grasp for cutting is on the handle, before and after "
        "both versions are taught the task; whiskers are 95 % intervals.",
        figure,
    )
