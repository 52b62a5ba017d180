"""The answer on a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from shared.client import headline
from shared.schemas.answer import GraspAnswer
from shared.schemas.execution import ExecuteResponse


def show(answer: GraspAnswer, console: Console) -> None:
    """Print region, primitives, grasps, explanation and timings."""
    console.print(headline(answer), style="bold", highlight=False)
    console.print(_primitives(answer))
    if answer.grasps:
        console.print(_grasps(answer))
    if answer.reason is not None:
        console.print(
            Text.assemble((answer.reason.code, "yellow"), ": ", answer.reason.message),
            highlight=False,
        )
    if answer.explanation is not None:
        console.print("[bold]Why[/bold]")
        console.print(Text(answer.explanation.text), highlight=False)
    spent = "  ".join(f"{name} {value:.0f}" for name, value in answer.timings_ms.items())
    console.print(f"[bold]Time[/bold] (ms)  {spent}", highlight=False)


def show_tried(tried: Sequence[ExecuteResponse], console: Console) -> None:
    """Print what came of the grasps that were executed, if any were."""
    if not tried:
        return
    table = Table(title="Tried in simulation", title_justify="left", box=box.SIMPLE_HEAD)
    for name in ("#", "outcome", ""):
        table.add_column(name, no_wrap=bool(name))
    for rank, each in enumerate(tried):
        colour = "green" if each.success else "red"
        outcome = each.outcome.replace("_", " ")
        table.add_row(str(rank), f"[{colour}]{outcome}[/{colour}]", each.message)
    console.print(table)


def _primitives(answer: GraspAnswer) -> Table:
    table = Table(title="Parts", title_justify="left", box=box.SIMPLE_HEAD)
    held = answer.region.primitive_ids if answer.region else ()
    for name in ("part", "shape", "extents (mm)", "residual", "affordances", ""):
        table.add_column(name, no_wrap=name != "affordances")
    for each in answer.primitives:
        table.add_row(
            str(each.id),
            f"{each.shape_class} ({each.shape_probability:.2f})",
            " x ".join(f"{1e3 * extent:.0f}" for extent in each.full_extents),
            f"{each.residual_mm:.1f} mm",
            ", ".join(each.labels),
            "[green]hold[/green]" if each.id in held else "",
        )
    return table


def _grasps(answer: GraspAnswer) -> Table:
    title = f"Grasps, frame {answer.frame_id}, gripper {answer.gripper}"
    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD)
    columns = ("#", "position (m)", "quaternion xyzw", "width (mm)", "score")
    rehearsed = any(each.rehearsed for each in answer.grasps)
    for name in (*columns, "rehearsed") if rehearsed else columns:
        table.add_column(name)
    for number, each in enumerate(answer.grasps):
        table.add_row(
            str(number),
            " ".join(f"{value:+.3f}" for value in each.pose.position),
            " ".join(f"{value:+.3f}" for value in each.pose.quaternion),
            f"{1e3 * each.width:.0f}",
            f"{each.score:.2f}",
            *([", ".join(each.rehearsed).replace("_", " ")] if rehearsed else ()),
        )
    return table
