"""All findings as one Markdown page: the headline tables, when and how each was made."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

SUMMARY = "results.md"

_HEAD = """# Results

Every experiment's tables for a terminal, written by `make experiments` and by each
`sparge experiment NAME` into `results/results.md`; this page is that file. What the words mean and
the plots are in `results/report.html`, every single request in `results/NAME/requests.csv`. Columns
that start with "thesis" hold the figures of the master's thesis, measured on its own objects and
computer: they say which size to expect.
"""


def summarize(results: Path, order: Sequence[str], findings: str = "findings.json") -> str:
    """Return the Markdown page of all findings under `results`.

    Parameters
    ----------
    results : Path
        Folder of all experiments.
    order : sequence of str
        Names of experiments that come first, in this order; others by name.
    findings : str
        Name of the file that each experiment's folder keeps.
    """
    found = {path.parent.name: path for path in results.glob(f"*/{findings}")}
    names = [name for name in order if name in found] + sorted(set(found) - set(order))
    sections = [_section(json.loads(found[name].read_text(encoding="utf-8"))) for name in names]
    return "\n".join([_HEAD, *sections])


def _section(held: dict[str, Any]) -> str:
    run = held["run"]
    thesis = f" ({held['thesis']})" if held["thesis"] else ""
    tables = "\n".join(held.get("markdown", ()))
    return (
        f"## {held['title']}{thesis}\n\n{held['question']}\n\n"
        f"`{run['command']}`, {run['date']}, {run['machine']}\n\n{held['meaning']}\n\n{tables}"
    )
