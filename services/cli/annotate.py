"""`sparge annotate`: folders of clouds, labelled with regions and grasps."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from services.cli.options import (
    DepthScaleOption,
    GripperOption,
    Input,
    InputOption,
    IntrinsicsOption,
    MaxGraspsOption,
    Reasoning,
    ReasoningOption,
    SeedOption,
    ViewpointOption,
    json_option,
)

if TYPE_CHECKING:
    from services.annotate.drive import Summary

INTERRUPTED = 130


def annotate(
    input_dir: Annotated[
        Path,
        typer.Argument(exists=True, file_okay=False, help="Searched for .npz .ply .pcd .xyz .png"),
    ],
    task: Annotated[list[str], typer.Option(help="What the objects are for; may be repeated")],
    out: Annotated[Path, typer.Option(help="A new folder, or one to go on with")],
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes; all processors if not given")
    ] = None,
    address: Annotated[
        str | None, typer.Option(help="Of a Ray cluster, as in 10.0.0.1:6379 or auto")
    ] = None,
    reasoning: ReasoningOption = Reasoning.v2,
    kind: InputOption = Input.scene,
    gripper: GripperOption = "panda",
    max_grasps: MaxGraspsOption = 10,
    seed: SeedOption = 0,
    viewpoint: ViewpointOption = "[0, 0, 0]",
    intrinsics: IntrinsicsOption = None,
    depth_scale: DepthScaleOption = None,
    part_rows: Annotated[
        int, typer.Option(min=1, help="Rows of a Parquet file; what a crash loses at most")
    ] = 256,
    retry_rejects: Annotated[
        bool, typer.Option("--retry-rejects", help="Ask again about what was rejected before")
    ] = False,
) -> None:
    """Label every cloud below INPUT_DIR with regions and grasps (docs/annotate.md).

    Run it again after an interruption: it asks what is missing, and what has changed.
    """
    console = Console(stderr=True)
    missing = [name for name in ("pyarrow", "ray") if importlib.util.find_spec(name) is None]
    if missing:
        console.print(
            f"{' and '.join(missing)} not installed; please run: pip install 'sparge\\[annotate]'",
            highlight=False,
        )
        raise typer.Exit(1)
    from services.annotate.command import Options, annotate
    from services.annotate.question import Question

    question = Question(
        tasks=tuple(dict.fromkeys(each.strip().lower() for each in task)),
        parameters={
            "reasoning": reasoning.value,
            "input": kind.value,
            "gripper": gripper,
            "max_grasps": max_grasps,
            "seed": seed,
            "viewpoint": json_option("viewpoint", viewpoint),
            "intrinsics": json_option("intrinsics", intrinsics),
            "depth_scale": depth_scale,
        },
    )
    options = Options(address, workers, part_rows, retry_rejects)
    with Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=console,
        transient=True,
    ) as bar:
        step = bar.add_task("questions", total=None)
        try:
            summary = annotate(
                input_dir,
                out,
                question,
                options,
                lambda settled, total: bar.update(step, completed=settled, total=total),
            )
        except KeyboardInterrupt:
            console.print("stopped; the same command goes on from here")
            raise typer.Exit(INTERRUPTED) from None
    console.print(f"{out}: {describe(summary)}", highlight=False, soft_wrap=True)
    if not summary.annotated + summary.annotated_before:
        raise typer.Exit(1)


def describe(summary: Summary) -> str:
    """Return how many questions were settled, and how, in a line."""
    annotated = summary.annotated + summary.annotated_before
    rejected = summary.rejected.total() + summary.rejected_before
    codes = [f"{count} {code}" for code, count in sorted(summary.rejected.items())]
    if summary.rejected_before:
        codes.append(f"{summary.rejected_before} from before")
    return (
        f"{summary.settled} questions, {annotated} answered"
        + (f" ({summary.annotated_before} from before)" if summary.annotated_before else "")
        + f", {rejected} rejected"
        + (f" ({', '.join(codes)})" if codes else "")
    )
