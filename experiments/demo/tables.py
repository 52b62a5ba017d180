"""The trials in tables, beside what the thesis says."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.demo.trials import Trial
from experiments.framework import MeanStd, Share, Table
from experiments.framework.cells import Cell
from experiments.framework.scoring import GOOD_IOU

THESIS = "found, grasped"
"""6.6.2: for handover a region was found flat and upright, and the robot's grasp succeeded.
It gives no number of trials and does not say which version reasoned."""


def summary(trials: Sequence[Trial]) -> Table:
    """Return one line for each pose, task and version."""
    rows: list[tuple[Cell, ...]] = []
    for key in dict.fromkeys((each.pose, each.task, each.version) for each in trials):
        mine = [each for each in trials if (each.pose, each.task, each.version) == key]
        rows.append(
            (
                *key,
                Share.of(each.found for each in mine),
                Share.of(each.good for each in mine),
                Share.of(each.in_region for each in mine),
                Share.of(each.lifted for each in mine),
                Share.of(each.succeeded for each in mine),
                MeanStd.of(
                    (1000 * each.executed.lift_height for each in mine
                     if each.lifted and each.executed is not None),
                    digits=0,
                ),
                THESIS if key[1] == "handover" else None,
            )
        )  # fmt: skip
    return Table(
        "demo",
        "A bottle is picked up for a task",
        (
            "pose",
            "task",
            "reasoning",
            "found",
            f"good (IoU ≥ {GOOD_IOU})",
            "grasp in region",
            "lifted",
            "lifted by the right part",
            "lift height (mm)",
            "thesis, 6.6",
        ),
        tuple(rows),
        "Shares are over all views, found or not, with the 95 % Wilson interval. Lift height: how "
        "far the centre of mass rose, of 300 mm that the hand rises, where the bottle was lifted. "
        "The thesis used a 1 litre bottle and a real TIAGo robot, for handover alone; it reports "
        "success for both poses, without a number of trials or the version of the reasoning.",
    )


def one_by_one(trials: Sequence[Trial]) -> Table:
    """Return one line for each trial."""
    rows: list[tuple[Cell, ...]] = []
    for each in trials:
        executed = each.executed
        rows.append(
            (
                each.pose,
                each.task,
                each.version,
                each.number,
                round(each.yaw_deg),
                each.found,
                each.score.iou if each.score else None,
                each.tried or None,
                each.in_region if each.tried else None,
                each.outcome,
                round(1000 * executed.lift_height) if executed and executed.success else None,
            )
        )
    return Table(
        "trials",
        "Every trial",
        (
            "pose",
            "task",
            "reasoning",
            "view",
            "yaw (deg)",
            "found",
            "IoU",
            "grasp no.",
            "grasp in region",
            "outcome",
            "lift height (mm)",
        ),
        tuple(rows),
        "Grasps are tried best first until the arm finds a way to one; outcome, region and height "
        "are those of the last one tried. Where there was nothing to execute, the outcome names "
        "the reason. requests.csv has the simulation's own words for each.",
    )
