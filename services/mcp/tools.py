"""The tools: where to grasp, why, and which tasks there are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from mcp.server import MCPServer
from mcp_types import ToolAnnotations
from pydantic import Field

from services.mcp import answers, summary
from services.mcp.backend import Backend
from services.mcp.failing import telling
from services.mcp.files import Root
from shared.client import GraspParameters, GraspResult
from shared.errors import InvalidInput
from shared.schemas.rehearsal import Rehearsing

LOOKS = ToolAnnotations(read_only_hint=True, idempotent_hint=True, open_world_hint=False)
ADDS = ToolAnnotations(
    read_only_hint=False, destructive_hint=False, idempotent_hint=False, open_world_hint=False
)
REMOVES = ToolAnnotations(
    read_only_hint=False, destructive_hint=True, idempotent_hint=False, open_world_hint=False
)
MAX_POINTS = 50_000
"""Of a cloud in the arguments of a call; larger ones come as files."""

Point = Annotated[list[float], Field(min_length=3, max_length=3)]
File = Annotated[
    str | None,
    Field(
        description="a depth view or point cloud: path relative to the server's folder (.npz, "
        ".ply, .pcd, .xyz, or a 16-bit .png depth image with `intrinsics` and `depth_scale`), "
        "or a bundled view such as sample:bottle"
    ),
]
Points = Annotated[
    list[Point] | None,
    Field(
        max_length=MAX_POINTS,
        description="instead of a file: [[x, y, z], ...] in metres, in the sensor's frame",
    ),
]
TaskName = Annotated[str, Field(description="what the object is for; a name from the tool `tasks`")]
Seen = Annotated[
    Literal["scene", "object"],
    Field(
        description="scene: the object stands on a table among others; object: all points are it"
    ),
]
Somewhere = Annotated[
    Point | None, Field(description="[x, y, z] in metres: take the object nearest to this point")
]
Sensor = Annotated[Point | None, Field(description="[x, y, z] of the sensor; the origin if absent")]
Matrix = Annotated[
    list[Point] | None, Field(description="3x3 pinhole matrix in pixels, for a depth image")
]
Scale = Annotated[float | None, Field(gt=0, description="metres per unit of a depth image")]
Count = Annotated[int, Field(ge=0, le=20, description="0: only the part to hold and the reasons")]
Rehearsal = Annotated[
    Rehearsing | None,
    Field(
        description="try grasps in simulation before they are answered, in a few tenths of a "
        "second: auto, those in doubt; always; never; the backend's own way if absent"
    ),
]
Names = Annotated[Sequence[str], Field(max_length=32)]


def add_tools(server: MCPServer, backend: Backend, root: Root, *, read_only: bool) -> None:
    """Give `server` its tools; without those that change the knowledge where `read_only`."""

    @server.tool(title="Where to grasp an object for a task", annotations=LOOKS)
    @telling
    def grasp(
        task: TaskName,
        file: File = None,
        points: Points = None,
        input: Seen = "scene",  # noqa: A002  # its name in the HTTP interface
        target: Somewhere = None,
        gripper: Annotated[str, Field(description="a name from sparge://grippers")] = "panda",
        max_grasps: Count = 3,
        reasoning: Annotated[
            Literal["v1", "v2"], Field(description="v1: a rule per task; v2: affordances of parts")
        ] = "v2",
        viewpoint: Sensor = None,
        intrinsics: Matrix = None,
        depth_scale: Scale = None,
        frame_id: Annotated[str, Field(description="name of the view's frame")] = "camera",
        seed: Annotated[int, Field(ge=0, lt=2**32)] = 0,
        rehearsal: Rehearsal = None,
    ) -> answers.GraspAnswer:
        """Find the part of an object to hold for a task, and gripper poses on that part.

        Give one view of the object, as a file or as points. No model of the object is needed.
        Positions are metres, quaternions are [x, y, z, w], all in the frame of the view. A
        pose is that of the tool centre point between the finger tips: +z approaches, +y closes.
        `found` false is an answer: no part is fit for the task, and `nearest_miss` says which
        condition failed by how much. The same question has the same answer.
        """
        given: GraspParameters = {
            "input": input,
            "target": target,
            "gripper": gripper,
            "max_grasps": max_grasps,
            "reasoning": reasoning,
            "frame_id": frame_id,
            "seed": seed,
        }
        if viewpoint is not None:
            given["viewpoint"] = viewpoint
        if intrinsics is not None:
            given["intrinsics"] = intrinsics
        if depth_scale is not None:
            given["depth_scale"] = depth_scale
        if rehearsal is not None:
            given["rehearsal"] = rehearsal
        return summary.grasp(_asked(backend, root, task, file, points, given).answer)

    @server.tool(title="Why that part, or why none", annotations=LOOKS)
    @telling
    def explain(
        request_id: Annotated[str, Field(description="from an answer of the tool `grasp`")],
    ) -> answers.ExplainAnswer:
        """Say why a part was chosen, or why none was.

        The answer holds the rules that were tried, and for each condition what was measured,
        what is required, and the margin between them. The backend remembers the last few
        hundred answers for an hour.
        """
        return summary.explanation(backend.sparge.explanation(request_id))

    @server.tool(title="The tasks that are known", annotations=LOOKS)
    @telling
    def tasks() -> answers.TasksAnswer:
        """List the tasks that `grasp` can be asked for.

        Also the affordances of parts, by which tasks are defined.
        """
        sparge = backend.sparge
        return answers.TasksAnswer(
            tasks=tuple(map(summary.task, sparge.tasks())),
            affordances=tuple(map(summary.affordance, sparge.affordances())),
        )

    if read_only:
        return

    @server.tool(title="Teach a task", annotations=ADDS)
    @telling
    def add_task(
        name: Annotated[str, Field(description="lower case letters, digits and _")],
        description: Annotated[str, Field(max_length=500)] = "",
        requires: Annotated[Names, Field(description="affordances that the object must have")] = (),
        grasp: Annotated[
            Names, Field(description="affordances of the part to hold, any of them")
        ] = (),
        avoids: Annotated[
            Names,
            Field(description="parts with these are left free; without `grasp`, hold any other"),
        ] = (),
    ) -> answers.Task:
        """Teach the backend a task by affordances from the tool `tasks`.

        This changes the knowledge of everybody who uses this backend, and lasts.
        """
        added = backend.sparge.add_task(
            name, description=description, requires=requires, grasp=grasp, avoids=avoids
        )
        return summary.task(added)

    @server.tool(title="Forget a taught task", annotations=REMOVES)
    @telling
    def remove_task(name: str) -> answers.Task:
        """Forget a task that was taught; those that were shipped stay.

        This changes the knowledge of everybody who uses this backend, and lasts.
        """
        return summary.task(backend.sparge.remove_task(name))


def _asked(
    backend: Backend,
    root: Root,
    task: str,
    file: str | None,
    points: list[Point] | None,
    given: GraspParameters,
) -> GraspResult:
    if (file is None) == (points is None):
        found = "neither" if file is None else "both"
        raise InvalidInput(f"give either file or points; found {found}", field="file")
    if file is not None:
        name, content = root.read(file)
        return backend.sparge.grasp_file(name, content, task, **given)
    return backend.sparge.grasp(np.array(points).reshape(-1, 3), task, **given)
