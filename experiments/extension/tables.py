"""The tables and the plot of experiment 1."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.extension.lesson import AFTER, BEFORE, BUILT_IN, REMOVED, Taught
from experiments.framework import Plot, Share, Table
from experiments.framework.asking import VERSION_NAMES, VERSIONS
from experiments.framework.cells import Cell
from experiments.framework.plots import new_figure, share_bars
from shared.schemas.task import TaskDefinition


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
        "Before, after and removed again are one and the same new task, with the relations of "
        "cutting under a name of its own; built in is cutting as it is shipped, for comparison.",
    )


def _answer(known: Share) -> str:
    if known.count == known.total:
        return "known"
    return "unknown" if not known.count else "partly known"


def steps(lesson: TaskDefinition, outcomes: Sequence[Taught], taught_ms: float) -> Table:
    """Return what had to be done for each version."""
    relations = len(lesson.requires) + len(lesson.grasp) + len(lesson.avoids)
    built_in = {_key(each): each.region for each in outcomes if each.stage == BUILT_IN}
    after = [each for each in outcomes if each.stage == AFTER and each.asked.reasoning == "v2"]
    rule = (
        "a Prolog rule in the rule set (Code 6.1: conditions on two parts), and a new start; "
        "POST /tasks adds no Version 1 rules. Cutting has such a rule built in."
    )
    message = (
        f"{relations} relations in one POST /tasks: requires {_listed(lesson.requires)}; "
        f"grasp {_listed(lesson.grasp)}; avoids {_listed(lesson.avoids)}. The rule for the "
        "affordance cut (Code 6.3) is shipped; an affordance without a rule needs one, too."
    )
    equal = Share.of(each.region == built_in[_key(each)] for each in after)
    return Table(
        "steps",
        "What it takes to add a task",
        ("reasoning", "at run time", "what has to be written", "how long", "result"),
        (
            (
                "v1",
                "no",
                rule,
                "–",
                "not measured at run time; the rows 'built in' show the shipped rule",
            ),
            (
                "v2",
                "yes",
                message,
                f"{taught_ms:.0f} ms",
                f"the same region as the built-in task, point by point, in {equal.brief()} views",
            ),
        ),
        "The thesis shows the structure of the rules and reports no figures for this experiment.",
    )


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
        for version, stage in (("v2", BEFORE), ("v2", AFTER), ("v1", BUILT_IN), ("v2", BUILT_IN))
    }
    colours = dict(zip(bars, ("#9A9A9A", "#D9792B", "#2F6DB5", "#F0B98A"), strict=True))
    share_bars(axes, things, bars, colours=colours)
    figure.legend(loc="outside upper center", ncols=4, fontsize=9, frameon=False)
    return Plot(
        "extension",
        f"Views ({source}) in which the best grasp for cutting is on the handle, before and after "
        "Version 2 is taught the task; whiskers are 95 % intervals.",
        figure,
    )
