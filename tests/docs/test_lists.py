"""Pages that list things list all of them, and nothing else."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import pytest

from experiments.catalogue import CATALOGUE, build
from services.reasoning.reasons import CODES
from shared.errors import SpargeError
from shared.schemas.rejection import WHY_REJECTED, RejectionCode
from shared.settings import PROJECT_ROOT

DOCS = PROJECT_ROOT / "docs"
ROW = re.compile(r"^\| ((?:`\w+`(?:, )?)+) \|", re.MULTILINE)


def codes_in(page: Path) -> list[str]:
    """Return the codes in the first columns of a page's tables."""
    return [code for row in ROW.findall(page.read_text()) for code in re.findall(r"\w+", row)]


def test_troubleshooting_has_every_code_once() -> None:
    entries = codes_in(DOCS / "troubleshooting.md")
    known = {*SpargeError.by_code, SpargeError.code, *codes_in(DOCS / "reasons.md")}
    assert sorted(entries) == sorted(known)


def test_the_reasons_are_those_of_the_code() -> None:
    reasons = set(codes_in(DOCS / "reasons.md"))
    assert reasons >= CODES
    gateway = (PROJECT_ROOT / "services" / "gateway" / "answer.py").read_text()
    for code in reasons - CODES:
        assert f'"{code}"' in gateway, f"{code} is in no answer"


def test_every_reason_to_leave_a_hand_pose_out_is_listed() -> None:
    assert codes_in(DOCS / "rejected.md") == list(WHY_REJECTED) == list(get_args(RejectionCode))


def test_every_code_comes_with_a_cause_and_a_remedy() -> None:
    rows = re.findall(
        r"^\| `\w+` \|(.*)\|$", (DOCS / "troubleshooting.md").read_text(), re.MULTILINE
    )
    assert len(rows) > 25
    for row in rows:
        cause, remedy = (cell.strip() for cell in row.split(" | "))
        assert len(cause) > 8, row
        assert len(remedy) > 8, row


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_gallery_shows_every_object_with_its_regions(name: str) -> None:
    page = (DOCS / "gallery.md").read_text()
    picture = DOCS / "images" / "gallery" / f"{name}.webp"
    assert picture.read_bytes()[8:12] == b"WEBP"
    assert f"](images/gallery/{name}.webp)" in page
    for task, parts in build(name).regions.items():
        assert f"{task}: {', '.join(parts)}" in page


def test_the_pictures_stay_small() -> None:
    sizes = {each.name: each.stat().st_size for each in (DOCS / "images").rglob("*.webp")}
    assert max(sizes.values()) < 100_000, sizes
    assert sum(sizes.values()) < 600_000
