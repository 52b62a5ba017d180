"""`sparge key add|list|delete`: who may ask a gateway what."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from services.gateway.keys import Scope, add_key, delete_key, read_keys

key_commands = typer.Typer(
    help="Make, list and delete API keys; a running gateway sees it within a second.",
    no_args_is_help=True,
)
File = Annotated[
    Path,
    typer.Option("--file", envvar="SPARGE_GATEWAY_API_KEYS_FILE", help="Where the hashes are kept"),
]


@key_commands.command("add")
def add(
    name: Annotated[str, typer.Argument(help="Lower case, digits, - and _")],
    file: File,
    scope: Annotated[
        list[Scope] | None,
        typer.Option(help="read, grasp, knowledge or admin; repeatable. Default: read and grasp"),
    ] = None,
    rate: Annotated[float | None, typer.Option(help="Requests a second, in the long run")] = None,
) -> None:
    """Make a key and print it, once: only its hash is kept."""
    text = add_key(file, name, tuple(scope or (Scope.READ, Scope.GRASP)), rate)
    Console(stderr=True).print(f"{name}: kept in {file}; this is the key, shown only now:")
    print(text)


@key_commands.command("list")
def show(file: File) -> None:
    """List the keys, without the keys themselves."""
    table = Table("key", "scopes", "rate per s", "created")
    for key in read_keys(file).keys:
        rate = "" if key.rate_per_s is None else f"{key.rate_per_s:g}"
        table.add_row(key.name, ", ".join(key.scopes), rate, key.created.isoformat())
    Console().print(table)


@key_commands.command("delete")
def delete(name: str, file: File) -> None:
    """Take a key back."""
    delete_key(file, name)
    Console().print(f"{name}: no longer valid")
