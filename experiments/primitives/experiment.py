"""Whether the recovered parts are the object's parts, how large, and how fast."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.framework import Context, Experiment, Findings, Share, ShownView, ViewSet
from experiments.framework.asking import Source, each_view
from experiments.framework.scoring import GOOD_IOU
from experiments.framework.views import load
from experiments.primitives.class_tables import by_class, by_region, class_table
from experiments.primitives.cut import ask_parts, cut
from experiments.primitives.model import METHODS, Cut
from experiments.primitives.plots import distribution, sizes, times
from experiments.primitives.reference import reference_table, reference_times
from experiments.primitives.sheet import contact_sheet, worst_views
from experiments.primitives.tables import headline, regions_of, size_table, time_table
from experiments.primitives.truth import TruePart, true_part
from shared.errors import InvalidInput
from shared.schemas.primitive import Method

SHOWN: Method = "parts"
"""The method whose worst views are drawn."""


def run(context: Context) -> Findings:
    """Ask for the parts of every view by both methods in turns, one request at a time."""
    sets = context.views()
    if not any(each.files for each in sets):
        raise InvalidInput("there are no views to find parts in")
    known = _Truths(sets)

    def both(source: Source, view: ShownView) -> list[Cut]:
        truths = {task: part for task in view.tasks if (part := known.of(source, task))}
        return [cut(context.sparge, source, view, method, truths) for method in METHODS]

    first = load(next(file for each in sets for file in each.files))
    for method in METHODS:  # the first request of a process is slower
        ask_parts(context.sparge, first, method)
    cuts = each_view(both, sets, workers=1, console=context.console, describe="looking for parts")
    tables = [
        headline(cuts),
        class_table(cuts),
        size_table(cuts),
        time_table(cuts),
        reference_table(reference_times(sets), cuts),
    ]
    tables = [table for table in tables if table.rows]  # sizes of scans are not known
    for each in sets:
        own = [row for row in cuts if row.source == each.name]
        name = each.name.replace(", ", "-").replace(" ", "-").replace("/", "-")
        tables.append(by_class(own, f"by-class-{name}", each.name))
        tables.append(by_region(own, f"by-region-{name}", each.name))
    drawn = [distribution(cuts), sizes(cuts), times(cuts)]
    worst = worst_views(cuts, SHOWN)
    if worst:
        drawn.append(contact_sheet(context, sets, worst))
    return Findings(
        meaning=_meaning(cuts),
        tables=tuple(tables),
        plots=tuple(plot for plot in drawn if plot is not None),
        records=[record for each in cuts for record in each.records()],
    )


class _Truths:
    """The true part of each region, worked out when it is asked for.

    Parameters
    ----------
    sets : sequence of ViewSet
    """

    def __init__(self, sets: Sequence[ViewSet]) -> None:
        self._objects = {each.name: each.objects for each in sets}
        self._known: dict[tuple[str, str], TruePart] = {}

    def of(self, source: Source, task: str) -> TruePart | None:
        """Return it; None where nobody knows the object's parts."""
        name = source.file.object_name
        thing = self._objects[source.set_name].get(name)
        if thing is None:
            return None
        if (name, task) not in self._known:
            self._known[name, task] = true_part(thing, task)
        return self._known[name, task]


def _meaning(cuts: Sequence[Cut]) -> str:
    first = cuts[0].source
    good = {
        method: Share.of(
            region.single >= GOOD_IOU
            for region in regions_of(
                each for each in cuts if (each.source, each.method) == (first, method)
            )
        )
        for method in METHODS
    }
    rows = [row for row in time_table(cuts).rows if row[0] == first]
    times = (
        f" Recovery takes {rows[0][3]:.0f} ms with parts and {rows[0][5]:.0f} ms with ems in the "
        f"median, {rows[0][7]:.1f} times as much."
        if rows
        else ""
    )
    return (
        f"On the views called {first}, one of the parts is the labelled region, or nearly "
        f"(IoU ≥ {GOOD_IOU}), in {good['parts'].text()} of the cases with the method parts, and in "
        f"{good['ems'].text()} with ems, the thesis's method in its published settings.{times}"
    )


PRIMITIVES = Experiment(
    "primitives",
    "Parts",
    "Are the parts that a view is cut into the object's parts, of the right size and name, and "
    "what does it take? Both methods, on the catalogue, on random objects of its classes that "
    "nothing was made for, clean and with the noise of a stereo camera.",
    run,
    views_per_object=3,
    noisy_views=3,
    variants=4,
    scan_views=10,
)
