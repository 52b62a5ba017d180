"""Answers of the backend -> answers of the tools."""

from __future__ import annotations

import numpy as np

from services.mcp import answers
from shared.geometry.rotation import matrix_from_quaternion
from shared.schemas import answer as full
from shared.schemas import task as knowledge

_TENTH_OF_A_MM = 4
_OF_A_DIRECTION = 5
_OF_A_SHARE = 3


def grasp(of: full.GraspAnswer) -> answers.GraspAnswer:
    """Return the answer to the tool `grasp`; lengths are rounded to a tenth of a millimetre."""
    said = of.explanation
    return answers.GraspAnswer(
        request_id=of.request_id,
        task=of.task,
        found=of.found,
        reason=_reason(of.reason),
        hold=_held(of.region),
        frame_id=of.frame_id,
        gripper=of.gripper,
        parts=tuple(map(_part, of.primitives)),
        grasps=tuple(map(_pose, of.grasps)),
        explanation=said.text if said else "",
        nearest_miss=_miss(said.nearest_miss) if said and said.nearest_miss else None,
    )


def explanation(of: full.KeptExplanation) -> answers.ExplainAnswer:
    """Return the answer to the tool `explain`."""
    missed = of.explanation.nearest_miss
    return answers.ExplainAnswer(
        request_id=of.request_id,
        task=of.task,
        found=of.found,
        reason=_reason(of.reason),
        hold=_held(of.region),
        alternatives=tuple(held for each in of.alternatives if (held := _held(each))),
        explanation=of.explanation.text,
        rules=tuple(map(_tried, of.explanation.rules)),
        nearest_miss=_tried(missed) if missed else None,
    )


def task(of: knowledge.Task) -> answers.Task:
    """Return a task."""
    return answers.Task(
        name=of.name,
        description=of.description,
        requires=of.requires,
        grasp=of.grasp,
        avoids=of.avoids,
        reasoning=of.reasoning,
        can_be_removed=not of.builtin,
    )


def affordance(of: knowledge.Affordance) -> answers.Affordance:
    """Return an affordance."""
    return answers.Affordance(name=of.name, description=of.description)


def _reason(of: knowledge.Reason | None) -> answers.Reason | None:
    return answers.Reason(code=of.code, message=of.message) if of else None


def _held(of: knowledge.Region | None) -> answers.Held | None:
    if of is None:
        return None
    confidence = round(of.confidence, _OF_A_SHARE)
    return answers.Held(parts=of.primitive_ids, affordance=of.affordance, confidence=confidence)


def _part(of: full.LabelledPrimitive) -> answers.Part:
    x, y, z = (round(1e3 * extent, 1) for extent in of.full_extents)
    return answers.Part(id=of.id, shape=of.shape_class, extents_mm=(x, y, z), affordances=of.labels)


def _pose(of: full.Grasp) -> answers.GraspPose:
    x, y, z, w = (round(value, _OF_A_DIRECTION) for value in of.pose.quaternion)
    approach = matrix_from_quaternion(np.array(of.pose.quaternion))[:, 2]
    return answers.GraspPose(
        position=_rounded(of.pose.position, _TENTH_OF_A_MM),
        quaternion_xyzw=(x, y, z, w),
        approach=_rounded(tuple(approach.tolist()), _OF_A_DIRECTION),
        pregrasp_position=_rounded(of.pregrasp.position, _TENTH_OF_A_MM),
        retreat_position=_rounded(of.retreat.position, _TENTH_OF_A_MM),
        width_m=round(of.width, _TENTH_OF_A_MM),
        score=round(of.score, _OF_A_SHARE),
        rehearsed=of.rehearsed,
    )


def _rounded(vector: tuple[float, ...], digits: int) -> tuple[float, float, float]:
    x, y, z = (round(value, digits) for value in vector)
    return x, y, z


def _miss(of: knowledge.RuleTrace) -> answers.Miss:
    failed = tuple(_condition(each) for each in of.conditions if not each.holds)
    return answers.Miss(rule=of.rule, failed=failed)


def _tried(of: knowledge.RuleTrace) -> answers.RuleTried:
    return answers.RuleTried(
        rule=of.rule,
        holds=of.holds,
        parts=of.bindings,
        conditions=tuple(map(_condition, of.conditions)),
    )


def _condition(of: knowledge.Condition) -> answers.Condition:
    return answers.Condition(
        condition=of.predicate,
        part=of.primitive_id,
        holds=of.holds,
        measured=of.measured,
        required=of.required,
        margin=of.margin,
        unit=of.unit,
    )
