"""One readable paragraph about a proof, with lengths in millimetres.

Every number and every verdict comes from Prolog; only the wording is ours.
"""

from __future__ import annotations

from collections.abc import Sequence

from services.reasoning.phrases import millimetres
from services.reasoning.wholes import Wholes
from services.reasoning.wording import failing_wish, holding_clause, joined, size_of
from shared.errors import JsonObject

_SCALED = ("min_dimension", "max_dimension", "min_ratio", "max_ratio", "at_least", "at_most")
_OBVIOUS = 0.99
"""A quantity that meets its bound with this support is not spelt out in the paragraph."""


def explain_found(task: str, decision: JsonObject, parts: Wholes) -> str:
    """Say which part to hold, by which rules, and which condition was closest to failing."""
    region, traces = decision["regions"][0], decision["traces"]
    sentences = [_what_to_hold(task, region, parts), *(_why(trace, parts) for trace in traces)]
    close = _closest_call(traces)
    if close:
        sentences.append(close)
    sentences += [_too_thick(each) for each in decision["too_thick"]]
    others = parts.ids([part for other in decision["regions"][1:] for part in other["parts"]])
    if others:
        sentences.append(f"{joined([f'Part {part}' for part in others])} would do as well.")
    return " ".join(sentences)


def explain_miss(
    task: str, why: str, miss: JsonObject | None, parts: Wholes, lacking: Sequence[str]
) -> str:
    """Say that nothing was found, and what came closest to changing that."""
    if miss is None:
        return why
    failing = [each for each in miss["conditions"] if not each["holds"]]
    kind = failing[0]["kind"]
    if kind == "avoided":
        return f"{why} {_nearly_free(failing[0])}"
    affordance = miss["rule"].rsplit(":", 1)[1] if "/version2:" in miss["rule"] else None
    role = f"would count as {affordance}" if affordance else f"could be held for {task}"
    main = miss["part"]
    others = sorted(set(miss["bindings"].values()) - {main})
    wishes = joined([failing_wish(each, own=each["part"] == main) for each in failing])
    beside = f" beside {joined([_named(part, parts) for part in others])}" if others else ""
    missing = "" if len(lacking) < 2 else f" Of {joined(lacking)}, {affordance} is nearest."
    return (
        f"{why}{missing} The nearest miss, of the rule {miss['rule']}: "
        f"{_named(main, parts)}{beside} {role} if {wishes}."
    )


def explain_joining(parts: Wholes) -> list[str]:
    """Say which pieces were taken for one part, a sentence each."""
    return [
        f"Parts {joined(pieces)} continue each other and count as one, called part {whole}."
        for whole, pieces in sorted(parts.pieces.items())
    ]


def _what_to_hold(task: str, region: JsonObject, parts: Wholes) -> str:
    numbers = parts.ids(region["parts"])
    what = f"part {numbers[0]}" if len(numbers) == 1 else f"any of the parts {joined(numbers)}"
    label = region["affordance"]
    why = f": it is the part to {label.replace('_', ' ')}" if label else ""
    return f"Hold {what} for {task}{why}."


def _why(trace: JsonObject, parts: Wholes) -> str:
    rule = trace["rule"]
    if rule.startswith("relations:"):
        return _relations(trace["conditions"])
    grouped: dict[int | None, list[str]] = {}
    spelt_out = _worth_telling(trace["conditions"])
    for condition in spelt_out:
        grouped.setdefault(condition["part"], []).append(holding_clause(condition))
    told = [
        f"{_named(part, parts)} {joined([clause for clause in clauses if clause])}"
        for part, clauses in grouped.items()
        if part is not None and any(clauses)
    ]
    clear = len(trace["conditions"]) - len(spelt_out)
    if clear:
        told.append(f"further conditions that are clearly met: {clear}")
    return f"The rule {rule} holds: {'; '.join(told)}."


def _worth_telling(conditions: Sequence[JsonObject]) -> list[JsonObject]:
    """Return the conditions without the clearly met ones, of which two are told if all are."""
    measured = [each for each in conditions if each["kind"] in ("at_least", "at_most")]
    clear = [each for each in measured if each["support"] >= _OBVIOUS]
    if len(clear) == len(measured):
        clear = sorted(clear, key=lambda each: float(each["support"]))[2:]
    return [each for each in conditions if not any(each is one for one in clear)]


def _relations(conditions: Sequence[JsonObject]) -> str:
    told = []
    required = [each for each in conditions if "requiresAffordance" in each["predicate"]]
    if required:
        listed = joined([f"{each['measured']} (part {each['part']})" for each in required])
        told.append(f"The object has what the task requires: {listed}.")
    freed = [each for each in conditions if each["kind"] == "avoided"]
    if freed:
        labels = joined(sorted({each["measured"] for each in freed}))
        listed = "; ".join(_not_avoided(each) for each in freed)
        told.append(f"The task leaves parts that count as {labels} free: {listed}.")
    alone = [each["required"][0] for each in conditions if each["kind"] == "alone"]
    if alone:
        told.append(
            f"The task would leave parts that count as {joined(alone)} free, "
            "but the object offers nothing else."
        )
    return " ".join(told)


def _not_avoided(condition: JsonObject) -> str:
    because = condition.get("because")
    reason = f", which it would if {failing_wish(because, own=True)}" if because else ""
    return f"part {condition['part']} does not count as {condition['measured']}{reason}"


def _nearly_free(condition: JsonObject) -> str:
    because = condition.get("because")
    tight = f", least clearly because it {holding_clause(because)}" if because else ""
    part, label = condition["part"], condition["measured"]
    return f"Nearest to being held is part {part}: it counts as {label}{tight}."


def _too_thick(thick: JsonObject) -> str:
    thickness, opening = thick["thickness"], thick["opening"]
    return (
        f"Part {thick['part']} would fit between the fingers if it were "
        f"{millimetres(thickness - opening)} mm thinner ({millimetres(thickness)} mm where the "
        f"gripper opens {millimetres(opening)} mm)."
    )


def _closest_call(traces: Sequence[JsonObject]) -> str:
    measured = [
        condition
        for trace in traces
        for condition in trace["conditions"]
        if condition["kind"] in _SCALED
        and condition["support"] is not None
        and condition["support"] < 0.95
    ]
    if not measured:
        return ""
    closest = min(measured, key=lambda each: float(each["support"]))
    return f"The closest call: part {closest['part']} {holding_clause(closest)}."


def _named(part: int, parts: Wholes) -> str:
    primitive = parts.part(part)
    return f"part {part} (a {primitive.shape_class} of {size_of(primitive.full_extents)})"
