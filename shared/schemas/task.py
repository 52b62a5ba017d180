"""Reasoning: primitives and a task in, the part to hold and the proof out."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, FiniteFloat

from shared.schemas.fields import Name, TaskText
from shared.schemas.primitive import Joint, Primitive
from shared.schemas.route import Nothing, Route
from shared.schemas.scene import SupportPlane
from shared.wire import Message

Version = Literal["v1", "v2"]
RuleSet = Literal["thesis", "default"]
"""The rules as published (Code A.1, A.2), or those that also look at how the parts lie."""


class Reason(Message):
    """Why an answer is empty; the codes are listed in docs/reasons.md."""

    code: str
    message: str


class Region(Message):
    """The part of the object to hold."""

    primitive_ids: tuple[int, ...]
    affordance: str | None = None
    """Version 2: the label that made it the grasp region."""
    confidence: Annotated[float, Field(ge=0, le=1)]


class Condition(Message):
    """One condition of a rule, as Prolog measured it on one primitive."""

    predicate: str
    """As it stands in the rule, e.g. `max_dimension([0.05,0.05,1.0])`."""
    primitive_id: int | None
    holds: bool
    measured: str
    required: str
    margin: float | None
    """How far inside (>= 0) or outside (< 0) the bound, in `unit`; None when it has no scale."""
    unit: str | None
    """`m`, `ratio`, ... of the margin."""


class RuleTrace(Message):
    """One rule tried on the primitives it was tried on."""

    rule: str
    """Name and origin, e.g. `version1:cooking`."""
    holds: bool
    bindings: dict[str, int]
    """Which primitive stands for which variable of the rule."""
    conditions: tuple[Condition, ...]


class Explanation(Message):
    """Which rule, which facts, which conditions; as data and as text."""

    text: str
    facts: tuple[str, ...]
    """The Prolog facts that the rules saw."""
    rules: tuple[RuleTrace, ...]
    """Those that hold and led to the answer."""
    nearest_miss: RuleTrace | None = None
    """For found = false: the rule and binding that came closest, and by how much it failed."""


class DecideRequest(Message):
    """Asks what this object offers for this task."""

    task: TaskText
    reasoning: Version = "v2"
    rule_set: RuleSet = "default"
    primitives: tuple[Primitive, ...]
    joints: tuple[Joint, ...] = ()
    """Which parts meet, where the recovery knows."""
    plane: SupportPlane | None = None
    """What the object stands on, for heights above it."""
    gripper_opening: Annotated[FiniteFloat, Field(gt=0)] | None = None
    """Widest opening of the gripper in metres; None: unknown, and no rule may mind."""
    explain: bool = True


class DecideResponse(Message):
    """found = False is an answer, and says why in `reason`."""

    found: bool
    reason: Reason | None = None
    region: Region | None = None
    alternatives: tuple[Region, ...] = ()
    """Further regions that satisfy the rules, best first."""
    labels: dict[int, tuple[str, ...]]
    """Version 2: the part affordances of each primitive."""
    explanation: Explanation | None = None


class TaskDefinition(Message):
    """A Version 2 task, by its relations in the ontology."""

    name: Name
    description: Annotated[str, Field(max_length=500)] = ""
    requires: tuple[Name, ...] = ()
    """Affordances that the object must have (requiresAffordance)."""
    grasp: tuple[Name, ...] = ()
    """Affordances of the part to hold, any of them (hasGraspAffordance)."""
    avoids: tuple[Name, ...] = ()
    """Parts with these labels are left free; without `grasp`, all others may be held
    (avoidsAffordance)."""


class Task(TaskDefinition):
    """A task of the knowledge base."""

    reasoning: tuple[Version, ...]
    """The versions that know it."""
    builtin: bool
    """Part of the shipped knowledge; cannot be deleted."""


class TaskList(Message):
    """All tasks that can be asked for."""

    tasks: tuple[Task, ...]


class TaskName(Message):
    """Which task is meant."""

    name: Name


class Affordance(Message):
    """What a part of an object offers."""

    name: Name
    description: str


class AffordanceList(Message):
    """All part affordances that rules can find."""

    affordances: tuple[Affordance, ...]


DECIDE = Route(
    "reasoning",
    "/decide",
    DecideRequest,
    DecideResponse,
    "Find the part to hold for a task, with the proof",
)
LIST_TASKS = Route("reasoning", "/tasks", Nothing, TaskList, "The tasks that are known", "GET")
ADD_TASK = Route("reasoning", "/tasks", TaskDefinition, Task, "Add a Version 2 task", changes=True)
DELETE_TASK = Route(
    "reasoning",
    "/tasks/{name}",
    TaskName,
    Task,
    "Forget a task that was added",
    "DELETE",
    changes=True,
)
LIST_AFFORDANCES = Route(
    "reasoning", "/affordances", Nothing, AffordanceList, "The part affordances", "GET"
)
