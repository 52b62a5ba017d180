"""No made-up request gets a 500, or an answer that the service's document does not have."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from services.gateway.settings import STAGES
from services.wiring import create_app, create_stage
from shared.schemas.execution import EXECUTE
from shared.schemas.route import Route
from shared.schemas.rule import ADD_AFFORDANCE, ADD_RULE
from shared.schemas.scene import PERCEIVE
from shared.schemas.task import ADD_TASK
from shared.wire import Message
from tests.contract.conformance import Explorer
from tests.support.fuzzing import CASES, SEED
from tests.support.serving import Client, in_process

Json = dict[str, Any]
THINNED = ("points", "obstacle_points", "point_region", "point_primitive", "focus")
EVERY = 12
"""Of the points of an example so many are left: an answer takes milliseconds."""
TAUGHT: dict[Route[Any, Any], Json] = {
    ADD_TASK: {"name": "watering", "requires": ["contain"], "grasp": ["wrap_grasp"]},
    ADD_RULE: {
        "name": "slicing_by_handle",
        "task": "slicing",
        "part": "handle",
        "conditions": [
            {"condition": "min_dimension", "of": ["handle"], "value": [0.005, 0.01, 0.05]},
            {"condition": "min_ratio", "of": ["blade"], "value": 12},
            {"condition": "different", "of": ["handle", "blade"]},
        ],
    },
    ADD_AFFORDANCE: {
        "name": "rollable",
        "rules": [
            {"name": "is_round", "conditions": [{"condition": "shape", "value": ["sphere"]}]}
        ],
    },
}


@pytest.fixture
def served(service: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Client]:
    """One of the services, with an empty knowledge folder of its own."""
    monkeypatch.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", str(tmp_path / "knowledge"))
    monkeypatch.setenv("SPARGE_EXECUTION_TIME_LIMIT_S", "10")
    with in_process(create_app() if service == "gateway" else create_stage(service)) as client:
        yield client


def small(route: Route[Any, Any], request: Message) -> Json:
    """Return a true request with fewer points and pixels, as JSON."""
    fields = request.model_dump(mode="json", exclude_none=True)
    if route is PERCEIVE:
        fields["depth"] = [row[::4] for row in fields["depth"][::4]]
        fields["intrinsics"] = [[each / 4 for each in row] for row in fields["intrinsics"][:2]]
        fields["intrinsics"] += [[0.0, 0.0, 1.0]]
    for name in THINNED:
        if name in fields:
            fields[name] = fields[name][::EVERY]
    if "samples" in fields:
        fields["samples"] = 20
    if route is EXECUTE:
        fields["width"] = 0.5  # wider than the gripper opens: answered without physics
    return fields


def inference(view: Json) -> Json:
    """Return the same view as tensors."""
    return {
        "id": "7",
        "parameters": {"max_grasps": 3},
        "inputs": [
            tensor("depth", "UINT16", view["depth"]),
            tensor("intrinsics", "FP64", view["intrinsics"]),
            tensor("depth_scale", "FP64", [view["depth_scale"]]),
            tensor("task", "BYTES", ["cooking"]),
        ],
        "outputs": [{"name": "grasps"}, {"name": "report"}],
    }


def tensor(name: str, datatype: str, data: list[Any]) -> Json:
    shape = [len(data), *([len(data[0])] if isinstance(data[0], list) else [])]
    return {"name": name, "datatype": datatype, "shape": shape, "data": data}


@pytest.fixture
def true_requests(service: str, examples: dict[Route[Any, Any], Message]) -> dict[str, Json]:
    """JSON bodies by the label of the operation that they are for."""
    held = {route: small(route, each) for route, each in examples.items()} | TAUGHT
    if service == "gateway":
        points = small(PERCEIVE, examples[PERCEIVE])
        return {
            "POST /grasp": {**points, "task": "cooking", "max_grasps": 3},
            "POST /v2/models/sparge/infer": inference(points),
        }
    return {
        f"{route.method} {route.path}": body
        for route, body in held.items()
        if route.service == service and route.method == "POST"
    }


@pytest.mark.parametrize("service", [*STAGES, "gateway"])
def test_every_answer_is_a_documented_one(
    service: str, served: Client, true_requests: dict[str, Json]
) -> None:
    explorer = Explorer(served, SEED)
    explorer.from_schemas(CASES)
    assert explorer.statuses.total() >= CASES
    assert explorer.statuses[200]
    before = explorer.statuses[200]
    explorer.from_examples(true_requests, CASES // 4)
    assert explorer.statuses[200] > before, "some changes do no harm: it gets to the end"
    print(f"\n{service}: {dict(sorted(explorer.statuses.items()))}", end="")
