"""Conditions of a rule, each with its distance from its bound."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.pictures.small import figure
from shared.schemas.task import Condition, RuleTrace

INSIDE, OUTSIDE = "#3B8F5A", "#C8402F"
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
VARIABLE = re.compile(r"\b[A-Z]\w*")
FARTHEST = 8.0
"""Times the bound at which a bar ends with an arrow."""


@dataclass(frozen=True)
class Bar:
    """One condition: `ratio` is above 1 inside the bound, below 1 outside."""

    label: str
    says: str
    ratio: float


def bars(trace: RuleTrace) -> list[Bar]:
    """Return the conditions of a rule that have a scale, in the rule's order, each once."""
    found: dict[str, Bar] = {}
    for each in trace.conditions:
        measured, required = NUMBER.search(each.measured), NUMBER.search(each.required)
        if measured is None or required is None or each.margin is None:
            continue
        value, bound = float(measured[0]), float(required[0])
        if value <= 0 or bound <= 0:
            continue
        ratio = value / bound if ">=" in each.required else bound / value
        found[f"{each.predicate} of {each.primitive_id}"] = Bar(
            named(each, trace), said(each), ratio
        )
    return list(found.values())


def named(condition: Condition, trace: RuleTrace) -> str:
    """Return what a condition measures, with parts in the place of variables.

    A rule that enters another one names its parts anew, so the variables of a condition
    are not those of the rule: the first is the part that was measured, the second the
    other one of the two that the rule is about.
    """
    inner = re.sub(r"^at_(?:least|most)\((.*), [^,]*\)$", r"\1", condition.predicate)
    variables = list(dict.fromkeys(VARIABLE.findall(inner)))
    others = [part for part in trace.bindings.values() if part != condition.primitive_id]
    parts = [condition.primitive_id, *others]
    for variable, part in zip(variables, parts, strict=False):
        inner = re.sub(rf"\b{variable}\b", f"part {part}", inner)
    return inner.replace("/", " / ").replace("_", " ")


def said(condition: Condition) -> str:
    """Return measured and required value; lengths in millimetres."""

    def millimetres(match: re.Match[str]) -> str:
        return f"{1e3 * float(match[1]):.3g} mm"

    pair = (
        re.sub(r"(\d\S*) m$", millimetres, each)
        for each in (condition.measured, condition.required)
    )
    return ", required ".join(pair)


def draw_margins(panels: Sequence[tuple[str, RuleTrace]]) -> Figure:
    """Return a figure with a panel per rule: how far every condition is inside its bound."""
    rows = [bars(trace) for _, trace in panels]
    heights = [len(each) + 2.2 for each in rows]
    drawn = figure(1000, int(34 * sum(heights)) + 30)
    axes = drawn.subplots(len(panels), 1, height_ratios=heights, squeeze=False)[:, 0]
    for place, (title, _), conditions in zip(axes, panels, rows, strict=True):
        _draw(place, title, conditions)
    drawn.subplots_adjust(left=0.30, right=0.985, top=0.97, bottom=0.06, hspace=0.2)
    return drawn


def _draw(axes: Axes, title: str, conditions: list[Bar]) -> None:
    edge = math.log2(FARTHEST)
    for row, bar in enumerate(conditions):
        reach = max(-edge, min(edge, math.log2(bar.ratio)))
        colour = INSIDE if bar.ratio >= 1 else OUTSIDE
        axes.barh(row, reach, color=colour, height=0.62)
        if abs(math.log2(bar.ratio)) > edge:
            side = ">" if reach > 0 else "<"
            axes.plot(reach, row, marker=side, color=colour, markersize=9, clip_on=False)
        inside = bar.ratio >= 1
        axes.text(
            -0.06 if inside else 0.06,
            row,
            bar.says,
            ha="right" if inside else "left",
            va="center",
            fontsize=8.5,
            color="#444444",
        )
    axes.axvline(0, color="black", linewidth=1.2)
    axes.set_yticks(range(len(conditions)), [bar.label for bar in conditions], fontsize=9)
    axes.invert_yaxis()
    axes.set_xlim(-edge - 0.15, edge + 0.15)
    ticks = [1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8]
    names = ["8 times\noutside", "4", "2", "at the\nbound", "2", "4", "8 times\ninside"]
    axes.set_xticks([math.log2(each) for each in ticks], names, fontsize=8)
    axes.set_title(title, fontsize=11, loc="left", fontweight="bold")
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.tick_params(length=0)
