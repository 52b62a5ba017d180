"""What counts as the same output."""

from __future__ import annotations

import pytest

from tests.docs.likeness import difference


@pytest.mark.parametrize(
    ("shown", "printed"),
    [
        ("hold part 0, confidence 0.95", "hold part 0,\n  confidence 0.96"),
        ("a  b\n ───── \n c", "a b c"),
        ("position -0.007 +0.799", "position +0.4 -0.1"),
        ('{"request_id": "abc", "n": 1}', '{"request_id":"def","n":1}'),
        ("took 12 ms, 3.4 s", "took 900 ms, 0.1 s"),
        (
            "Why\nbecause\nTime (ms)  parsing 8  total 356",
            "Why because\nTime (ms) parsing 1 total 2",
        ),
        ("first ... last", "first second third last"),
        ("first ...", "first second third last"),
        ("... last", "first second third last"),
        ("2026-11-26 took", "2027-01-01 took"),
    ],
)
def test_the_same(shown: str, printed: str) -> None:
    assert difference(shown, printed) is None


@pytest.mark.parametrize(
    ("shown", "printed"),
    [
        ("hold part 0", "hold part 3"),
        ("hold part 0", "keep part 0"),
        ("confidence 0.95", "confidence 0.30"),
        ("first last", "first second last"),
        ("first", "first second"),
        ("first second", "first"),
        ("first ... last", "first second third"),
        ("", "something"),
    ],
)
def test_not_the_same(shown: str, printed: str) -> None:
    assert difference(shown, printed) is not None
