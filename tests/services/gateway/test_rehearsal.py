"""Grasps in doubt are tried in simulation before they are answered."""

from __future__ import annotations

import asyncio
import functools
import io
from typing import Any, get_args

import httpx
import numpy as np
import pytest
from numpy.typing import NDArray

from services.gateway.rehearsal import AT_MOST, Rehearsed, after, rehearse
from services.gateway.settings import GatewaySettings
from shared.errors import InvalidInput, SpargeError, StageUnavailable
from shared.schemas.execution import ExecuteResponse, Outcome
from shared.schemas.grasp import ProposeResponse, SelectResponse
from shared.schemas.rehearsal import Rehearsal, Rehearsing
from shared.wire.npz import read_npz
from tests.support.samples import sample_path
from tests.support.serving import Client

Array = NDArray[np.float64]
OUTCOMES = get_args(Outcome)


def proposal(scores: list[float], doubtful: list[bool] | None = None) -> ProposeResponse:
    """Return grasps that lie side by side along x."""
    grasps = np.zeros((len(scores), 9))
    grasps[:, 0], grasps[:, 6], grasps[:, 8] = np.arange(len(scores)), 1.0, scores
    return ProposeResponse(
        grasps=grasps,
        on_focus=np.ones((len(scores), 3)),
        keeps_clear=np.ones(len(scores), dtype=bool),
        doubtful=np.ones(len(scores), dtype=bool) if doubtful is None else np.array(doubtful),
        considered=len(scores),
        rejected={},
    )


async def select(grasps: Array, at_least: int, wanted: int = 100) -> SelectResponse:
    order = np.argsort(-grasps[:, 8], kind="stable")[: max(wanted, at_least)]
    return SelectResponse(grasps=grasps[order], indices=order.astype(np.int32), outside_region=0)


Came = tuple[Outcome, Outcome]
HELD: Came = ("held", "held")
LOST: Came = ("slipped_in_lift", "missed")
SHAKEN: Came = ("held", "slipped_in_shake")


class Stage:
    """Lets each grasp come to what is foreseen for it, on two shapes."""

    def __init__(self, *foreseen: Came | Exception) -> None:
        self.foreseen = foreseen
        self.tried: list[int] = []

    async def __call__(self, grasp: Array) -> list[ExecuteResponse]:
        self.tried.append(int(grasp[0]))
        came = self.foreseen[self.tried[-1]]
        if isinstance(came, Exception):
            raise came
        return [
            ExecuteResponse(
                success=outcome == "held",
                lifted=outcome in ("held", "slipped_in_shake"),
                outcome=outcome,
                message="",
                lift_height=0.3,
                phases=(),
            )
            for outcome in came
        ]


def rehearsed(asked: ProposeResponse, stage: Stage, how: Rehearsing = "auto") -> Rehearsed:
    return asyncio.run(rehearse(asked, select, stage, how))


def test_what_every_shape_holds_stays_first_and_nothing_else_is_tried() -> None:
    stage = Stage(HELD, HELD)
    known = rehearsed(proposal([0.8, 0.7]), stage)
    assert stage.tried == [0]
    assert known.selected.indices.tolist() == [0, 1]
    assert known.of_answered == (HELD, ())
    assert known.selected.grasps[0, 8] > 0.8
    assert known.selected.grasps[1, 8] == 0.7
    assert known.report == Rehearsal(tried=1)


def test_what_slips_goes_behind_and_the_next_is_tried() -> None:
    stage = Stage(LOST, HELD, HELD)
    known = rehearsed(proposal([0.80, 0.78, 0.70]), stage)
    assert stage.tried == [0, 1]
    assert known.selected.indices.tolist() == [1, 2, 0]
    assert known.of_answered == (HELD, (), LOST)
    assert (np.diff(known.selected.grasps[:, 8]) <= 0).all()


def test_one_that_slips_and_still_is_the_best_is_answered() -> None:
    stage = Stage(SHAKEN, LOST)
    known = rehearsed(proposal([0.89, 0.88]), stage)
    assert stage.tried == [0, 1]
    assert known.selected.indices.tolist() == [0, 1]


