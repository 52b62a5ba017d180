"""What the tools return: the answers, in as few words as an agent needs."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field

Position = Annotated[
    tuple[float, float, float], Field(description="x, y, z in metres, in the frame `frame_id`")
]


class Part(BaseModel):
    """A part of the object, as it was recovered from the view."""

    id: int
    shape: str = Field(description="cuboid, cylinder or sphere")
    extents_mm: tuple[float, float, float] = Field(
        description="full extents along the part's own axes, in millimetres"
    )
    affordances: tuple[str, ...] = Field(description="what it affords (reasoning v2)")


class GraspPose(BaseModel):
    """A way to hold the object.

    The gripper's frame lies midway between the finger tips: +z points towards the object
    (approach), +y is the direction in which the fingers close.
    """

    position: Position
    quaternion_xyzw: tuple[float, float, float, float] = Field(
        description="orientation of the gripper's frame in `frame_id`"
    )
    approach: tuple[float, float, float] = Field(
        description="unit vector along which the gripper approaches, in `frame_id`"
    )
    pregrasp_position: Position = Field(description="start of the straight approach; same turn")
    retreat_position: Position = Field(description="where to lift the object to; same turn")
    width_m: float = Field(description="opening that the grasp needs, in metres")
    score: float = Field(description="estimated probability that it lifts the object")
    rehearsed: tuple[str, ...] = Field(
        description="what came of trying it in simulation before it was answered, once on each of "
        "two guesses of the object's hidden side; the score takes account of it; empty: not tried"
    )


class Condition(BaseModel):
    """A condition of a rule, as it was measured."""

    condition: str
    part: int | None
    holds: bool
    measured: str
    required: str
    margin: float | None = Field(
        description="how far inside (>= 0) or outside (< 0) the bound, in `unit`; null: no scale"
    )
    unit: str | None


class RuleTried(BaseModel):
    """A rule, tried on the parts that stand for its variables."""

    rule: str
    holds: bool
    parts: dict[str, int] = Field(description="which part stands for which variable")
    conditions: tuple[Condition, ...]


class Miss(BaseModel):
    """The rule that came closest, and the conditions that failed."""

    rule: str
    failed: tuple[Condition, ...]


class Reason(BaseModel):
    """Why something is empty."""

    code: str
    message: str


class Held(BaseModel):
    """The part to hold."""

    parts: tuple[int, ...] = Field(description="ids of the parts")
    affordance: str | None = Field(description="what made it the part to hold (reasoning v2)")
    confidence: float


class GraspAnswer(BaseModel):
    """Where and how to hold the object for the task."""

    request_id: str = Field(description="for the tool `explain`")
    task: str
    found: bool = Field(description="whether a part of this object is fit to be held for the task")
    reason: Reason | None = Field(description="why nothing was found, or why there are no grasps")
    hold: Held | None
    frame_id: str = Field(description="the frame of all poses: that of the view")
    gripper: str
    parts: tuple[Part, ...]
    grasps: tuple[GraspPose, ...] = Field(description="best first, each on the part to hold")
    explanation: str = Field(description="the reasoning, in words")
    nearest_miss: Miss | None = Field(description="where nothing was found: what was missing")


class ExplainAnswer(BaseModel):
    """Why an earlier request was answered as it was."""

    request_id: str
    task: str
    found: bool
    reason: Reason | None
    hold: Held | None
    alternatives: tuple[Held, ...] = Field(description="other parts that would do, best first")
    explanation: str
    rules: tuple[RuleTried, ...] = Field(description="those that hold and led to the answer")
    nearest_miss: RuleTried | None = Field(
        description="where nothing was found: the rule that came closest, with all its conditions"
    )


class Task(BaseModel):
    """Something that an object can be held for."""

    name: str
    description: str
    requires: tuple[str, ...] = Field(description="affordances that the object must have")
    grasp: tuple[str, ...] = Field(description="affordances of the part to hold, any of them")
    avoids: tuple[str, ...] = Field(description="parts with these affordances are left free")
    reasoning: tuple[str, ...] = Field(description="the versions of the reasoning that know it")
    can_be_removed: bool


class Affordance(BaseModel):
    """What a part of an object can offer."""

    name: str
    description: str


class TasksAnswer(BaseModel):
    """All tasks, and the affordances that new ones can name."""

    tasks: tuple[Task, ...]
    affordances: tuple[Affordance, ...]
