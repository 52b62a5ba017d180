"""What a check found, and how it is shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from rich.console import Console


class Status(StrEnum):
    """How it stands: `fail` means that something will not work."""

    ok = "ok"
    warn = "warn"
    fail = "fail"
    skip = "skip"


@dataclass(frozen=True)
class Finding:
    """One line of the report.

    Attributes
    ----------
    check : str
        What was looked at.
    status : Status
    message : str
        What was found.
    advice : str
        What to do about it; empty where nothing is to be done.
    """

    check: str
    status: Status
    message: str
    advice: str = ""


_STYLES = {Status.ok: "green", Status.warn: "yellow", Status.fail: "bold red", Status.skip: "dim"}


def show(finding: Finding, console: Console) -> None:
    """Print one finding, and under it what to do."""
    status = f"[{_STYLES[finding.status]}]{finding.status:<4}[/]"
    console.print(f"{status}  {finding.check:<24} ", end="")
    console.print(finding.message, markup=False, highlight=False, soft_wrap=True)
    if finding.advice:
        console.print(f"{'':29} -> {finding.advice}", markup=False, highlight=False, soft_wrap=True)


def worst(findings: Sequence[Finding]) -> Status:
    """Return `fail`, `warn` or `ok`: the worst of what was found."""
    found = {each.status for each in findings}
    return next((each for each in (Status.fail, Status.warn) if each in found), Status.ok)
