"""From certainty to confidence: rising, bounded, fitted as it should be."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from services.reasoning.confidence import MAPS, Map, read_maps
from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.schemas.task import DecideRequest, RuleSet
from tests.bench.rules.calibrate import error, fitted
from tests.services.reasoning.objects import HAMMER


def test_the_shipped_map_rises_strictly_within_bounds() -> None:
    scale = read_maps(MAPS)["default"]
    values = np.array([scale(each) for each in np.linspace(0.001, 0.999, 200)])
    assert (np.diff(values) > 0).all()
    assert 0 <= scale(0.0) < values[0]
    assert values[-1] < scale(1.0) <= 1


def test_a_map_that_falls_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "maps.json"
    file.write_text('{"default": {"offset": 0.0, "slope": -1.0}}')
    with pytest.raises(ValueError, match="must rise"):
        read_maps(file)


@pytest.mark.parametrize("rule_set", ["default", "thesis"])
def test_the_map_belongs_to_the_rule_set(
    reasoner: Reasoner, tmp_path: Path, rule_set: RuleSet
) -> None:
    plain = Reasoner(ReasoningSettings(knowledge_dir=tmp_path / "k", confidence_file=None))
    request = DecideRequest(task="hammering", primitives=HAMMER, rule_set=rule_set)
    certainty, confidence = plain.decide(request).region, reasoner.decide(request).region
    assert certainty is not None
    assert confidence is not None
    scale = read_maps(MAPS).get(rule_set, float)
    assert confidence.confidence == pytest.approx(scale(certainty.confidence))
    plain.close()


def test_a_fit_finds_the_map_that_made_the_answers() -> None:
    rng, true = np.random.default_rng(3), Map(1.5, 0.6)
    certainty = rng.uniform(0.02, 0.98, 20_000)
    chance = np.array([true(each) for each in certainty])
    good = (rng.random(len(chance)) < chance).astype(np.float64)
    offset, slope = fitted(certainty, good)
    assert offset == pytest.approx(1.5, abs=0.1)
    assert slope == pytest.approx(0.6, abs=0.05)
    assert error(chance, good) < 0.02
    assert error(certainty, good) > 0.1
