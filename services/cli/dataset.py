"""`sparge dataset`: labelled views of objects on a table."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from services.cli.options import SeedOption


def dataset(
    out: Annotated[Path, typer.Argument(help="A new folder, or a dataset to go on with")],
    more: Annotated[list[str] | None, typer.Argument(metavar="[OBJECT]...", hidden=True)] = None,
    views: Annotated[int, typer.Option(min=1, help="Views per object")] = 10,
    objects: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME...", help="Which objects, as in --objects pan bottle"),
    ] = None,
    meshes: Annotated[
        Path | None,
        typer.Option(help="A label file of your own meshes instead of the catalogue"),
    ] = None,
    noise: Annotated[bool, typer.Option("--noise", help="Also write them with noise")] = False,
    correlation: Annotated[
        float, typer.Option(min=0.0, help="Over how many pixels the noise hangs together")
    ] = 0.0,
    variants: Annotated[
        int, typer.Option(min=0, help="Random variants of every class as well")
    ] = 0,
    seed: SeedOption = 0,
    workers: Annotated[int, typer.Option(min=1, help="Processes")] = 2,
) -> None:
    """Write labelled depth views of objects on a table to OUT (docs/dataset.md).

    Run it again after an interruption: it makes what is missing.
    """
    from experiments.dataset import DatasetOptions, make_dataset

    options = DatasetOptions(
        views=views,
        objects=tuple(name for each in (objects or []) + (more or []) for name in each.split(",")),
        meshes=meshes,
        noise=noise,
        correlation_px=correlation,
        variants=variants,
        seed=seed,
    )
    console = Console(stderr=True)
    with Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=console,
        transient=True,
    ) as bar:
        task = bar.add_task("views", total=None)
        try:
            summary = make_dataset(
                out,
                options,
                workers=workers,
                progress=lambda done, total: bar.update(task, completed=done, total=total),
            )
        except KeyboardInterrupt:
            console.print("stopped; the same command goes on from here")
            raise typer.Exit(130) from None
    console.print(
        f"{out}: {summary.objects} objects, {summary.made + summary.kept} views, "
        f"{summary.kept} of them from before",
        highlight=False,
    )
