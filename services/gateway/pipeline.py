"""The chain: perception, primitives, reasoning, region, grasps, selection, rehearsal.

Data flows one way; no stage calls back. Every call has what is left of the
request's time (`shared.deadline`).
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from cachetools import TTLCache
from numpy.typing import NDArray

from services.gateway.formats import require_fitting
from services.gateway.metrics import GraspMetrics
from services.gateway.rehearsal import Rehearsed, rehearse
from services.gateway.request import GraspRequest
from services.gateway.settings import GatewaySettings
from shared.deadline import remaining_s, within
from shared.errors import SpargeError, UnknownGripper
from shared.rehearsal import rehearsals
from shared.schemas.execution import EXECUTE, ExecuteResponse
from shared.schemas.grasp import (
    FIND_REGION,
    LIST_GRIPPERS,
    PROPOSE,
    SELECT,
    ProposeRequest,
    ProposeResponse,
    RegionRequest,
    RegionResponse,
    SelectRequest,
    SelectResponse,
)
from shared.schemas.gripper import Gripper, ParallelGripper
from shared.schemas.primitive import (
    RECOVER,
    RecoverRequest,
    RecoverResponse,
    superquadric_rows,
)
from shared.schemas.route import Nothing, Request, Response, Route
from shared.schemas.scene import PERCEIVE, PerceiveRequest, PerceiveResponse
from shared.schemas.task import DECIDE, DecideRequest, DecideResponse
from shared.service import Stage

Array = NDArray[np.float64]
REHEARSAL = "rehearsal"
"""Grasps tried in simulation before they are answered, among the timings."""
CHECKS = "checks"
"""Whether the task and the gripper are known, among the timings; it runs beside perception."""
REMEMBER_S = 5.0
REMEMBERED = 1024
_Named = tuple[str, str, str]
"""Task, version of the reasoning, set of rules."""


@dataclass(frozen=True)
class Outcome:
    """What the stages answered; no grasps are asked for where there is no region to hold."""

    scene: PerceiveResponse
    recovered: RecoverResponse
    decision: DecideResponse
    assigned: RegionResponse
    proposed: ProposeResponse | None
    rehearsed: Rehearsed | None
    gripper: Gripper
    timings_ms: dict[str, float]

    @property
    def selected(self) -> SelectResponse | None:
        return None if self.rehearsed is None else self.rehearsed.selected

    @property
    def grasps(self) -> Array:
        """Grasp rows (G, 9)."""
        return np.empty((0, 9)) if self.selected is None else self.selected.grasps


@dataclass
class _Run:
    """One request under way: what each stage took."""

    stages: Mapping[str, Stage]
    metrics: GraspMetrics
    deadline_s: float
    timings_ms: dict[str, float] = field(default_factory=lambda: {CHECKS: 0.0})

    async def call(
        self, route: Route[Request, Response], request: Request, timed_as: str | None = None
    ) -> Response:
        (answer,) = await self.call_all(route, [request], timed_as or route.service)
        return answer

    async def call_all(
        self, route: Route[Request, Response], requests: Sequence[Request], timed_as: str
    ) -> list[Response]:
        """Return the answers to requests that are sent at once; all have ended by then."""
        stage, started = self.stages[route.service], time.perf_counter()
        calls = (stage.call(route, each, self.deadline_s) for each in requests)
        try:
            answers: list[Response] = []
            for came in await asyncio.gather(*calls, return_exceptions=True):
                if isinstance(came, BaseException):
                    raise came
                answers.append(came)
            return answers
        except SpargeError as error:
            self.metrics.failed(route.service, error.code)
            raise
        finally:
            spent = 1e3 * (time.perf_counter() - started)
            self.timings_ms[timed_as] = self.timings_ms.get(timed_as, 0.0) + spent


class Pipeline:
    """Runs the chain over typed clients, wherever the stages live."""

    def __init__(
        self, stages: Mapping[str, Stage], settings: GatewaySettings, metrics: GraspMetrics
    ) -> None:
        self._stages = stages
        self._settings = settings
        self._metrics = metrics
        # What was known a moment ago is not asked for again: the stages check it anyway.
        self._known_tasks: TTLCache[_Named, bool] = TTLCache(REMEMBERED, REMEMBER_S)
        self._grippers: TTLCache[str, Gripper] = TTLCache(REMEMBERED, REMEMBER_S)

    async def run(self, request: GraspRequest) -> Outcome:
        """Return what every stage found.

        Raises
        ------
        SpargeError
            The error of the stage that refused, or of the chain itself.
        """
        run = _Run(self._stages, self._metrics, self._settings.deadline_s)
        try:
            return await self._chain(run, request)
        finally:
            self._metrics.spent(run.timings_ms)

    async def _chain(self, run: _Run, request: GraspRequest) -> Outcome:
        gripper, scene = await self._perceive(run, request)
        recovered = await self._recover(run, request, scene)
        decision = await self._decide(run, request, scene, recovered, gripper)
        chosen = decision.region.primitive_ids if decision.region else ()
        assigned = await run.call(
            FIND_REGION,
            RegionRequest(
                points=scene.object_points,
                primitives=recovered.primitives,
                primitive_ids=chosen,
                point_primitive=recovered.point_primitive,
            ),
        )
        proposed, rehearsed = None, None
        if assigned.point_region.any() and request.parameters.max_grasps > 0:
            proposed = await self._propose(run, request, scene, recovered, assigned)
            rehearsed = await self._choose(run, request, scene, recovered, assigned, proposed)
        return Outcome(
            scene, recovered, decision, assigned, proposed, rehearsed, gripper, run.timings_ms
        )

    async def _perceive(self, run: _Run, request: GraspRequest) -> tuple[Gripper, PerceiveResponse]:
        parameters = request.parameters
        view = {name: getattr(request.view, name) for name in type(request.view).model_fields}
        perceive = run.call(
            PERCEIVE,
            PerceiveRequest(
                **view,
                input=parameters.input,
                target=parameters.target,
                seed=parameters.seed,
            ),
        )
        # Names are checked while perception works, so that a typing error is
        # told at once and whatever else the request holds.
        gripper, scene = await asyncio.gather(
            self._check_names(run, request), perceive, return_exceptions=True
        )
        if isinstance(gripper, BaseException):
            raise gripper
        if isinstance(scene, BaseException):
            raise scene
        return gripper, scene

    async def _check_names(self, run: _Run, request: GraspRequest) -> Gripper:
        """Return the gripper that was asked for, if task and format are possible with it."""
        _, gripper = await asyncio.gather(
            self._check_task(run, request), self._check_gripper(run, request)
        )
        return gripper

    async def _check_task(self, run: _Run, request: GraspRequest) -> None:
        question = request.parameters
        rule_set = question.rule_set or self._settings.rule_set
        asked = (question.task, question.reasoning, rule_set)
        if self._known_tasks.get(asked):
            return
        await run.call(  # without parts it only says whether the task is known
            DECIDE,
            DecideRequest(
                task=question.task,
                reasoning=question.reasoning,
                rule_set=rule_set,
                primitives=(),
                explain=False,
            ),
            CHECKS,
        )
        self._known_tasks[asked] = True

    async def _check_gripper(self, run: _Run, request: GraspRequest) -> Gripper:
        name = request.parameters.gripper
        gripper = self._grippers.get(name)
        if gripper is None:
            listed = await run.call(LIST_GRIPPERS, Nothing(), CHECKS)
            grippers = {each.name: each for each in listed.grippers}
            self._grippers.update(grippers)
            if name not in grippers:
                raise UnknownGripper(
                    f"unknown gripper {name!r}; known are {', '.join(sorted(grippers))}",
                    found=name,
                    known=sorted(grippers),
                )
            gripper = grippers[name]
        require_fitting(request.parameters, gripper)
        return gripper

    async def _recover(
        self, run: _Run, request: GraspRequest, scene: PerceiveResponse
    ) -> RecoverResponse:
        parameters = request.parameters
        return await run.call(
            RECOVER,
            RecoverRequest(
                points=scene.object_points,
                viewpoint=parameters.viewpoint,
                plane=scene.plane,
                up=scene.up,
                obstacle_points=scene.obstacle_points,
                method=parameters.method,
                preset=None if parameters.method == "parts" else self._settings.preset,
                parameters=parameters.recovery,
                seed=parameters.seed,
            ),
        )

    async def _decide(
        self,
        run: _Run,
        request: GraspRequest,
        scene: PerceiveResponse,
        recovered: RecoverResponse,
        gripper: Gripper,
    ) -> DecideResponse:
        opening = gripper.max_opening if isinstance(gripper, ParallelGripper) else None
        return await run.call(
            DECIDE,
            DecideRequest(
                task=request.parameters.task,
                reasoning=request.parameters.reasoning,
                rule_set=request.parameters.rule_set or self._settings.rule_set,
                primitives=recovered.primitives,
                joints=recovered.joints,
                plane=scene.plane,
                gripper_opening=opening,
                explain=request.parameters.explain,
            ),
        )

    async def _propose(
        self,
        run: _Run,
        request: GraspRequest,
        scene: PerceiveResponse,
        recovered: RecoverResponse,
        assigned: RegionResponse,
    ) -> ProposeResponse:
        return await run.call(
            PROPOSE,
            ProposeRequest(
                points=scene.object_points,
                obstacle_points=scene.obstacle_points,
                plane=scene.plane,
                up=scene.up,
                viewpoint=request.parameters.viewpoint,
                focus=assigned.point_region,
                superquadrics=superquadric_rows(recovered.primitives),
                gripper=request.parameters.gripper,
                samples=self._settings.samples,
                seed=request.parameters.seed,
                rejected=request.parameters.rejected,
            ),
        )

    async def _choose(
        self,
        run: _Run,
        request: GraspRequest,
        scene: PerceiveResponse,
        recovered: RecoverResponse,
        assigned: RegionResponse,
        proposed: ProposeResponse,
    ) -> Rehearsed:
        """Return the grasps that hold the region, those in doubt rehearsed."""
        parameters = request.parameters
        rehearsing = parameters.rehearsal or self._settings.rehearsal
        some_s = min(self._settings.rehearsal_time_s, remaining_s() / 2)
        until = time.monotonic() + (remaining_s() if rehearsing == "always" else some_s)

        async def select(grasps: Array, at_least: int) -> SelectResponse:
            return await run.call(
                SELECT,
                SelectRequest(
                    points=scene.object_points,
                    point_region=assigned.point_region,
                    grasps=grasps,
                    on_region=proposed.on_focus,
                    keeps_clear=proposed.keeps_clear,
                    max_grasps=max(parameters.max_grasps, at_least),
                    rejected=parameters.rejected,
                    rejected_poses=proposed.rejected_poses,
                    rejected_reasons=proposed.rejected_reasons,
                    seed=parameters.seed,
                ),
            )

        async def attempt(grasp: Array) -> list[ExecuteResponse]:
            asked = rehearsals(
                grasp,
                [each.parameters for each in recovered.primitives],
                points=scene.object_points,
                viewpoint=parameters.viewpoint,
                plane=scene.plane,
                up=scene.up,
                gripper=parameters.gripper,
            )
            with within(until - time.monotonic()):
                return await run.call_all(EXECUTE, asked, REHEARSAL)

        return await rehearse(proposed, select, attempt, rehearsing)
