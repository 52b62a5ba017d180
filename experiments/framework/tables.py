"""A table, for a terminal, a spreadsheet, a web page and a document."""

from __future__ import annotations

import csv
import html
import io
from collections.abc import Sequence
from dataclasses import dataclass

import rich.table
from rich import box
from rich.text import Text

from experiments.framework.cells import Cell, MeanStd, Share, fields_of, text_of

_WIDE = 200
"""Characters from which on a terminal has room for intervals."""


@dataclass(frozen=True)
class Table:
    """Rows under columns.

    Attributes
    ----------
    name : str
        Of its CSV file.
    title : str
        Above it.
    columns : tuple of str
        Headings; those that start with `thesis` hold the thesis's figures.
    rows : tuple of tuple
        Cells, as many as columns.
    note : str
        Below it: what the words mean, where figures come from.
    detail : bool
        For the report; too much for a terminal.

    Raises
    ------
    ValueError
        A row of another length than the headings.
    """

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""
    detail: bool = False

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(f"{self.name}: {len(row)} cells under {len(self.columns)} columns")

    def texts(self, *, brief: bool = False) -> list[list[str]]:
        """Return the cells as people read them; `brief` leaves out the intervals."""
        return [[text_of(cell, brief=brief) for cell in row] for row in self.rows]

    def numeric(self) -> list[bool]:
        """Return for every column whether it holds numbers only."""
        return [_numeric([row[k] for row in self.rows]) for k in range(len(self.columns))]

    def rich(self, width: int = _WIDE) -> rich.table.Table:
        """Return it for a terminal of so many characters; a narrow one gets no intervals."""
        table = rich.table.Table(
            title=self.title,
            title_justify="left",
            box=box.SIMPLE_HEAD,
            caption=self.note or None,
            caption_justify="left",
        )
        for name, numeric in zip(self.columns, self.numeric(), strict=True):
            style = "cyan" if name.startswith("thesis") else None
            table.add_column(name, justify="right" if numeric else "left", style=style)
        for row in self.texts(brief=width < _WIDE):
            table.add_row(*map(Text, row))
        return table

    def csv(self) -> str:
        """Return it as CSV; shares and means take several columns."""
        records = [
            {k: v for name, cell in zip(self.columns, row, strict=True)
             for k, v in fields_of(name, cell).items()}
            for row in self.rows
        ]  # fmt: skip
        return csv_text(records, self.columns)

    def html(self) -> str:
        """Return it as HTML."""
        numeric = self.numeric()
        kinds = [
            " ".join(
                kind
                for kind, is_so in (("number", number), ("thesis", name.startswith("thesis")))
                if is_so
            )
            for name, number in zip(self.columns, numeric, strict=True)
        ]
        head = "".join(
            f'<th class="{kind}">{html.escape(name)}</th>'
            for name, kind in zip(self.columns, kinds, strict=True)
        )
        body = "\n".join(
            "<tr>"
            + "".join(
                f'<td class="{kind}">{html.escape(text)}</td>'
                for text, kind in zip(row, kinds, strict=True)
            )
            + "</tr>"
            for row in self.texts()
        )
        note = f'<p class="note">{html.escape(self.note)}</p>' if self.note else ""
        return (
            f"<h3>{html.escape(self.title)}</h3>\n"
            f'<div class="wide"><table><thead><tr>{head}</tr></thead>\n'
            f"<tbody>{body}</tbody></table></div>\n{note}"
        )

    def markdown(self) -> str:
        """Return it as Markdown, to paste into a document."""
        lines = [_markdown_row(self.columns), _markdown_row(["---"] * len(self.columns))]
        lines += [_markdown_row(row) for row in self.texts()]
        note = f"\n{self.note}\n" if self.note else ""
        return f"**{self.title}**\n\n" + "\n".join(lines) + "\n" + note


def _numeric(cells: Sequence[Cell]) -> bool:
    held = [cell for cell in cells if cell is not None]
    return bool(held) and all(
        isinstance(cell, int | float | Share | MeanStd) and not isinstance(cell, bool)
        for cell in held
    )


def _markdown_row(texts: Sequence[str]) -> str:
    return "| " + " | ".join(text.replace("|", "\\|") for text in texts) + " |"


def csv_text(records: Sequence[dict[str, str]], columns: Sequence[str]) -> str:
    """Return CSV with every field that any record has, in the order of `columns`."""
    names = list(dict.fromkeys(name for record in records for name in record)) or list(columns)
    stream = io.StringIO()
    writer = csv.DictWriter(stream, names, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(records)
    return stream.getvalue()
