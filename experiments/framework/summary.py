"""All findings as one Markdown page: the headline tables, when and how each was made."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

SUMMARY = "results.md"

_HEAD = """# Results

Every experiment's tables for a terminal, written by `make experiments` and by each
`sparge experiment NAME` into `results/results.md`; this page is that file. What the words mean and
the plots are in `results/report.html`, every single request in `results/NAME/requests.csv`. Columns
that start with "thesis" hold the figures of the master's thesis, measured on its own objects and
computer: they say which size to expect.
"""


def summarize(findings: Iterable[Mapping[str, Any]]) -> str:
    """Return the Markdown page of findings, as `findings.json` of each experiment holds them."""
    return "\n".join([_HEAD, *map(_section, findings)])


def _section(held: Mapping[str, Any]) -> str:
    run = held["run"]
    thesis = f" ({held['thesis']})" if held["thesis"] else ""
    tables = "\n".join(held.get("markdown", ()))
    return (
        f"## {held['title']}{thesis}\n\n{held['question']}\n\n"
        f"`{run['command']}`, {run['date']}, {run['machine']}\n\n{held['meaning']}\n\n{tables}"
    )
