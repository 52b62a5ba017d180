"""Why nothing was found; docs/reasons.md lists the codes for clients."""

from __future__ import annotations

from shared.errors import JsonObject
from shared.schemas.task import Reason

_MESSAGES = {
    "no_primitives": "The object has no recovered parts to reason about.",
    "no_part_matches": "No part can be held for {task}: none satisfies its rule.",
    "object_lacks_affordance": "The object does not afford {task}: no part counts as {lacking}.",
    "no_grasp_part": "No part can be held for {task}: none counts as {lacking}.",
    "every_part_avoided": "Every part that could be held for {task} is one that it leaves free.",
}

CODES = frozenset(_MESSAGES)


def reason_for(task: str, decision: JsonObject) -> Reason:
    """Return the reason for a decision that found nothing."""
    code = decision["outcome"]
    lacking = " or ".join(decision["lacking"])
    return Reason(code=code, message=_MESSAGES[code].format(task=task, lacking=lacking))
