"""Rules and affordances as data: what an expert teaches without writing Prolog."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from shared.schemas.fields import Name
from shared.schemas.route import Nothing, Route
from shared.schemas.task import Affordance
from shared.wire import Message

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Description = Annotated[str, Field(max_length=500)]


class RuleCondition(Message):
    """One condition on a part, or on two: a word of the vocabulary and its value."""

    condition: Name
    """A word of the vocabulary (`GET /rules` lists it), e.g. `min_dimension`."""
    of: Annotated[tuple[Name, ...], Field(min_length=1, max_length=2)] = ("part",)
    """Which parts it is about, by the names that the rule gives them."""
    value: Number | tuple[Number, Number, Number] | Name | tuple[Name, ...] | None = None
    """A number, three lengths in metres, or names, as the word asks for; None for nothing."""


class RuleBody(Message):
    """A rule without what it is for: the part to hold and all that must be true."""

    name: Name
    description: Description = ""
    part: Name = "part"
    """The part that the rule finds; other names in the conditions are further parts."""
    conditions: Annotated[tuple[RuleCondition, ...], Field(min_length=1, max_length=32)]


class RuleDefinition(RuleBody):
    """A rule for a Version 1 task or for a Version 2 affordance."""

    task: Name | None = None
    """Version 1: the part is the one to hold for this task, which need not exist before."""
    affordance: Name | None = None
    """Version 2: the part counts as this affordance, which is known."""

    @model_validator(mode="after")
    def _one_subject(self) -> RuleDefinition:
        if (self.task is None) == (self.affordance is None):
            raise ValueError("a rule is for a task or for an affordance: give one of the two")
        return self


class Rule(RuleDefinition):
    """A rule that was taught."""

    prolog: str
    """The clause that it became, for reading."""


class Word(Message):
    """A condition that rules can use."""

    name: Name
    says: str
    parts: int
    """How many parts it is about."""
    takes: str
    """`nothing`, `number`, `lengths` (thickness, width, length in metres), `shapes`, or
    `affordance`."""
    quantity: str | None = None
    """What it bounds."""
    direction: str | None = None
    """`min` or `max`."""
    low: float | None = None
    """The smallest value that makes sense."""
    high: float | None = None


class RuleList(Message):
    """The rules that were taught, and the words to write further ones."""

    rules: tuple[Rule, ...]
    vocabulary: tuple[Word, ...]


class RuleName(Message):
    """Which rule is meant."""

    name: Name


class AffordanceDefinition(Message):
    """A new part affordance and the rules that find it."""

    name: Name
    description: Description = ""
    rules: Annotated[tuple[RuleBody, ...], Field(min_length=1, max_length=16)]


class AffordanceName(Message):
    """Which affordance is meant."""

    name: Name


LIST_RULES = Route(
    "reasoning", "/rules", Nothing, RuleList, "The rules that were taught, and their words", "GET"
)
ADD_RULE = Route("reasoning", "/rules", RuleDefinition, Rule, "Teach a rule", changes=True)
DELETE_RULE = Route(
    "reasoning",
    "/rules/{name}",
    RuleName,
    Rule,
    "Forget a taught rule",
    "DELETE",
    changes=True,
)
ADD_AFFORDANCE = Route(
    "reasoning",
    "/affordances",
    AffordanceDefinition,
    Affordance,
    "Add a part affordance with its rules",
    changes=True,
)
DELETE_AFFORDANCE = Route(
    "reasoning",
    "/affordances/{name}",
    AffordanceName,
    Affordance,
    "Forget an affordance that was added, and its rules",
    "DELETE",
    changes=True,
)
