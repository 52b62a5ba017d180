"""The model's card: what it is, what it was trained on, how good it is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from services.grasp_proposal.training.lessons import Lessons, objects_of
from services.grasp_proposal.training.network import HEADS

_NAMES = {
    "network": "network (shipped kind)",
    "boosting": "gradient boosting on the numbers",
    "geometric": "geometric score",
}


def card(lessons: Lessons, figures: Mapping[str, Any], command: str, sha256: str) -> str:
    """Return the card as Markdown."""
    objects = len(np.unique(objects_of(lessons)))
    lifted, held = 100 * lessons.lifted.mean(), 100 * lessons.held.mean()
    chance, oracle = figures["chance"], figures["oracle"]
    return f"""# grasp_scorer.onnx

Scores grasps of a parallel gripper. In: `images` (G, 15, 20, 20), what is about the closing
region, and `numbers` (G, M), as `services/grasp_proposal/learned.py` makes them. Out: `logit`
(G,), the log odds that a grasp lifts the object, Platt-scaled from the log odds of two heads:
{HEADS[0]} of that it lifts, {HEADS[1]} of that it keeps the object when shaken and tilted, too.

Made by `{command}`, sha256
`{sha256}`.

Trained on {len(lessons)} grasps tried in physics on {objects} objects, random variants of the
catalogue's classes, and bottles that are held by their caps, alone on a table, with and without
stereo noise (`python -m experiments.trials`). {lifted:.0f} % of the grasps lift, {held:.0f} % keep
the object when shaken. {int(lessons.moved.sum())} of them were moved by some millimetres and
degrees; these only teach.

Figures over {figures["grasps"]} grasps as they were proposed, of {figures["views"]} questions,
each scored by networks that were trained without its object (cross-validation by objects; the
shipped networks saw all of them). Best of view: of the tried grasps of a question,
the one with the highest score.

| score | AP lift | AUC lift | AP held | AUC held | best of view lifts | keeps |
| --- | --- | --- | --- | --- | --- | --- |
{_rows(figures["scores"])}
| chance | {chance["lifted"]:.3f} | 0.500 | {chance["held"]:.3f} | 0.500 \
| {_percent(chance["lifted"])} | {_percent(chance["held"])} |
| any of the tried | | | | | {_percent(oracle["lifted"])} | {_percent(oracle["held"])} |

Expected calibration error of lifting (10 bins): {figures["calibration_error"]:.3f}.

How often the best of view keeps the object, by what it is:

| kind | questions | network | boosting | geometric | any of the tried |
| --- | --- | --- | --- | --- | --- |
{_kinds(figures["kinds"])}
"""


def _rows(scores: Mapping[str, Mapping[str, Mapping[str, float]]]) -> str:
    rows = []
    for key, name in _NAMES.items():
        lift, held = scores[key]["lifted"], scores[key]["held"]
        rows.append(
            f"| {name} | {lift['ap']:.3f} | {lift['auc']:.3f} | {held['ap']:.3f} "
            f"| {held['auc']:.3f} | {_percent(lift['top1'])} | {_percent(held['top1'])} |"
        )
    return "\n".join(rows)


def _kinds(kinds: Mapping[str, Mapping[str, float]]) -> str:
    return "\n".join(
        f"| {name} | {each['views']} | "
        + " | ".join(_percent(each[key]) for key in (*_NAMES, "any"))
        + " |"
        for name, each in kinds.items()
    )


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"
