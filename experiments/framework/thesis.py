"""The thesis's figures, as data; its name for a table is in each docstring."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from experiments.framework.cells import MeanStd, Share


@dataclass(frozen=True)
class RegionFigures:
    """A line of Table 6.3 or 6.4: one task, one class, one version.

    Attributes
    ----------
    found : Share
        The column True/False.
    accuracy : MeanStd
        As a fraction of 1.
    tpr : MeanStd
        The column TPR, as a fraction of 1; its code computes TP / (TP + FP).
    """

    task: str
    class_name: str
    reasoning: str
    found: Share
    accuracy: MeanStd
    tpr: MeanStd


def _line(
    task: str,
    class_name: str,
    total: int,
    found: tuple[int, int],
    accuracy: tuple[tuple[float, float], tuple[float, float]],
    tpr: tuple[tuple[float, float], tuple[float, float]],
) -> tuple[RegionFigures, RegionFigures]:
    """Return both versions of a line; accuracy and TPR as mean and deviation in percent."""
    v1, v2 = (
        RegionFigures(
            task,
            class_name,
            version,
            Share(found[k], total),
            MeanStd(accuracy[k][0] / 100, accuracy[k][1] / 100, found[k]),
            MeanStd(tpr[k][0] / 100, tpr[k][1] / 100, found[k]),
        )
        for k, version in enumerate(("v1", "v2"))
    )
    return v1, v2


TABLE_6_3: tuple[RegionFigures, ...] = (
    *_line("cooking", "pan", 30, (22, 23), ((95, 3.2), (94, 13)), ((99, 0.4), (89, 23))),
    *_line("hammering", "hammer", 30, (21, 25), ((76, 19), (61, 33)), ((83, 23), (62, 39))),
    *_line("pouring", "bottle", 30, (26, 11), ((80, 11), (87, 11)), ((97, 4.0), (97, 4.1))),
    *_line("scooping", "ladle", 30, (10, 12), ((92, 20), (90, 11)), ((100, 0.0), (95, 8.2))),
    *_line("turning", "spatula", 30, (17, 11), ((83, 20), (93, 14)), ((81, 36), (93, 14))),
    *_line("handover", "spatula", 30, (30, 28), ((33, 23), (75, 28)), ((50, 50), (79, 28))),
    *_line("handover", "bottle", 30, (30, 23), ((86, 18), (65, 33)), ((53, 39), (83, 17))),
)
"""Table 6.3: regions on its 15 objects, 10 views each."""

TABLE_6_3_AVERAGE: Mapping[str, tuple[Share, float, float]] = MappingProxyType(
    {"v1": (Share(164, 210), 0.791, 0.812), "v2": (Share(133, 210), 0.745, 0.860)}
)
"""Its last line as printed: found (the rows add up to 156 for Version 1), accuracy, TPR."""

TABLE_6_4: tuple[RegionFigures, ...] = (
    *_line("cooking", "pan", 10, (6, 9), ((91, 7.3), (90, 9.1)), ((99, 0.4), (64, 36))),
    *_line("hammering", "hammer", 10, (10, 10), ((68.4, 19), (78, 16)), ((81, 17), (82, 15))),
    *_line("turning", "spatula", 10, (7, 7), ((62, 18), (83, 7.8)), ((27, 34), (60, 11))),
)
"""Table 6.4: regions on three objects of the YCB set that its rules were not made for."""

TABLE_6_4_AVERAGE: Mapping[str, tuple[Share, float, float]] = MappingProxyType(
    {"v1": (Share(23, 30), 0.738, 0.690), "v2": (Share(26, 30), 0.837, 0.687)}
)

TABLE_6_5: Mapping[tuple[str, str], Mapping[str, Share]] = MappingProxyType(
    {
        ("cooking", "pan"): {"blind": Share(3, 10), "v1": Share(7, 10), "v2": Share(8, 10)},
        ("handover", "bottle"): {"blind": Share(2, 10), "v1": Share(8, 10), "v2": Share(7, 10)},
        ("pouring", "bottle"): {"blind": Share(8, 10), "v1": Share(7, 10), "v2": Share(9, 10)},
    }
)
"""Table 6.5: the chosen grasp lies in the right region; (task, class) -> method -> share."""

TABLE_6_6: Mapping[str, Mapping[str, MeanStd | float]] = MappingProxyType(
    {
        "superquadrics": {"v1": MeanStd(2.3, 0.8, 60), "v2": MeanStd(2.3, 0.8, 60)},
        "overlap removal": {"v1": MeanStd(4.3, 1.5, 60), "v2": MeanStd(4.3, 1.5, 60)},
        "shape classification": {"v1": MeanStd(1.0, 2e-4, 60), "v2": MeanStd(1.0, 2e-4, 60)},
        "reasoning": {"v1": MeanStd(0.15, 0.01, 60), "v2": MeanStd(0.25, 0.01, 60)},
        "point cloud segmentation": {"v1": MeanStd(1.5, 0.5, 60), "v2": MeanStd(1.5, 0.5, 60)},
        "total": {"v1": 9.3, "v2": 9.4},
    }
)
"""Table 6.6: seconds per stage, without perception and grasp detection."""

FIGURE_6_6_TASKS = (5, 10, 20, 50, 100, 200)
"""Figure 6.6: numbers of tasks. Its curves are not printed as numbers; the text says that the
total time does not grow, so the totals of Table 6.6 stand for all of them."""
