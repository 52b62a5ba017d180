"""`sparge task add|list|delete`: the tasks of a backend."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from services.cli.knowledge import URL_HELP, knowledge
from shared.schemas.route import Nothing
from shared.schemas.task import ADD_TASK, DELETE_TASK, LIST_TASKS, TaskDefinition, TaskName
from shared.wire.codec import validate

task_commands = typer.Typer(help="Add, list and delete tasks.", no_args_is_help=True)
Url = Annotated[str | None, typer.Option(help=URL_HELP)]
Affordances = list[str] | None


@task_commands.command("add")
def add(
    name: Annotated[str, typer.Argument(help="Lower case, digits and _")],
    description: Annotated[str, typer.Option(help="One sentence")] = "",
    requires: Annotated[
        Affordances, typer.Option(help="An affordance that the object must have; repeatable")
    ] = None,
    grasp: Annotated[
        Affordances, typer.Option(help="An affordance of the part to hold; repeatable, any of them")
    ] = None,
    avoids: Annotated[
        Affordances, typer.Option(help="Leave parts with this affordance free; repeatable")
    ] = None,
    url: Url = None,
) -> None:
    """Add a task by its relations to affordances; the next request knows it."""
    fields = {
        "name": name,
        "description": description,
        "requires": requires or [],
        "grasp": grasp or [],
        "avoids": avoids or [],
    }
    definition = validate(TaskDefinition, fields)
    with knowledge(url) as sparge:
        added = sparge.call(ADD_TASK, definition)
    Console().print(f"{added.name}: known to reasoning {', '.join(added.reasoning)}")


@task_commands.command("list")
def show(url: Url = None) -> None:
    """List the tasks with their relations."""
    with knowledge(url) as sparge:
        tasks = sparge.call(LIST_TASKS, Nothing()).tasks
    table = Table("task", "reasoning", "requires", "grasp", "avoids", "added")
    for task in tasks:
        relations = [", ".join(each) for each in (task.requires, task.grasp, task.avoids)]
        added = "" if task.builtin else "yes"
        table.add_row(task.name, ", ".join(task.reasoning), *relations, added)
    Console().print(table)


@task_commands.command("delete")
def delete(name: str, url: Url = None) -> None:
    """Forget a task that was added."""
    with knowledge(url) as sparge:
        gone = sparge.call(DELETE_TASK, validate(TaskName, {"name": name}))
    Console().print(f"{gone.name}: forgotten")
