"""The columns of both tables; docs/annotate.md says the same for people."""

from __future__ import annotations

import pyarrow as pa

from services.annotate.question import Refusal, Terms

KEY = ("path", "task")
TERMS = ("settings", "backend", "version")


def _column(name: str, kind: pa.DataType, meaning: str, *, nullable: bool = False) -> pa.Field:
    return pa.field(name, kind, nullable=nullable, metadata={"description": meaning})


def _rows_of(width: int) -> pa.DataType:
    return pa.list_(pa.list_(pa.float64(), width))


_PATH = _column("path", pa.string(), "of the file, below the input folder")
_TASK = _column("task", pa.string(), "what the object is for")
_TERMS = (
    _column("settings", pa.string(), "parameters of POST /grasp, JSON"),
    _column("backend", pa.string(), "digest of what the backend was taught and told"),
    _column("version", pa.string(), "of SPaRGE"),
)

ANNOTATIONS = pa.schema(
    [
        _PATH,
        _column("sha256", pa.string(), "of the file"),
        _TASK,
        _column("found", pa.bool_(), "whether a part to hold was found"),
        _column("reason", pa.string(), "code of docs/reasons.md, where empty", nullable=True),
        _column("confidence", pa.float64(), "of the region, 0 to 1", nullable=True),
        _column("frame_id", pa.string(), "frame of the input and of all poses"),
        _column("points", pa.int64(), "points (pixels) of the input"),
        _column("region_index", pa.list_(pa.int32()), "points to hold, ascending"),
        _column("part_index", pa.list_(pa.int32()), "points that are on a part, ascending"),
        _column("part_id", pa.list_(pa.int16()), "row of primitives, for each part_index"),
        _column("primitives", _rows_of(12), "e1 e2 a1 a2 a3 tx ty tz qx qy qz qw; m"),
        _column("grasps", _rows_of(9), "x y z qx qy qz qw width score, best first; m"),
        _column("report", pa.string(), "the JSON answer without its id and timings"),
        *_TERMS,
    ],
    metadata={"sparge_table": "annotations", "sparge_table_version": "1"},
)

REJECTS = pa.schema(
    [
        _PATH,
        _column("sha256", pa.string(), "of the file; none if it was not read", nullable=True),
        _TASK,
        _column("code", pa.string(), "of the contract's errors or of docs/annotate.md"),
        _column("message", pa.string(), "for people"),
        _column("attempts", pa.int32(), "how often it was asked about"),
        *_TERMS,
    ],
    metadata={"sparge_table": "rejects", "sparge_table_version": "1"},
)


def reject_row(
    key: tuple[str, str], sha256: str | None, refusal: Refusal, attempts: int, terms: Terms
) -> pa.RecordBatch:
    """Return a row of the rejects."""
    path, task = key
    row = {
        "path": path,
        "sha256": sha256,
        "task": task,
        "code": refusal.code,
        "message": refusal.message,
        "attempts": attempts,
        **vars(terms),
    }
    return pa.RecordBatch.from_pylist([row], schema=REJECTS)
