"""The parameters of POST /grasp, typed, and how they are written into a query."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike

from shared.schemas.primitive import EmsParameters, Method
from shared.schemas.rehearsal import Rehearsing
from shared.schemas.scene import InputKind
from shared.schemas.task import RuleSet, Version
from shared.wire import Message


class GraspParameters(TypedDict, total=False):
    """What may be said beside view and task; the backend has the defaults (docs/http-api.md)."""

    reasoning: Version
    rule_set: RuleSet | None
    """Which rules decide; None: the backend's own."""
    input: InputKind
    """`scene`: find the object first; `object`: the points are the object."""
    viewpoint: ArrayLike
    """Position (3,) of the sensor in the view's frame, metres."""
    target: ArrayLike | None
    """Position (3,): pick the object nearest to it; None: the most central one."""
    gripper: str
    max_grasps: int
    seed: int
    method: Method | None
    recovery: EmsParameters | Mapping[str, Any] | str | None
    """Parameters of the method `ems`: a message, or a mapping or JSON of its names."""
    explain: bool
    rehearsal: Rehearsing | None
    """Whether grasps are tried in simulation before they are answered; None: the backend's way."""
    rejected: int
    """How many hand poses that were left out the answer holds, `answer.rejected`; 0: none."""
    frame_id: str
    """Name of the view's frame; the answer's poses are in it."""
    intrinsics: ArrayLike | None
    """Pinhole matrix (3, 3) in pixels, beside a depth image."""
    depth_scale: float | None
    """Metres per unit of a depth image; needed for integers."""


def as_texts(parameters: Mapping[str, Any]) -> dict[str, str]:
    """Return parameters as texts: vectors, matrices, mappings and messages as JSON."""
    texts: dict[str, str] = {}
    for name, value in parameters.items():
        if value is None:
            continue
        if isinstance(value, bool):
            texts[name] = str(value).lower()
        elif isinstance(value, str | int | float):
            texts[name] = str(value)
        elif isinstance(value, Message):
            texts[name] = value.model_dump_json()
        elif isinstance(value, Mapping):
            texts[name] = json.dumps(dict(value))
        else:
            texts[name] = str(np.asarray(value).tolist())
    return texts
