"""`sparge grasp FILE`: one question, the answer on the terminal and as pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from services.cli.options import (
    DepthScaleOption,
    GripperOption,
    Input,
    InputOption,
    IntrinsicsOption,
    MaxGraspsOption,
    Reasoning,
    ReasoningOption,
    RehearsalOption,
    SeedOption,
    UrlOption,
    ViewpointOption,
    json_option,
)
from services.cli.saving.kinds import HELP


def grasp(
    file: Annotated[
        Path, typer.Argument(exists=True, dir_okay=False, help=".npz, .ply, .pcd, .xyz or .png")
    ],
    task: Annotated[str, typer.Option(help="What the object is for: pouring, hammering, ...")],
    reasoning: ReasoningOption = Reasoning.v2,
    kind: InputOption = Input.scene,
    gripper: GripperOption = "panda",
    max_grasps: MaxGraspsOption = 5,
    rehearsal: RehearsalOption = None,
    seed: SeedOption = 0,
    viewpoint: ViewpointOption = "[0, 0, 0]",
    intrinsics: IntrinsicsOption = None,
    depth_scale: DepthScaleOption = None,
    save: Annotated[list[Path] | None, typer.Option(help=HELP)] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the JSON answer only")] = False,
    url: UrlOption = None,
) -> None:
    """Find where and how to grasp the object in FILE for a task."""
    from services.cli.ask import Question, ask
    from services.cli.saving import saved, wants_film
    from services.cli.show import show, show_tried

    files = saved(save or [])
    console = Console(stderr=True)
    question = Question(
        file=file,
        task=task,
        parameters={
            "reasoning": reasoning.value,
            "input": kind.value,
            "gripper": gripper,
            "max_grasps": max_grasps,
            "rehearsal": rehearsal and rehearsal.value,
            "seed": seed,
            "viewpoint": json_option("viewpoint", viewpoint),
            "intrinsics": json_option("intrinsics", intrinsics),
            "depth_scale": depth_scale,
        },
    )
    answered = ask(question, url, console, film=wants_film(files))
    if as_json:
        print(answered.result.answer.model_dump_json(indent=2))
    else:
        show(answered.result.answer, Console())
    show_tried(answered.tried, console if as_json else Console())
    missing = False
    for each in files:
        problem = each.write(answered)
        missing = missing or bool(problem)
        text = f"[yellow]not saved[/yellow]: {each.path}: {problem}" if problem else f"{each.path}"
        console.print(text if problem else f"saved: {text}", highlight=False, soft_wrap=True)
    if missing:
        raise typer.Exit(1)
