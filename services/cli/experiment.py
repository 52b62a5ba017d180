"""`sparge experiment NAME`: an experiment of the thesis, from the question to the report."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from services.cli.ask import backend
from services.cli.options import UrlOption
from shared.client import Sparge
from shared.errors import InvalidInput

_KNOWLEDGE = "SPARGE_REASONING_KNOWLEDGE_DIR"


def experiment(
    name: Annotated[
        str,
        typer.Argument(
            help="regions, grasps, timing, extension, demo, tuning, shapes, robustness "
            "or primitives"
        ),
    ],
    url: UrlOption = None,
    scans: Annotated[
        list[Path] | None,
        typer.Option(help="Also ask about this folder of labelled views; may be repeated"),
    ] = None,
    meshes: Annotated[
        Path | None,
        typer.Option(help="The scans' own meshes: a label file as in docs/catalogue.md"),
    ] = None,
    catalogue: Annotated[
        bool, typer.Option(help="Ask about views of the catalogue's objects")
    ] = True,
    variants: Annotated[
        int | None,
        typer.Option(min=0, help="Also ask about so many random objects of every class"),
    ] = None,
    limit: Annotated[
        int | None, typer.Option(min=1, help="At most so many views of each object")
    ] = None,
    results: Annotated[Path, typer.Option(help="Where findings and report go")] = Path("results"),
    seed: Annotated[int, typer.Option(min=0, help="Of everything random")] = 0,
    human_labels: Annotated[
        Path | None, typer.Option(help="shapes: also test on this file of shapes named by people")
    ] = None,
    trials: Annotated[
        int | None, typer.Option(min=1, help="tuning: go on until there are so many trials")
    ] = None,
    workers: Annotated[
        int, typer.Option(min=1, help="Questions at a time, where time is not measured")
    ] = 2,
) -> None:
    """Run an experiment of the thesis; print its tables, write CSV, PNG and one HTML report."""
    from experiments.framework.conduct import conduct, context_for, view_sets
    from experiments.registry import experiment as find

    progress, output = Console(stderr=True), Console()
    wanted = find(name, human_labels=human_labels, trials=trials)
    if variants is not None:
        if variants and (not catalogue or wanted.views_per_object is None):
            raise InvalidInput(f"{name} looks at no random objects here: leave out --variants")
        wanted = replace(wanted, variants=variants)
    folders = scans or []
    if wanted.views_per_object is not None and not (catalogue or folders):
        raise InvalidInput("there is nothing to ask about: name --scans, or leave the catalogue")
    sets = view_sets(
        wanted,
        results,
        folders,
        catalogue=catalogue,
        limit=limit,
        seed=seed,
        console=progress,
        workers=workers,
        meshes=meshes,
    )
    with own_backend(url) as sparge:
        context = context_for(
            wanted,
            sparge,
            progress,
            results,
            sets,
            limit=limit,
            seed=seed,
            workers=workers,
        )
        where = "in this process" if url is None else url
        findings, page = conduct(wanted, context, results, where)
    for table in findings.tables:
        if not table.detail:
            output.print(table.rich(output.width))
    output.print(findings.meaning, highlight=False)
    progress.print(f"report: {page}", highlight=False)


@contextlib.contextmanager
def own_backend(url: str | None) -> Iterator[Sparge]:
    """Give the backend at `url`, or one in this process that knows the shipped tasks only.

    It keeps what it learns in a folder of its own that goes away with it, so
    that the user's tasks are neither seen nor touched.
    """
    if url is not None:
        with backend(url) as sparge:
            yield sparge
        return
    with (
        tempfile.TemporaryDirectory(prefix="sparge-experiment-") as knowledge,
        _environment(_KNOWLEDGE, knowledge),
        backend(None) as sparge,
    ):
        yield sparge


@contextlib.contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before
