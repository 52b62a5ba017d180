"""What a simulated execution came to -> a message of proto/sparge.proto."""

from __future__ import annotations

from services.grpc.enums import number
from services.grpc.generated import sparge_pb2 as pb
from shared.schemas.execution import ExecuteResponse

_ROWS = (
    "motion_times",
    "motion_object",
    "motion_hand",
    "motion_opening",
    "motion_joints",
    "motion_base",
)


def execute_response(of: ExecuteResponse) -> pb.ExecuteResponse:
    """Return the answer to POST /execute."""
    return pb.ExecuteResponse(
        success=of.success,
        lifted=of.lifted,
        outcome=number(pb.Outcome, of.outcome),
        message=of.message,
        lift_height=of.lift_height,
        phases=[pb.Phase(name=each.name, simulated_s=each.simulated_s) for each in of.phases],
        animation=None if of.animation is None else of.animation.tobytes(),
        motion_phases=of.motion_phases,
        **{name: getattr(of, name).ravel() for name in _ROWS if getattr(of, name) is not None},
    )
