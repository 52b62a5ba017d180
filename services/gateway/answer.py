"""What the stages found -> the contract's answer, as JSON or npz."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from services.gateway.pipeline import Outcome
from services.gateway.request import GraspRequest
from services.gateway.settings import GatewaySettings
from shared.geometry.rotation import matrix_from_quaternion
from shared.schemas import execution
from shared.schemas.answer import (
    Grasp,
    GraspAnswer,
    LabelledPrimitive,
    RejectedGrasp,
    Rejection,
    Scene,
)
from shared.schemas.grasp import Pose
from shared.schemas.primitive import superquadric_rows
from shared.schemas.rejection import WHY_REJECTED
from shared.schemas.task import Reason
from shared.wire import Message
from shared.wire.npz import write_npz


def compose(
    outcome: Outcome,
    request: GraspRequest,
    settings: GatewaySettings,
    request_id: str,
    timings_ms: dict[str, float],
) -> GraspAnswer:
    """Return the JSON answer."""
    parameters, scene, decision = request.parameters, outcome.scene, outcome.decision
    up = np.asarray(scene.up)
    return GraspAnswer(
        request_id=request_id,
        task=parameters.task,
        reasoning=parameters.reasoning,
        rule_set=parameters.rule_set or settings.rule_set,
        gripper=parameters.gripper,
        seed=parameters.seed,
        frame_id=parameters.frame_id,
        found=decision.found,
        reason=_reason(outcome, parameters.max_grasps),
        region=decision.region,
        alternatives=decision.alternatives,
        primitives=tuple(
            LabelledPrimitive(**dict(each), labels=decision.labels.get(each.id, ()))
            for each in outcome.recovered.primitives
        ),
        grasps=_grasps(outcome, up, settings),
        rehearsal=outcome.rehearsed.report if outcome.rehearsed else None,
        rejected=_rejected(outcome),
        explanation=decision.explanation,
        scene=Scene(
            plane=scene.plane,
            up=scene.up,
            object_points=len(scene.object_points),
            clusters=scene.clusters,
            dropped=scene.dropped,
            method=outcome.recovered.method,
            removed_as_overlap=outcome.recovered.removed_as_overlap,
            candidates=outcome.proposed.considered if outcome.proposed else 0,
            rejected=outcome.proposed.rejected if outcome.proposed else {},
        ),
        timings_ms={name: round(spent, 3) for name, spent in timings_ms.items()},
    )


def arrays(answer: GraspAnswer, outcome: Outcome) -> dict[str, NDArray[np.generic]]:
    """Return the contract's arrays: per INPUT point, the primitives, the grasps (G, 9)."""
    scene, assigned = outcome.scene, outcome.assigned
    point_primitive = np.full(scene.input_points, -1, dtype=np.int16)
    point_region = np.zeros(scene.input_points, dtype=np.bool_)
    point_primitive[scene.object_indices] = assigned.point_primitive
    point_region[scene.object_indices] = assigned.point_region
    return {
        "point_primitive": point_primitive,
        "point_region": point_region,
        "primitives": superquadric_rows(answer.primitives),
        "grasps": outcome.grasps,
    }


def to_npz(held: Mapping[str, NDArray[np.generic]], report: Message) -> bytes:
    """Return the contract's npz: its arrays, and the JSON answer as `report`."""
    text = np.frombuffer(report.model_dump_json().encode(), dtype=np.uint8)
    return write_npz({**held, "report": text})


def _grasps(
    outcome: Outcome, up: NDArray[np.float64], settings: GatewaySettings
) -> tuple[Grasp, ...]:
    if outcome.rehearsed is None:
        return ()
    return tuple(
        _grasp(row, came, up, settings)
        for row, came in zip(outcome.grasps, outcome.rehearsed.of_answered, strict=True)
    )


def _grasp(
    row: NDArray[np.float64],
    rehearsed: tuple[execution.Outcome, ...],
    up: NDArray[np.float64],
    settings: GatewaySettings,
) -> Grasp:
    position, quaternion, width, score = row[:3], row[3:7], row[7], row[8]
    approach = matrix_from_quaternion(quaternion)[:, 2]
    before = position - settings.approach_distance * approach
    after = position + settings.retreat_distance * up
    return Grasp(
        pose=_pose(position, quaternion),
        pregrasp=_pose(before, quaternion),
        retreat=_pose(after, quaternion),
        width=float(width),
        score=float(np.clip(score, 0, 1)),
        rehearsed=rehearsed,
    )


def _rejected(outcome: Outcome) -> tuple[RejectedGrasp, ...]:
    """Return the hand poses that were left out, where some were asked for."""
    selected = outcome.selected
    if selected is None or selected.rejected_poses is None:
        return ()
    return tuple(
        RejectedGrasp(
            pose=_pose(row[:3], row[3:7]),
            width=float(row[7]),
            reason=Rejection(code=code, message=WHY_REJECTED[code]),
        )
        for row, code in zip(selected.rejected_poses, selected.rejected_reasons, strict=True)
    )


def _pose(position: NDArray[np.float64], quaternion: NDArray[np.float64]) -> Pose:
    return Pose(position=tuple(position.tolist()), quaternion=tuple(quaternion.tolist()))


def _reason(outcome: Outcome, max_grasps: int) -> Reason | None:
    """Say why the answer is empty; None when it is not."""
    if not outcome.decision.found:
        return outcome.decision.reason
    if len(outcome.grasps):
        return None
    if max_grasps == 0:
        return Reason(code="no_grasps_requested", message="max_grasps is 0: only the region")
    if outcome.proposed is None:
        return Reason(
            code="region_not_visible",
            message="the part to hold is known, but no visible point of the object lies on it",
        )
    rejected = ", ".join(f"{count} {why}" for why, count in outcome.proposed.rejected.items())
    return Reason(
        code="no_grasp_in_region",
        message=f"none of {outcome.proposed.considered} hand poses holds the region"
        + (f"; left out: {rejected}" if rejected else ""),
    )
