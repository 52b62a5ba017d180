"""The plots of the experiment on parts."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.framework import Plot
from experiments.framework.plots import OTHER, V1, cumulative, iou_frame, new_figure, tidy
from experiments.framework.scoring import GOOD_IOU
from experiments.primitives.model import METHODS, Cut
from experiments.primitives.tables import regions_of

COLOURS = {"parts": OTHER, "ems": V1}
_LINES = ("-", "--", ":", "-.")


def distribution(cuts: Sequence[Cut]) -> Plot:
    """Draw which share of the regions a single part reaches an IoU of."""
    figure = new_figure(9.0, 4.2)
    axes = figure.subplots()
    for line, source in zip(_LINES, _sources(cuts), strict=False):
        for method in METHODS:
            regions = regions_of(_own(cuts, source, method))
            cumulative(
                axes,
                [each.single for each in regions],
                len(regions),
                color=COLOURS[method],
                linestyle=line,
                label=f"{source}, {method}",
            )
    iou_frame(axes, GOOD_IOU, "regions")
    return Plot(
        "iou",
        "How well the best single part is the labelled region: the share of all regions that "
        f"reach an IoU, in the first four sets of views. The line marks {GOOD_IOU}.",
        figure,
    )


def sizes(cuts: Sequence[Cut]) -> Plot | None:
    """Draw the errors of the three extents; None where the truth is not known."""
    figure = new_figure(9.0, 3.6)
    panels = figure.subplots(1, 3, sharey=True)
    sources = [
        source for source in _sources(cuts) if any(_errors(cuts, source, m) for m in METHODS)
    ]
    if not sources:
        return None
    labels = [f"{source}\n{method}" for source in sources for method in METHODS]
    held = [_errors(cuts, source, method) for source in sources for method in METHODS]
    for index, (axes, name) in enumerate(
        zip(panels, ("shortest", "middle", "longest"), strict=True)
    ):
        values = [[error[index] for error in errors] for errors in held]
        axes.boxplot(values, orientation="horizontal", showfliers=False, widths=0.6)
        axes.set_yticks(range(1, len(labels) + 1), labels, fontsize=8)
        axes.axvline(0, color="black", lw=0.8)
        axes.set_title(name, fontsize=10)
        axes.set_xlabel("log(found / true)")
        tidy(axes)
    panels[0].invert_yaxis()
    return Plot(
        "sizes",
        "Full extents of parts against the smallest box around the true part: quartiles, whiskers "
        "to 1.5 times their distance. 0.1 is 10 % too large.",
        figure,
    )


def times(cuts: Sequence[Cut]) -> Plot:
    """Draw the time of every view against its number of points."""
    figure = new_figure(9.0, 3.8)
    axes = figure.subplots()
    for method in METHODS:
        own = [each for each in cuts if each.method == method and each.seconds is not None]
        axes.scatter(
            [each.points for each in own],
            [1e3 * (each.seconds or 0.0) for each in own],
            s=9,
            alpha=0.5,
            color=COLOURS[method],
            label=method,
        )
    axes.set(xscale="log", yscale="log", xlabel="points of the object", ylabel="ms")
    axes.legend(fontsize=9)
    tidy(axes)
    return Plot("times", "Time of the recovery stage against the size of its input.", figure)


def _sources(cuts: Sequence[Cut]) -> list[str]:
    return list(dict.fromkeys(each.source for each in cuts))


def _own(cuts: Sequence[Cut], source: str, method: str) -> list[Cut]:
    return [each for each in cuts if (each.source, each.method) == (source, method)]


def _errors(cuts: Sequence[Cut], source: str, method: str) -> list[tuple[float, float, float]]:
    regions = regions_of(_own(cuts, source, method))
    return [each.extents for each in regions if each.extents is not None]
