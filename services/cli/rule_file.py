"""What is wrong with a file of rules, with file and line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from services.cli.json_lines import line_for, lines_of
from services.reasoning.problem import Problem
from services.reasoning.prolog import prolog
from services.reasoning.rule_problems import Terms, problems_of
from services.reasoning.settings import ReasoningSettings
from shared.client import Sparge
from shared.errors import InvalidInput
from shared.schemas.route import Nothing
from shared.schemas.rule import LIST_RULES, AffordanceDefinition, RuleDefinition
from shared.schemas.task import LIST_AFFORDANCES

Definition = RuleDefinition | AffordanceDefinition


def definition_in(file: Path) -> Definition:
    """Return the rule or the affordance that a JSON file holds.

    Raises
    ------
    InvalidInput
        It holds neither; says what is wrong on which line.
    """
    complaints, definition = _read(file, _text(file))
    if definition is None:
        raise InvalidInput("; ".join(complaints), found=str(file))
    return definition


def json_complaints(file: Path, sparge: Sparge) -> tuple[list[str], str]:
    """Return what is wrong with a JSON file, and what it is for.

    Words and affordances are those that the backend knows.
    """
    text = _text(file)
    complaints, definition = _read(file, text)
    if definition is None:
        return complaints, ""
    words = {word.name: word for word in sparge.call(LIST_RULES, Nothing()).vocabulary}
    known = {each.name for each in sparge.call(LIST_AFFORDANCES, Nothing()).affordances}
    if isinstance(definition, AffordanceDefinition):
        terms = Terms(words, {*known, definition.name})
        problems = [
            Problem(f"rules.{number}.{each.field}", each.problem)
            for number, body in enumerate(definition.rules)
            for each in problems_of(body, terms)
        ]
        subject = f"{len(definition.rules)} rules for the affordance {definition.name}"
    else:
        problems = problems_of(definition, Terms(words, known), definition.affordance)
        subject = f"a rule for {definition.task or definition.affordance}"
    return _placed(file, text, problems), subject


def prolog_complaints(file: Path) -> tuple[list[str], str]:
    """Return what is wrong with a Prolog file, and what it has rules for; it is loaded."""
    engine = prolog(ReasoningSettings().rules_dir)
    found = engine.ask("check_file", file=str(file.resolve()))
    rules = ", ".join(f"{name} (line {line})" for name, line in found["rules"])
    return found["problems"], f"rules for {rules}"


def _text(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise InvalidInput(f"{file} is not text in UTF-8", found=str(file)) from None


def _read(file: Path, text: str) -> tuple[list[str], Definition | None]:
    try:
        fields: Any = json.loads(text)
    except json.JSONDecodeError as error:
        return [f"{file}:{error.lineno}: not JSON: {error.msg} (column {error.colno})"], None
    is_affordance = isinstance(fields, dict) and "rules" in fields
    kind: type[Definition] = AffordanceDefinition if is_affordance else RuleDefinition
    try:
        return [], kind.model_validate_json(text)
    except ValidationError as error:
        problems = [
            _problem(each["loc"], each["msg"])
            for each in error.errors(include_url=False, include_context=False)
        ]
        return _placed(file, text, _innermost(problems)), None


def _problem(location: tuple[int | str, ...], message: str) -> Problem:
    """Return what pydantic found; one thing for all the kinds of value that it tried."""
    path = [str(each) for each in location]
    if "value" in path:
        path = path[: path.index("value") + 1]
        message = "takes a number, three lengths in metres, a name, names, or nothing"
    return Problem(".".join(path), message)


def _innermost(problems: list[Problem]) -> list[Problem]:
    """Return each problem once, without those that only follow from one further inside."""
    fields = {each.field for each in problems}
    return [
        each
        for each in dict.fromkeys(problems)
        if not any(other.startswith(f"{each.field}.") for other in fields)
    ]


def _placed(file: Path, text: str, problems: list[Problem]) -> list[str]:
    lines = lines_of(text)
    return [
        f"{file}:{line_for(each.field, lines)}: {each.field or 'file'}: {each.problem}"
        for each in problems
    ]
