"""`sparge rule check|add|list|delete`: rules that are taught."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from services.cli.knowledge import URL_HELP, knowledge
from services.cli.task import Url
from shared.schemas.route import Nothing
from shared.schemas.rule import (
    ADD_AFFORDANCE,
    ADD_RULE,
    DELETE_RULE,
    LIST_RULES,
    AffordanceDefinition,
    RuleName,
)
from shared.wire.codec import validate

rule_commands = typer.Typer(help="Check, teach, list and delete rules.", no_args_is_help=True)
RuleFile = Annotated[
    Path, typer.Argument(exists=True, dir_okay=False, help="A rule or an affordance as JSON")
]


@rule_commands.command("check")
def check(
    file: Annotated[
        Path, typer.Argument(exists=True, dir_okay=False, help="JSON, or Prolog (.pl)")
    ],
    url: Annotated[str | None, typer.Option(help=f"For JSON. {URL_HELP}")] = None,
) -> None:
    """Say what is wrong with a file of rules, and where; status 1 if there is something.

    JSON is what POST /rules or POST /affordances takes. A Prolog file is loaded, so
    check only files that you trust.
    """
    from services.cli.rule_file import json_complaints, prolog_complaints

    console = Console(soft_wrap=True, highlight=False, markup=False)
    if file.suffix == ".pl":
        complaints, subject = prolog_complaints(file)
    else:
        with knowledge(url) as sparge:
            complaints, subject = json_complaints(file, sparge)
    for complaint in complaints:
        console.print(complaint)
    if complaints:
        raise typer.Exit(1)
    console.print(f"{file}: sound; {subject}")


@rule_commands.command("add")
def add(file: RuleFile, url: Url = None) -> None:
    """Teach the rule, or add the affordance with its rules, that FILE holds."""
    from services.cli.rule_file import definition_in

    definition = definition_in(file)
    console = Console(soft_wrap=True, highlight=False, markup=False)
    with knowledge(url) as sparge:
        if isinstance(definition, AffordanceDefinition):
            affordance = sparge.call(ADD_AFFORDANCE, definition)
            console.print(f"{affordance.name}: an affordance with {len(definition.rules)} rules")
        else:
            console.print(sparge.call(ADD_RULE, definition).prolog)


@rule_commands.command("list")
def show(
    words: Annotated[bool, typer.Option("--words", help="The words of rules instead")] = False,
    url: Url = None,
) -> None:
    """List the taught rules as Prolog."""
    console = Console(soft_wrap=True, highlight=False, markup=False)
    with knowledge(url) as sparge:
        listed = sparge.call(LIST_RULES, Nothing())
    if words:
        for word in listed.vocabulary:
            parts = "" if word.parts == 1 else f" ({word.parts} parts)"
            console.print(f"{word.name:<24} {word.takes:<11} {word.says}{parts}")
        return
    for rule in listed.rules:
        console.print(f"% {rule.name}" + (f": {rule.description}" if rule.description else ""))
        console.print(rule.prolog + "\n")


@rule_commands.command("delete")
def delete(name: str, url: Url = None) -> None:
    """Forget a taught rule."""
    with knowledge(url) as sparge:
        gone = sparge.call(DELETE_RULE, validate(RuleName, {"name": name}))
    Console().print(f"{gone.name}: forgotten")
