"""Columns of numbers in text that nobody vouches for: point files in ASCII."""

from __future__ import annotations

import io
import itertools
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from shared.errors import MalformedRequest, PayloadTooLarge

MAX_LINE_BYTES = 64 * 1024
MAX_EMPTY_LINES = 100_000
COMMENT_MARKS = ("#", "//")


def read_line(stream: io.BytesIO, what: str) -> str:
    """Return the next line with its end, "" at the end of the stream.

    Raises
    ------
    MalformedRequest
        The line is longer than `MAX_LINE_BYTES`; `what` names the file.
    """
    line = stream.readline(MAX_LINE_BYTES + 1)
    if len(line) > MAX_LINE_BYTES:
        raise MalformedRequest(f"{what} has a line of more than {MAX_LINE_BYTES} bytes")
    return line.decode("latin-1")


def data_lines(stream: io.BytesIO, what: str) -> Iterator[str]:
    """Yield the lines that hold data: no comments, no blank lines, commas as blanks.

    Raises
    ------
    MalformedRequest
        More than `MAX_EMPTY_LINES` hold none; `what` names the file.
    """
    empty = 0
    while line := read_line(stream, what):
        for mark in COMMENT_MARKS:
            line = line.partition(mark)[0]
        line = line.replace(",", " ").strip()
        if line:
            yield line
            continue
        empty += 1
        if empty > MAX_EMPTY_LINES:
            raise MalformedRequest(f"{what} has more than {MAX_EMPTY_LINES} lines without data")


def read_columns(
    lines: Iterator[str], columns: Sequence[int], what: str, *, max_bytes: int
) -> NDArray[np.float64]:
    """Return the numbers (R, C) in these `columns`, counted from 0, of every line.

    Parameters
    ----------
    lines : iterator of str
        Only as much is held in memory as the numbers need.
    columns : sequence of int
        Which columns; a line may have more.
    what : str
        The file's name, for messages.
    max_bytes : int
        Bound on the size of the numbers.

    Raises
    ------
    MalformedRequest
        A line has too few columns, or something that is not a number.
    PayloadTooLarge
        There are more numbers than `max_bytes` allow.
    """
    first = next(lines, None)
    if first is None:
        return np.empty((0, len(columns)))
    max_rows = max_bytes // (8 * len(columns))
    text = itertools.islice(itertools.chain([first], lines), max_rows + 1)
    try:
        table = np.loadtxt(text, dtype=np.float64, usecols=columns, ndmin=2, comments=None)
    except ValueError as error:
        raise MalformedRequest(f"{what} holds a line that is not numbers: {error}") from None
    if len(table) > max_rows:
        raise PayloadTooLarge(
            f"{what} holds more than {max_rows} points", allowed=max_rows, unit="points"
        )
    return table
