"""A Parquet table in parts: files that one process writes and anybody may read meanwhile."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from services.annotate.schema import KEY
from shared.errors import InvalidInput
from shared.output import unusable, write_whole

_SUFFIX = ".parquet"
_EMPTY = f"part-empty{_SUFFIX}"


class PartedTable:
    """A folder of Parquet files of one schema.

    A file appears whole, is replaced whole by a shorter one, or vanishes, so a reader never
    sees half a row, nor a row twice. One file has no rows: it says which columns there are
    as long as there is no other.

    Parameters
    ----------
    folder : Path
        Made where it is missing.
    schema : pyarrow.Schema
        With the columns `KEY`.
    """

    def __init__(self, folder: Path, schema: pa.Schema) -> None:
        self._folder, self._schema = folder, schema
        numbers = [int(path.stem.removeprefix("part-")) for path in self._paths()]
        # Number and rows of the part to come: one value, so that an interrupt finds a part
        # either still to come (then it is written again, under the same name) or behind us.
        self._coming: tuple[int, list[pa.RecordBatch]] = (max(numbers, default=-1) + 1, [])
        if not (folder / _EMPTY).exists():
            self._write(_EMPTY, schema.empty_table())

    def read(self, columns: Sequence[str]) -> Iterator[tuple[str, pa.Table]]:
        """Yield the name of every part, in order, and these columns of its rows.

        Raises
        ------
        InvalidInput
            A file is damaged, or no part of this table.
        """
        for path in self._paths():
            yield path.name, self._read(path, columns)

    def _paths(self) -> list[Path]:
        return sorted(self._folder.glob(f"part-[0-9]*{_SUFFIX}"))

    def add(self, row: pa.RecordBatch) -> None:
        """Add a row to the part to come."""
        self._coming[1].append(row)

    @property
    def unwritten(self) -> int:
        """How many rows the part to come has."""
        return len(self._coming[1])

    def flush(self) -> None:
        """Write the part to come, ordered by the rows' keys, if it has any."""
        number, rows = self._coming
        if rows:
            table = pa.Table.from_batches(rows, schema=self._schema)
            ordered = table.sort_by([(column, "ascending") for column in KEY])
            self._write(f"part-{number:06d}{_SUFFIX}", ordered)
            self._coming = (number + 1, [])

    def remove(self, name: str, keys: Set[tuple[str, str]]) -> None:
        """Remove the rows with these keys from a part, and the part when none is left."""
        path = self._folder / name
        if not path.exists():
            return
        table = self._read(path, self._schema.names)
        held = zip(*(table[column].to_pylist() for column in KEY), strict=True)
        left = table.filter(pa.array([key not in keys for key in held], type=pa.bool_()))
        if left.num_rows:
            self._write(name, left)
            return
        try:
            path.unlink()
        except OSError as error:
            raise unusable(path, error) from None

    def _read(self, path: Path, columns: Sequence[str]) -> pa.Table:
        try:
            with pq.ParquetFile(path) as file:
                if file.schema_arrow.equals(self._schema):
                    return file.read(columns=list(columns))
                reason = "it has other columns"
        except (OSError, pa.ArrowException) as error:
            reason = str(error).splitlines()[0]
        raise InvalidInput(
            f"{path} cannot be read as a part of this table: {reason}. Remove it, and its rows "
            "are made anew, or name another folder"
        )

    def _write(self, name: str, table: pa.Table) -> None:
        sink = pa.BufferOutputStream()
        pq.write_table(table, sink, compression="zstd")
        write_whole(self._folder / name, memoryview(sink.getvalue()))
