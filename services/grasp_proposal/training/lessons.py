"""Tried grasps from disk, as the network sees them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.boxes import support_clearance
from services.grasp_proposal.contacts import find_contacts
from services.grasp_proposal.doubt import doubtful
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.learned import inputs
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.scorer import score
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace, build_workspace
from shared.errors import InvalidInput
from shared.geometry.rotation import matrix_from_quaternion
from shared.geometry.se3 import inverse, transform_points
from shared.grippers import load_grippers
from shared.schemas.execution import BELIEVED
from shared.schemas.grasp import ProposeRequest
from shared.schemas.gripper import ParallelGripper
from shared.schemas.scene import SupportPlane
from shared.wire.npz import read_npz

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Arrays = dict[str, NDArray[Any]]

MAX_BYTES = 1 << 28


@dataclass(frozen=True)
class Lessons:
    """G tried grasps.

    Attributes
    ----------
    images : (G, 15, 20, 20) float32 array
    numbers : (G, M) float32 array
    lifted, held : (G,) bool arrays
        What came of them.
    moved : (G,) bool array
        They are not where they were proposed.
    score : (G,) array
        Of the answer, of where they were proposed.
    rehearsed : (G, 2) str array
        What came of them on what the object may look like; empty where that is not known or
        tells nothing.
    geometric : (G,) array
        The score of the named factors.
    view, number : (G,) int arrays
        Which question about which view they belong to; which round of objects.
    object_class : (G,) str array
    """

    images: NDArray[np.float32]
    numbers: NDArray[np.float32]
    lifted: Mask
    held: Mask
    moved: Mask
    score: Array
    rehearsed: NDArray[np.str_]
    geometric: Array
    view: NDArray[np.intp]
    number: NDArray[np.intp]
    object_class: NDArray[np.str_]

    def take(self, chosen: NDArray[np.intp] | Mask) -> Lessons:
        """Return the chosen rows."""
        return Lessons(**{each.name: getattr(self, each.name)[chosen] for each in fields(self)})

    def __len__(self) -> int:
        return len(self.lifted)


def read_lessons(folder: Path) -> Lessons:
    """Return the lessons of every file that `python -m experiments.trials` wrote to a folder.

    Raises
    ------
    InvalidInput
        There is none.
    """
    paths = sorted(folder.glob("*.npz"))
    if not paths:
        raise InvalidInput(f"no trials in {folder}; `python -m experiments.trials` makes them")
    return joined(
        lesson for path in paths for lesson in lessons_of(read_npz(path.read_bytes(), MAX_BYTES))
    )


def joined(lessons: Iterable[Lessons]) -> Lessons:
    """Return several lessons as one; their views stay apart."""
    every, views = [], 0
    for each in lessons:
        every.append(replace(each, view=each.view + views))
        views += int(each.view.max()) + 1 if len(each) else 0
    return Lessons(
        **{
            each.name: np.concatenate([getattr(one, each.name) for one in every])
            for each in fields(Lessons)
        }
    )


def objects_of(lessons: Lessons) -> NDArray[np.str_]:
    """Return the name (G,) of the object of every grasp."""
    names = zip(lessons.object_class, lessons.number, strict=True)
    return np.array([f"{kind}-{number}" for kind, number in names])


def lessons_of(arrays: Arrays) -> list[Lessons]:
    """Return the lessons of each question of one file; grasps that hold nothing are left out."""
    settings = GraspProposalSettings()
    grippers = load_grippers(None)
    found = []
    for question, name in enumerate(arrays["grippers"]):
        gripper = grippers[str(name)]
        assert isinstance(gripper, ParallelGripper)
        mine = arrays["question"] == question
        if not mine.any():  # no grasp of it could be tried
            continue
        lesson = _lessons(arrays, question, mine, Hand.of(gripper, settings))
        if len(lesson):
            found.append(lesson)
    return found


def _lessons(arrays: Arrays, question: int, mine: Mask, hand: Hand) -> Lessons:
    workspace = build_workspace(_request(arrays, question))
    placed = placements(workspace, hand, arrays["grasps"][mine])
    contacts = find_contacts(workspace, hand, placed)
    some = ~contacts.empty & (contacts.width > 0)
    contacts = contacts.take(some)
    tips, palm = support_clearance(contacts.placed, hand, contacts.opening, workspace)
    sight = None
    if workspace.viewpoint is not None:
        sight = SightMap.of(workspace.points, workspace.viewpoint)
    images, numbers = inputs(workspace, hand, contacts, palm, tips, sight)
    rows = int(some.sum())
    scores = arrays["grasps"][mine][some][:, -1]
    told = doubtful(workspace, hand, contacts, scores, sight)
    rehearsed = arrays.get("rehearsed", np.full((len(mine), len(BELIEVED)), ""))
    return Lessons(
        images=images,
        numbers=numbers,
        lifted=arrays["lifted"][mine][some],
        held=arrays["held"][mine][some],
        moved=arrays["moved"][mine][some],
        score=scores,
        rehearsed=np.where(told[:, None], rehearsed[mine][some], ""),
        geometric=score(workspace, hand, contacts, palm, sight),
        view=np.zeros(rows, dtype=np.intp),
        number=np.full(rows, int(arrays["number"])),
        object_class=np.full(rows, str(arrays["object_class"])),
    )


def placements(workspace: Workspace, hand: Hand, grasps: Array) -> Placements:
    """Return answered grasps (G, 9) as hands in the workspace, placed at their tool centres."""
    motion = inverse(workspace.outer_from_work)
    rotation = motion[:3, :3] @ np.array([matrix_from_quaternion(row[3:7]) for row in grasps])
    half = grasps[:, 7] / 2
    return Placements(
        rotation=np.ascontiguousarray(rotation),
        origin=transform_points(motion, grasps[:, :3]),
        tip=np.full(len(grasps), hand.tip_beyond_tcp),
        left=-half,
        right=half,
        front=np.zeros(len(grasps)),
    )


def _request(arrays: Arrays, question: int) -> ProposeRequest:
    x, y, z, offset = map(float, arrays["plane"])
    plane = None
    if np.isfinite(x):
        plane = SupportPlane(normal=(x, y, z), offset=offset, inliers=0, residual_mm=0.0)
    up = tuple(map(float, arrays["up"]))
    focus = arrays["regions"][question]
    return ProposeRequest(
        points=arrays["points"].astype(np.float64),
        plane=plane,
        up=(up[0], up[1], up[2]),
        focus=focus if focus.any() else None,
        superquadrics=arrays["superquadrics"],
    )
