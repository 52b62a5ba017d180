"""Answers as Markdown, for the panel."""

from __future__ import annotations

import re

from shared.client.headline import headline
from shared.errors import SpargeError
from shared.schemas.answer import GraspAnswer, RejectedGrasp
from shared.schemas.execution import ExecuteResponse
from shared.schemas.task import Condition, RuleTrace

HOLDS, FAILS = "✓", "✗"
_UNITS = {"m": (1e3, "mm"), "m3": (1e6, "cm³"), "ratio": (1.0, "")}
_BOUND = re.compile(r"at_(?:least|most)\((.*), [^,()]*\)")


def answer_in_words(answer: GraspAnswer) -> str:
    """Return what to hold, why, and what came closest where nothing fits."""
    lines = [f"**{_plain(headline(answer))}**", ""]
    if answer.reason is not None:
        lines += [f"`{answer.reason.code}` {_plain(answer.reason.message)}", ""]
    why = answer.explanation
    if why is not None:
        lines += [_plain(why.text), ""]
        for trace in why.rules:
            lines += _rule(trace, "Rule")
        if why.nearest_miss is not None:
            lines += _rule(why.nearest_miss, "Nearest miss")
    left_out = {code: count for code, count in answer.scene.rejected.items() if count}
    if left_out:
        listed = ", ".join(f"{count} {code}" for code, count in left_out.items())
        lines += ["", f"*{answer.scene.candidates} hands were tried; left out: {_plain(listed)}*"]
    lines += _rehearsed(answer)
    lines += ["", f"*{answer.timings_ms.get('total', 0.0):.0f} ms, seed {answer.seed}*"]
    return "\n".join(lines)


def error_in_words(error: SpargeError) -> str:
    """Return an error with its code, and the choices where it names some."""
    text = f"**{error.code}**: {_plain(error.message)}"
    return text if error.request_id is None else f"{text} (request {error.request_id})"


def execution_in_words(outcome: ExecuteResponse) -> str:
    """Return how a try went."""
    mark = HOLDS if outcome.success else FAILS
    return f"{mark} **{outcome.outcome}**: {_plain(outcome.message)}"


def rejected_in_words(hand: RejectedGrasp) -> str:
    """Return why a hand was left out."""
    return f"left out, **{_plain(hand.reason.code)}**: {_plain(hand.reason.message)}"


def _rehearsed(answer: GraspAnswer) -> list[str]:
    """Return what came of trying grasps in simulation before they were answered, if any were."""
    came = [
        f"rank {rank}: {', '.join(grasp.rehearsed).replace('_', ' ')}"
        for rank, grasp in enumerate(answer.grasps)
        if grasp.rehearsed
    ]
    if answer.rehearsal is not None and answer.rehearsal.stopped:
        came.append(f"ended by {_plain(answer.rehearsal.stopped)}")
    return ["", f"*Tried in simulation before the answer: {'; '.join(came)}*"] if came else []


def _rule(trace: RuleTrace, kind: str) -> list[str]:
    bound = ", ".join(f"{name} = part {part}" for name, part in trace.bindings.items())
    title = f"**{kind}** `{trace.rule}`" + (f" ({_plain(bound)})" if bound else "")
    if not trace.conditions:
        return [title, ""]
    rows = [_condition(each) for each in trace.conditions]
    return [title, "", "| | condition | measured | margin |", "|-|-|-|-|", *rows, ""]


def _condition(condition: Condition) -> str:
    mark = HOLDS if condition.holds else FAILS
    cells = (_required(condition), condition.measured, margin(condition))
    return f"| {mark} | " + " | ".join(map(_plain, cells)) + " |"


def _required(condition: Condition) -> str:
    """Return what a condition asks for, as in `width(ID) >= 0.045 m`."""
    bound = _BOUND.fullmatch(condition.predicate)
    if bound is not None:
        return f"{bound[1]} {condition.required}"
    if condition.required in ("holds", "any", ""):
        return condition.predicate
    return condition.required


def margin(condition: Condition) -> str:
    """Return how far inside (+) or outside (-) of its bound a condition is."""
    if condition.margin is None:
        return ""
    factor, unit = _UNITS.get(condition.unit or "", (1.0, condition.unit or ""))
    return f"{factor * condition.margin:+.3g} {unit}".strip()


def _plain(text: str) -> str:
    """Return text that Markdown leaves as it is."""
    for mark in "\\|*_`[]<>#":
        text = text.replace(mark, f"\\{mark}")
    return text.replace("\n", " ")
