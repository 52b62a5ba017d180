"""One file and one task -> a row, or the reason why there is none: what a worker does."""

from __future__ import annotations

import logging
from pathlib import PurePath
from typing import Any

import numpy as np
import pyarrow as pa

from services.annotate.pipeline import Pipeline
from services.annotate.question import Job, Refusal, Terms
from services.annotate.schema import ANNOTATIONS
from shared.client import GraspResult
from shared.errors import SpargeError
from shared.schemas.primitive import superquadric_rows

log = logging.getLogger("sparge")


def label(pipeline: Pipeline, job: Job, parameters: dict[str, Any], terms: Terms) -> Any:
    """Return the row (a `pyarrow.RecordBatch`) or the `Refusal` of a job; raises nothing.

    The backend never learns the file's name, only its extension: the same bytes give
    the same row.
    """
    try:
        name = f"input{PurePath(job.path).suffix}"
        result = pipeline.grasp_file(name, job.data, job.task, **parameters)
        return _row(job, result, terms)
    except SpargeError as error:
        return Refusal(error.code, error.message, passing=error.status >= 500)
    except Exception as error:
        log.exception("no row for %s", job.path)
        return Refusal("internal", f"{type(error).__name__}: {error}", passing=True)


def _row(job: Job, result: GraspResult, terms: Terms) -> pa.RecordBatch:
    answer = result.answer
    on_part = np.flatnonzero(result.point_primitive >= 0)
    ids = [each.id for each in answer.primitives]
    row_of = np.full(max(ids, default=-1) + 1, -1, dtype=np.int16)
    row_of[ids] = np.arange(len(ids))
    row = {
        "path": job.path,
        "sha256": job.sha256,
        "task": job.task,
        "found": answer.found,
        "reason": answer.reason.code if answer.reason else None,
        "confidence": answer.region.confidence if answer.region else None,
        "frame_id": answer.frame_id,
        "points": len(result.point_primitive),
        "region_index": np.flatnonzero(result.point_region),
        "part_index": on_part,
        "part_id": row_of[result.point_primitive[on_part]],
        "primitives": superquadric_rows(answer.primitives).tolist(),
        "grasps": result.grasps.tolist(),
        "report": answer.model_dump_json(exclude={"request_id", "timings_ms"}),
        **vars(terms),
    }
    arrays = [pa.array([row[field.name]], type=field.type) for field in ANNOTATIONS]
    return pa.RecordBatch.from_arrays(arrays, schema=ANNOTATIONS)
