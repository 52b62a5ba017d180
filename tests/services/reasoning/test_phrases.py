"""Quantities in words."""

from __future__ import annotations

import pytest

from services.reasoning.phrases import Quantity, measured_as, named, value_text
from services.reasoning.wording import failing_wish, holding_clause
from shared.errors import JsonObject
from shared.settings import PROJECT_ROOT

SAME: Quantity = ["share", ["width", 1], ["width", 0]]
OWN: Quantity = ["share", ["length", 1], ["thickness", 1]]
WHOLE: Quantity = ["share", ["along", 1], ["object_length"]]


@pytest.mark.parametrize(
    ("value", "unit", "said"),
    [
        (0.0231, "m", "23 mm"),
        (-0.0004, "m", "-0.4 mm"),
        (4.2e-4, "m3", "420 cm3"),
        (44.6, "deg", "45 degrees"),
        (2.0, "count", "2"),
        (0.456, "ratio", "0.46"),
    ],
)
def test_values(value: float, unit: str, said: str) -> None:
    assert value_text(value, unit) == said


@pytest.mark.parametrize(
    ("quantity", "said"),
    [
        (["width", 1], "a width of 5 (at least 4)"),
        (["stretch", 1], "an elongation along the object of 5 (at least 4)"),
        (["reach", 1, 0], "a reach out of part 0 of 5 (at least 4)"),
        (SAME, "5 times the width of part 0 (at least 4)"),
        (OWN, "a length of 5 times its thickness (at least 4)"),
        (WHOLE, "an extent along the object of 5 times the length of the object (at least 4)"),
    ],
)
def test_what_a_part_has(quantity: Quantity, said: str) -> None:
    assert measured_as(quantity, "5", "at least 4") == said


@pytest.mark.parametrize(
    ("quantity", "said"),
    [
        (["holes", 1], "its number of openings"),
        (["object_width"], "the width of the object"),
        (SAME, "its width, relative to the width of part 0,"),
        (OWN, "its length, relative to its thickness,"),
    ],
)
def test_names(quantity: Quantity, said: str) -> None:
    assert named(quantity, "its") == said


def condition(**fields: object) -> JsonObject:
    return {"part": 1, "margin": None, "outside": [], "support": 0.1, **fields}


def test_a_length_that_fails_says_by_how_much() -> None:
    fat = condition(
        kind="at_most", quantity=["thickness", 1], measured=0.027, required=0.023, unit="m"
    )
    assert failing_wish(fat, own=True) == (
        "it were 4 mm thinner (27 mm where at most 23 mm is asked)"
    )
    assert failing_wish(fat, own=False).startswith("part 1 were 4 mm thinner")


def test_a_ratio_that_fails_says_what_it_is() -> None:
    stubby = condition(
        kind="at_least", quantity=["stretch", 1], measured=1.4996, required=1.5, unit="ratio"
    )
    assert failing_wish(stubby, own=False) == (
        "part 1's elongation along the object were at least 1.5 (it is 1.4996)"
    )


def test_what_is_denied() -> None:
    denied = condition(kind="absent", measured="rings", required=None)
    assert holding_clause(denied) == "does not count as rings"
    assert failing_wish(denied, own=True) == "it did not count as rings"
    assert failing_wish({**denied, "part": None}, own=True) == "no part counted as rings"


def test_every_quantity_of_the_rules_has_words() -> None:
    listed = (PROJECT_ROOT / "rules" / "quantities.pl").read_text()
    names = {
        line.split("quantity(")[1].split("(")[0].split(",")[0]
        for line in listed.splitlines()
        if line.startswith("quantity(") and "/" not in line.split(",")[0]
    }
    assert {"thickness", "object_width", "reach"} <= names
    for name in names:
        assert named([name, 1, 0], "its")
