"""Every stage served in this process and over a socket, and a true request for each route."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pytest

from services.wiring import create_stage
from shared.schemas.execution import EXECUTE, ExecuteRequest
from shared.schemas.grasp import (
    FIND_REGION,
    LIST_GRIPPERS,
    PROPOSE,
    SELECT,
    Pose,
    ProposeRequest,
    RegionRequest,
    SelectRequest,
)
from shared.schemas.knowledge import (
    EXPORT_KNOWLEDGE,
    LIST_QUESTIONS,
    QUERY_KNOWLEDGE,
    SparqlQuery,
)
from shared.schemas.primitive import RECOVER, RecoverRequest, superquadric_rows
from shared.schemas.route import Nothing, Route
from shared.schemas.rule import LIST_RULES
from shared.schemas.scene import PERCEIVE, PerceiveRequest
from shared.schemas.task import DECIDE, LIST_AFFORDANCES, LIST_TASKS, DecideRequest
from shared.wire import NPZ, Message, decode, encode
from tests.support.samples import sample_view
from tests.support.serving import Client, in_process, over_socket

LIMIT = 10**9
TRANSPORTS = {"in_process": in_process, "socket": over_socket}
POSTED = (PERCEIVE, RECOVER, DECIDE, QUERY_KNOWLEDGE, FIND_REGION, PROPOSE, SELECT, EXECUTE)
LISTED = (
    LIST_TASKS,
    LIST_AFFORDANCES,
    LIST_RULES,
    LIST_QUESTIONS,
    EXPORT_KNOWLEDGE,
    LIST_GRIPPERS,
)


@dataclass(frozen=True)
class Stages:
    """Starts each stage when it is first needed, once per transport."""

    start: Callable[[str, str], Client]

    def ask(
        self,
        route: Route[Any, Any],
        request: Message,
        *,
        transport: str = "in_process",
        media_type: str = NPZ,
    ) -> Any:
        """Return the decoded answer; the test fails on any but 200."""
        response = self.start(route.service, transport).request(
            route.method,
            route.path,
            headers={"Accept": media_type, "Content-Type": media_type},
            content=encode(request, media_type) if route.method == "POST" else None,
        )
        assert response.status_code == 200, response.text
        assert response.headers["content-type"] == media_type
        return decode(route.response, response.content, media_type, LIMIT)


@pytest.fixture(scope="session")
def stages(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stages]:
    running: dict[tuple[str, str], Client] = {}
    with contextlib.ExitStack() as stack:
        environment = stack.enter_context(pytest.MonkeyPatch.context())
        knowledge = str(tmp_path_factory.mktemp("knowledge"))
        environment.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", knowledge)

        def start(service: str, transport: str) -> Client:
            if (service, transport) not in running:
                serve = TRANSPORTS[transport]
                running[service, transport] = stack.enter_context(serve(create_stage(service)))
            return running[service, transport]

        yield Stages(start)


@pytest.fixture(scope="session")
def examples(stages: Stages) -> dict[Route[Any, Any], Message]:
    """A request per route, each made from what the stage before it answered."""
    view = sample_view("saucepan")
    perceive = PerceiveRequest(**view)
    scene = stages.ask(PERCEIVE, perceive)
    recover = RecoverRequest(points=scene.object_points, plane=scene.plane, up=scene.up)
    primitives = stages.ask(RECOVER, recover).primitives
    region = RegionRequest(
        points=scene.object_points, primitives=primitives, primitive_ids=(primitives[0].id,)
    )
    found = stages.ask(FIND_REGION, region)
    propose = ProposeRequest(
        points=scene.object_points,
        obstacle_points=scene.obstacle_points,
        plane=scene.plane,
        up=scene.up,
        superquadrics=superquadric_rows(primitives),
        samples=60,
    )
    grasps = stages.ask(PROPOSE, propose).grasps
    assert len(grasps), "the sample view offers grasps"
    return {
        PERCEIVE: perceive,
        RECOVER: recover,
        DECIDE: DecideRequest(task="cooking", primitives=primitives),
        QUERY_KNOWLEDGE: SparqlQuery(query="ASK { ?task ?relation ?affordance }"),
        FIND_REGION: region,
        PROPOSE: propose,
        SELECT: SelectRequest(
            points=scene.object_points, point_region=found.point_region, grasps=grasps
        ),
        EXECUTE: ExecuteRequest(
            pose=Pose(position=tuple(grasps[0, :3]), quaternion=tuple(grasps[0, 3:7])),
            width=float(grasps[0, 7]),
            primitives=tuple(each.parameters for each in primitives),
            plane=scene.plane,
        ),
        **{route: Nothing() for route in LISTED},
    }