def test_what_cannot_become_the_best_is_not_tried() -> None:
    stage = Stage(SHAKEN, HELD)
    known = rehearsed(proposal([0.89, 0.3]), stage)
    assert stage.tried == [0]
    assert known.selected.indices.tolist() == [0, 1]
    assert known.report == Rehearsal(tried=1)


@pytest.mark.parametrize("seed", range(20))
def test_the_best_is_that_of_trying_all(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("services.gateway.rehearsal.AT_MOST", 6)
    rng = np.random.default_rng(seed)
    scores = np.sort(rng.uniform(0.5, 0.9, 6))[::-1]
    came = [(HELD, SHAKEN, LOST)[each] for each in rng.integers(0, 3, 6)]
    known = rehearsed(proposal(scores.tolist()), Stage(*came))
    finally_ = [after(score, each) for score, each in zip(scores, came, strict=True)]
    assert known.selected.indices[0] == np.argmax(finally_)


def test_one_answered_grasp_is_the_best_of_those_that_were_tried() -> None:
    one = functools.partial(select, wanted=1)
    asked = proposal([0.80, 0.78, 0.75])
    known = asyncio.run(rehearse(asked, one, Stage(LOST, HELD), "auto"))
    assert known.selected.indices.tolist() == [1]
    assert known.of_answered == (HELD,)
    assert known.report == Rehearsal(tried=2)
    untouched = asyncio.run(rehearse(proposal([0.99, 0.9], [False, True]), one, Stage(), "auto"))
    assert untouched.selected.indices.tolist() == [0]


def test_only_grasps_in_doubt_are_tried_and_none_where_the_best_is_not() -> None:
    stage = Stage(HELD, HELD)
    assert rehearsed(proposal([0.95, 0.8], [False, True]), stage).report is None
    assert stage.tried == []
    stage = Stage(LOST, HELD, LOST)
    known = rehearsed(proposal([0.8, 0.79, 0.78], [True, False, True]), stage)
    assert stage.tried == [0, 2]
    assert known.selected.indices.tolist() == [1, 0, 2]
    assert known.of_answered == ((), LOST, LOST)
    assert known.report == Rehearsal(tried=2)


def test_never_and_always() -> None:
    stage = Stage(HELD)
    assert rehearsed(proposal([0.8]), stage, "never").report is None
    assert stage.tried == []
    known = rehearsed(proposal([0.99], [False]), stage, "always")
    assert known.of_answered == (HELD,)


def test_no_more_than_so_many_are_tried() -> None:
    scores = np.linspace(0.8, 0.79, 2 * AT_MOST).tolist()
    stage = Stage(*[LOST] * len(scores))
    assert rehearsed(proposal(scores), stage).report == Rehearsal(tried=AT_MOST)
    assert stage.tried == list(range(AT_MOST))


def test_nothing_to_rehearse() -> None:
    assert rehearsed(proposal([]), Stage()).report is None
    assert rehearsed(proposal([]), Stage(), "always").report is None


@pytest.mark.parametrize("error", [StageUnavailable("down", stage="execution"), InvalidInput("no")])
def test_a_failure_leaves_the_order_as_it_is_known_and_is_told(error: SpargeError) -> None:
    stage = Stage(LOST, error, HELD)
    known = rehearsed(proposal([0.8, 0.78, 0.75]), stage)
    assert known.selected.indices.tolist() == [1, 2, 0]
    assert known.report == Rehearsal(tried=1, stopped=error.code)
    with pytest.raises(type(error)):
        rehearsed(proposal([0.8]), Stage(error), "always")


@pytest.mark.parametrize("score", [0.0, 1e-12, 0.3, 0.999999, 1.0])
def test_scores_stay_probabilities_in_the_order_of_the_outcomes(score: float) -> None:
    scores = {outcome: after(score, [outcome]) for outcome in OUTCOMES}
    assert all(0 <= each <= 1 for each in scores.values())
    assert scores["held"] >= scores["slipped_in_shake"] >= scores["slipped_in_lift"]
    assert scores["missed"] == scores["slipped_in_lift"]
    if 0 < score < 0.9:
        assert after(score, HELD) > scores["held"] > score > scores["missed"]
        assert scores["held"] > scores["slipped_in_shake"] > scores["missed"]
        assert after(score, ("missed", "held")) == pytest.approx(after(score, ("held", "missed")))


def asked(backend: Client, sample: str, task: str, **query: str) -> httpx.Response:
    return backend.request(
        "POST",
        "/grasp",
        params={"task": task, **query},
        content=sample_path(sample).read_bytes(),
        headers={"Content-Type": "application/x-npz"},
    )


def answer(backend: Client, sample: str, task: str, **query: str) -> dict[str, Any]:
    response = asked(backend, sample, task, **query)
    assert response.status_code == 200, response.text
    found: dict[str, Any] = response.json()
    return found


def test_the_answer_says_what_came_of_the_best_grasps(backend: Client) -> None:
    told = answer(backend, "saucepan", "cooking", rehearsal="always")
    tried = [each["rehearsed"] for each in told["grasps"] if "rehearsed" in each]
    assert told["rehearsal"]["stopped"] is None
    assert 1 <= len(tried) <= told["rehearsal"]["tried"] <= AT_MOST
    assert {len(each) for each in tried} == {2}
    assert {outcome for each in tried for outcome in each} <= set(OUTCOMES)
    assert "rehearsed" in told["grasps"][0]
    assert told["timings_ms"]["rehearsal"] > 0
    again = answer(backend, "saucepan", "cooking", rehearsal="always")
    assert again["grasps"] == told["grasps"]


def test_nothing_is_said_where_nothing_was_rehearsed(backend: Client) -> None:
    told = answer(backend, "saucepan", "cooking", rehearsal="never")
    assert "rehearsal" not in told
    assert "rehearsal" not in told["timings_ms"]
    assert not any("rehearsed" in each for each in told["grasps"])


def test_where_no_grasp_is_wanted_none_is_tried(backend: Client) -> None:
    told = answer(backend, "saucepan", "cooking", rehearsal="always", max_grasps="0")
    assert told["grasps"] == []
    assert "rehearsal" not in told


def test_the_arrays_are_in_the_same_order(backend: Client) -> None:
    response = backend.request(
        "POST",
        "/grasp",
        params={"task": "cooking", "rehearsal": "always"},
        content=sample_path("saucepan").read_bytes(),
        headers={"Content-Type": "application/x-npz", "Accept": "application/x-npz"},
    )
    rows = read_npz(io.BytesIO(response.content).getvalue(), 10**8)["grasps"]
    told = answer(backend, "saucepan", "cooking", rehearsal="always")["grasps"]
    np.testing.assert_allclose(rows[:, 8], [each["score"] for each in told])
    np.testing.assert_allclose(rows[:, :3], [each["pose"]["position"] for each in told])


def test_a_suction_cup_is_rehearsed_where_it_is_asked_for(backend: Client) -> None:
    told = answer(backend, "spatula", "handover", rehearsal="always", gripper="onrobot_vgc10")
    assert "held" in told["grasps"][0]["rehearsed"]


def test_an_unknown_way_to_rehearse_is_told(backend: Client) -> None:
    response = asked(backend, "bottle", "pouring", rehearsal="sometimes")
    assert response.status_code == 422
    assert "rehearsal" in response.text


def test_a_backends_own_way_is_one_of_three(monkeypatch: pytest.MonkeyPatch) -> None:
    assert GatewaySettings().rehearsal == "never"
    monkeypatch.setenv("SPARGE_GATEWAY_REHEARSAL", "auto")
    assert GatewaySettings().rehearsal == "auto"
    monkeypatch.setenv("SPARGE_GATEWAY_REHEARSAL", "sometimes")
    with pytest.raises(ValueError, match="rehearsal"):
        GatewaySettings()
