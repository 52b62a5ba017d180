"""The output folder: which questions are settled, and how. Only the driver writes to it."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

import pyarrow as pa

from services.annotate.parts import PartedTable
from services.annotate.question import Job, Refusal, Terms
from services.annotate.schema import ANNOTATIONS, KEY, REJECTS, TERMS, reject_row

Key = tuple[str, str]


class Settled(NamedTuple):
    """How a question was settled in an earlier run.

    Attributes
    ----------
    rejected : bool
        In the rejects, not among the annotations.
    part : str
        The file that has the row.
    sha256 : str or None
        Of the file then; None: it could not be read.
    terms : Terms
        What else it was answered by.
    """

    rejected: bool
    part: str
    sha256: str | None
    terms: Terms


class Book:
    """Both tables of an output folder; a question is in at most one row of one of them.

    What is settled is kept until `part_rows` questions are, then written, also when the
    context ends, however it does. The rows of earlier runs that are replaced are removed
    before: a crash in between leaves a question open, never twice settled.

    Parameters
    ----------
    folder : Path
        With `annotations/` and `rejects/`, made where missing. The caller is its only writer.
    part_rows : int
        Rows that are written at once, and that a crash loses at most.
    """

    def __init__(self, folder: Path, part_rows: int) -> None:
        self._tables = {
            False: PartedTable(folder / "annotations", ANNOTATIONS),
            True: PartedTable(folder / "rejects", REJECTS),
        }
        self._part_rows = part_rows
        self._out_of_date: dict[tuple[bool, str], set[Key]] = defaultdict(set)
        self._settled = self._read()

    def _read(self) -> dict[Key, Settled]:
        settled: dict[Key, Settled] = {}
        known: dict[Terms, Terms] = {}  # one object for all rows of the same terms
        for rejected, table in self._tables.items():
            for part, rows in table.read((*KEY, "sha256", *TERMS)):
                for row in rows.to_pylist():
                    terms = Terms(**{name: row[name] for name in TERMS})
                    settled[row["path"], row["task"]] = Settled(
                        rejected, part, row["sha256"], known.setdefault(terms, terms)
                    )
        return settled

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.write()

    def earlier(self, key: Key) -> Settled | None:
        """Return how an earlier run settled a question."""
        return self._settled.get(key)

    def annotate(self, job: Job, row: pa.RecordBatch) -> None:
        """Settle a question by its row."""
        self._add(job.key, row, rejected=False)

    def reject(
        self, key: Key, sha256: str | None, refusal: Refusal, attempts: int, terms: Terms
    ) -> None:
        """Settle a question by the reason why it has no row."""
        self._add(key, reject_row(key, sha256, refusal, attempts, terms), rejected=True)

    def _add(self, key: Key, row: pa.RecordBatch, *, rejected: bool) -> None:
        before = self._settled.pop(key, None)
        if before is not None:
            self._out_of_date[before.rejected, before.part].add(key)
        self._tables[rejected].add(row)
        if sum(table.unwritten for table in self._tables.values()) >= self._part_rows:
            self.write()

    def write(self) -> None:
        """Write what is settled and not written yet.

        Raises
        ------
        InvalidInput
            The system refuses: no right, no space.
        """
        for (rejected, part), keys in self._out_of_date.items():
            self._tables[rejected].remove(part, keys)
        self._out_of_date.clear()
        for table in self._tables.values():
            table.flush()
