"""The gateway's answers -> messages of proto/sparge.proto, field by field."""

from __future__ import annotations

from services.grpc.enums import number
from services.grpc.generated import sparge_pb2 as pb
from services.grpc.geometry import plane, pose, vector
from services.grpc.maybe import maybe
from shared.schemas.answer import (
    Grasp,
    GraspAnswer,
    KeptExplanation,
    LabelledPrimitive,
    RejectedGrasp,
    Scene,
)
from shared.schemas.primitive import Deformation
from shared.schemas.rehearsal import Rehearsal
from shared.schemas.task import Condition, Explanation, Reason, Region, RuleTrace


def grasp_answer(of: GraspAnswer) -> pb.GraspAnswer:
    """Return the answer to POST /grasp, without per-point labels."""
    return pb.GraspAnswer(
        request_id=of.request_id,
        task=of.task,
        reasoning=number(pb.Reasoning, of.reasoning),
        rule_set=number(pb.RuleSet, of.rule_set),
        gripper=of.gripper,
        seed=of.seed,
        frame_id=of.frame_id,
        found=of.found,
        reason=maybe(_reason, of.reason),
        region=maybe(_region, of.region),
        alternatives=map(_region, of.alternatives),
        primitives=map(_primitive, of.primitives),
        grasps=map(_grasp, of.grasps),
        rejected=map(_rejected, of.rejected),
        rehearsal=maybe(_rehearsal, of.rehearsal),
        explanation=maybe(_explanation, of.explanation),
        scene=_scene(of.scene),
        timings_ms=of.timings_ms,
    )


def kept_explanation(of: KeptExplanation) -> pb.KeptExplanation:
    """Return the answer to GET /grasp/{request_id}/explanation."""
    return pb.KeptExplanation(
        request_id=of.request_id,
        task=of.task,
        reasoning=number(pb.Reasoning, of.reasoning),
        rule_set=number(pb.RuleSet, of.rule_set),
        found=of.found,
        reason=maybe(_reason, of.reason),
        region=maybe(_region, of.region),
        alternatives=map(_region, of.alternatives),
        explanation=_explanation(of.explanation),
    )


def _reason(of: Reason) -> pb.Reason:
    return pb.Reason(code=of.code, message=of.message)


def _region(of: Region) -> pb.Region:
    return pb.Region(
        primitive_ids=of.primitive_ids, affordance=of.affordance, confidence=of.confidence
    )


def _primitive(of: LabelledPrimitive) -> pb.Primitive:
    return pb.Primitive(
        id=of.id,
        parameters=of.parameters,
        shape_class=number(pb.ShapeClass, of.shape_class),
        shape_probability=of.shape_probability,
        full_extents=vector(of.full_extents),
        residual_mm=of.residual_mm,
        support=of.support,
        deformation=maybe(_deformation, of.deformation),
        holes=of.holes,
        labels=of.labels,
    )


def _deformation(of: Deformation) -> pb.Deformation:
    return pb.Deformation(taper=of.taper, bend=of.bend)


def _grasp(of: Grasp) -> pb.Grasp:
    return pb.Grasp(
        pose=pose(of.pose),
        pregrasp=pose(of.pregrasp),
        retreat=pose(of.retreat),
        width=of.width,
        score=of.score,
        rehearsed=[number(pb.Outcome, each) for each in of.rehearsed],
    )


def _rehearsal(of: Rehearsal) -> pb.Rehearsal:
    return pb.Rehearsal(tried=of.tried, stopped=of.stopped)


def _rejected(of: RejectedGrasp) -> pb.RejectedGrasp:
    reason = pb.Rejection(code=of.reason.code, message=of.reason.message)
    return pb.RejectedGrasp(pose=pose(of.pose), width=of.width, reason=reason)


def _explanation(of: Explanation) -> pb.Explanation:
    return pb.Explanation(
        text=of.text,
        facts=of.facts,
        rules=map(_trace, of.rules),
        nearest_miss=maybe(_trace, of.nearest_miss),
    )


def _trace(of: RuleTrace) -> pb.RuleTrace:
    return pb.RuleTrace(
        rule=of.rule,
        holds=of.holds,
        bindings=of.bindings,
        conditions=map(_condition, of.conditions),
    )


def _condition(of: Condition) -> pb.Condition:
    return pb.Condition(
        predicate=of.predicate,
        primitive_id=of.primitive_id,
        holds=of.holds,
        measured=of.measured,
        required=of.required,
        margin=of.margin,
        unit=of.unit,
    )


def _scene(of: Scene) -> pb.Scene:
    return pb.Scene(
        plane=maybe(plane, of.plane),
        up=vector(of.up),
        object_points=of.object_points,
        clusters=of.clusters,
        dropped=of.dropped,
        method=number(pb.Method, of.method),
        removed_as_overlap=of.removed_as_overlap,
        candidates=of.candidates,
        rejected=of.rejected,
    )
