"""Why a hand pose that was considered is not among the grasps."""

from __future__ import annotations

import operator
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from shared.wire import ArrayField

RejectionCode = Literal[
    "from_below",
    "support_plane",
    "too_wide",
    "finger_collides_object",
    "palm_collides_object",
    "cup_collides_object",
    "sweep_collides",
    "obstacle",
    "no_contact",
    "not_antipodal",
    "no_seal",
    "too_heavy",
    "other_depth_better",
    "less_promising",
    "better_grasp_nearby",
    "outside_region",
    "beyond_max_grasps",
]
"""In the order in which an answer lists them; docs/rejected.md has each with its condition."""

WHY_REJECTED: dict[RejectionCode, str] = {
    "from_below": "the hand would have to come from under what the object stands on",
    "support_plane": "fingers, palm or cup would be too near to the support plane, or on the way",
    "too_wide": "what lies between the fingers is wider than the hand opens",
    "finger_collides_object": "a finger would be inside the object",
    "palm_collides_object": "the palm would be inside the object, or too near to it",
    "cup_collides_object": "the cup, or the palm behind it, would be inside the object",
    "sweep_collides": "free where it would close, but the hand hits the object on its way in",
    "obstacle": "the hand, or what is between the fingers, meets another thing there or on the way",
    "no_contact": "the pads would close on nothing, or on one side of something",
    "not_antipodal": "the pads would close on a slope and squeeze the part away",
    "no_seal": "the surface under the cup's lip has an edge, a gap or a bump",
    "too_heavy": "the vacuum there does not hold the weight, as far as it is known",
    "other_depth_better": "the same hand holds the part better from nearer or farther away",
    "less_promising": "possible, but enough others are better",
    "better_grasp_nearby": "possible, but nearly the same as a better one: left out for variety",
    "outside_region": "possible, but it holds another part than the one for the task",
    "beyond_max_grasps": "possible, but max_grasps better ones are in the answer",
}
"""One line each, for people."""

ORDER: dict[str, int] = {code: place for place, code in enumerate(WHY_REJECTED)}

MAX_REJECTED = 200
Examples = Annotated[int, Field(ge=0, le=MAX_REJECTED)]
"""How many rejected hand poses an answer may hold."""
RejectedRows = Annotated[NDArray[np.float64], ArrayField("float64", ("R", 8))]
"""x y z qx qy qz qw width; the frame is that of a grasp."""

LeftOut = Annotated[RejectedRows | None, Field(exclude_if=lambda rows: rows is None)]
LeftOutFor = Annotated[tuple[RejectionCode, ...], Field(exclude_if=operator.not_)]
"""In an answer only where the request asks for rejected hand poses."""
