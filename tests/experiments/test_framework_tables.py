"""Tables in every form."""

from __future__ import annotations

import csv
import io

import pytest
from rich.console import Console

from experiments.framework import MeanStd, Share, Table

TABLE = Table(
    "regions",
    "A <title>",
    ("task", "found", "thesis found", "IoU"),
    (
        ("pour|ing", Share(1, 4), Share(26, 30), MeanStd(0.5, 0.25, 3)),
        ("<script>alert(1)</script>", Share(0, 4), None, MeanStd.of([])),
    ),
    "A & note",
)


def test_a_row_has_a_cell_for_every_column() -> None:
    with pytest.raises(ValueError, match="1 cells under 2 columns"):
        Table("t", "T", ("a", "b"), (("x",),))


def test_csv_holds_plain_numbers() -> None:
    first, second = csv.DictReader(io.StringIO(TABLE.csv()))
    assert float(first["found count"]) / float(first["found total"]) == 0.25
    assert float(first["found low"]) < 0.25 < float(first["found high"])
    assert (first["IoU mean"], first["IoU std"]) == ("0.5", "0.25")
    assert second["thesis found count"] == ""
    assert second["IoU mean"] == ""


def test_html_is_escaped_and_marks_the_thesis() -> None:
    page = TABLE.html()
    assert "<script>" not in page
    assert "&lt;script&gt;" in page
    assert "A &amp; note" in page
    assert '<th class="number thesis">thesis found</th>' in page


def test_markdown_keeps_its_columns() -> None:
    lines = [line for line in TABLE.markdown().splitlines() if line.startswith("|")]
    assert len(lines) == 4
    assert all(line.replace("\\|", "").count("|") == 5 for line in lines)


@pytest.mark.parametrize(("width", "shown"), [(80, "1/4"), (200, "1/4 (25 %, 5–70)")])
def test_a_narrow_terminal_gets_no_intervals(width: int, shown: str) -> None:
    console = Console(width=width, file=io.StringIO(), force_terminal=False)
    with console.capture() as capture:
        console.print(TABLE.rich(width))
    text = capture.get()
    assert shown in text
    assert ("25 %" in text) == (width == 200)


def test_an_empty_table_is_a_table() -> None:
    empty = Table("t", "T", ("a", "b"), ())
    assert empty.csv() == "a,b\n"
    assert empty.numeric() == [False, False]
