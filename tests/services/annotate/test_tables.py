"""What stands in the tables, and what is said of damaged ones."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pyarrow")
import pyarrow as pa
import pyarrow.parquet as pq

from services.annotate.book import Book
from services.annotate.label import label
from services.annotate.parts import PartedTable
from services.annotate.question import Job, Question, Refusal, Terms
from services.annotate.schema import ANNOTATIONS, REJECTS
from shared.errors import InvalidInput
from tests.support.annotating import LightPipeline

DOCUMENT = Path(__file__).parents[3] / "docs" / "annotate.md"
QUESTION = Question(("pouring",), {"seed": 3, "gripper": "panda"})
TERMS = Terms(QUESTION.settings, "digest", "1.2.3")
JOB = Job("sub/a.xyz", "pouring", "0" * 64, b"cloud")


def row_of(job: Job) -> pa.RecordBatch:
    row = label(LightPipeline(), job, QUESTION.parameters, TERMS)
    assert not isinstance(row, Refusal), row
    return row


def test_a_row_says_what_the_answer_says() -> None:
    result = LightPipeline().grasp_file("input.xyz", JOB.data, JOB.task, **QUESTION.parameters)
    (row,) = row_of(JOB).to_pylist()
    region = np.zeros(row["points"], dtype=bool)
    region[row["region_index"]] = True
    part = np.full(row["points"], -1)
    part[row["part_index"]] = row["part_id"]
    np.testing.assert_array_equal(region, result.point_region)
    np.testing.assert_array_equal(part, result.point_primitive)
    np.testing.assert_array_equal(row["grasps"], result.grasps)
    assert [tuple(each) for each in row["primitives"]] == [
        each.parameters for each in result.answer.primitives
    ]
    assert (row["found"], row["confidence"], row["reason"]) == (True, 0.75, None)
    report = json.loads(row["report"])
    assert report["region"]["primitive_ids"] == [1]
    assert not {"request_id", "timings_ms"} & report.keys()
    assert json.loads(row["settings"]) == QUESTION.parameters


def test_an_answer_without_parts_is_a_row() -> None:
    (row,) = row_of(Job("a.xyz", "pouring", "0" * 64, b"nothing")).to_pylist()
    assert (row["found"], row["reason"], row["grasps"]) == (False, "no_part_matches", [])


def test_the_same_bytes_give_the_same_row_under_any_name() -> None:
    one, other = row_of(JOB), row_of(Job("b.xyz", "pouring", "0" * 64, b"cloud"))
    assert one.drop_columns(["path"]).equals(other.drop_columns(["path"]))


def test_the_columns_are_documented() -> None:
    text = DOCUMENT.read_text()
    for field in [*ANNOTATIONS, *REJECTS]:
        assert f"| `{field.name}` |" in text


def test_an_empty_table_has_its_columns(tmp_path: Path) -> None:
    PartedTable(tmp_path / "table", REJECTS)
    assert pq.read_table(tmp_path / "table").schema.equals(REJECTS)


def test_an_interrupt_after_the_write_does_not_double_the_part(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    table = PartedTable(tmp_path / "table", ANNOTATIONS)
    write = PartedTable._write

    def interrupted(self: PartedTable, name: str, rows: pa.Table) -> None:
        write(self, name, rows)
        raise KeyboardInterrupt

    table.add(row_of(JOB))
    with monkeypatch.context() as once:
        once.setattr(PartedTable, "_write", interrupted)
        with pytest.raises(KeyboardInterrupt):
            table.flush()
    table.flush()
    assert pq.read_table(tmp_path / "table").num_rows == 1


@pytest.mark.parametrize("damage", ["cut", "other"])
def test_a_damaged_part_is_named(tmp_path: Path, damage: str) -> None:
    with Book(tmp_path, part_rows=1) as book:
        book.annotate(JOB, row_of(JOB))
    part = tmp_path / "annotations" / "part-000000.parquet"
    if damage == "cut":
        part.write_bytes(part.read_bytes()[:100])
    else:
        pq.write_table(pa.table({"path": ["a"]}), part)
    with pytest.raises(InvalidInput, match=r"part-000000\.parquet cannot be read"):
        Book(tmp_path, part_rows=1)
