"""Tasks, affordances and grippers that are known -> messages of proto/sparge.proto."""

from __future__ import annotations

from typing import Any

from services.grpc.enums import number
from services.grpc.generated import sparge_pb2 as pb
from services.grpc.geometry import vector
from services.grpc.maybe import maybe
from shared.schemas.gripper import Gripper, GripperList, SuctionGripper
from shared.schemas.task import AffordanceList, Task, TaskList
from shared.schemas.urdf import Urdf


def definition_fields(of: pb.TaskDefinition) -> dict[str, Any]:
    """Return the JSON that teaches a task."""
    return {
        "name": of.name,
        "description": of.description,
        "requires": list(of.requires),
        "grasp": list(of.grasp),
        "avoids": list(of.avoids),
    }


def task(of: Task) -> pb.Task:
    """Return a task."""
    return pb.Task(
        name=of.name,
        description=of.description,
        requires=of.requires,
        grasp=of.grasp,
        avoids=of.avoids,
        reasoning=[number(pb.Reasoning, each) for each in of.reasoning],
        builtin=of.builtin,
    )


def task_list(of: TaskList) -> pb.TaskList:
    """Return all tasks."""
    return pb.TaskList(tasks=map(task, of.tasks))


def affordance_list(of: AffordanceList) -> pb.AffordanceList:
    """Return all affordances."""
    return pb.AffordanceList(
        affordances=[
            pb.Affordance(name=each.name, description=each.description) for each in of.affordances
        ]
    )


def gripper_list(of: GripperList) -> pb.GripperList:
    """Return all grippers."""
    return pb.GripperList(grippers=map(_gripper, of.grippers))


def _gripper(of: Gripper) -> pb.Gripper:
    if isinstance(of, SuctionGripper):
        return pb.Gripper(
            suction=pb.SuctionGripper(
                name=of.name,
                description=of.description,
                cup_diameter=of.cup_diameter,
                cup_length=of.cup_length,
                compliance=of.compliance,
                palm_size=vector(of.palm_size),
                force=of.force,
                urdf=maybe(_urdf, of.urdf),
            )
        )
    return pb.Gripper(
        parallel=pb.ParallelGripper(
            name=of.name,
            description=of.description,
            max_opening=of.max_opening,
            finger_width=of.finger_width,
            finger_thickness=of.finger_thickness,
            finger_length=of.finger_length,
            tip_beyond_tcp=of.tip_beyond_tcp,
            palm_size=vector(of.palm_size),
            force=of.force,
            urdf=maybe(_urdf, of.urdf),
        )
    )


def _urdf(of: Urdf) -> pb.Urdf:
    return pb.Urdf(
        links=[
            pb.Link(name=each.name, xyz=vector(each.xyz), rpy=vector(each.rpy)) for each in of.links
        ],
        joints=of.joints,
        strokes=[
            pb.Stroke(opening=each.opening, positions=each.positions, advance=each.advance)
            for each in of.strokes
        ],
    )
