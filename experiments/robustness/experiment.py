"""How the region holds out when the view gets worse, and when only the frame changes."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.framework import Context, Experiment, Findings, Share, ShownView
from experiments.framework.asking import VERSIONS, Source, each_view
from experiments.robustness.disturbances import AS_IT_IS
from experiments.robustness.outcomes import Disturbed, Moved, ask_disturbed, ask_moved
from experiments.robustness.tables import bars, disturbances, motions, select


def run(context: Context) -> Findings:
    """Ask about every view as it is, disturbed in every way, and moved as a whole."""

    def disturb(source: Source, view: ShownView) -> list[Disturbed | Moved]:
        rows: list[Disturbed | Moved] = []
        for version in VERSIONS:
            for task in view.tasks:
                rows += ask_disturbed(context, source, view, task, version)
                rows.append(ask_moved(context, source, view, task, version))
        return rows

    outcomes = each_view(
        disturb,
        context.views(),
        workers=context.workers,
        console=context.console,
        describe="disturbing views",
    )
    disturbed = [each for each in outcomes if isinstance(each, Disturbed)]
    moved = [each for each in outcomes if isinstance(each, Moved)]
    return Findings(
        meaning=_meaning(disturbed, moved),
        tables=(disturbances(disturbed), motions(moved)),
        plots=(bars(disturbed),),
        records=[{"condition": each.condition, **each.asked.record()} for each in disturbed],
    )


def _meaning(disturbed: Sequence[Disturbed], moved: Sequence[Moved]) -> str:
    if not disturbed:
        return "There was nothing to disturb. No task of these views is known to the backend."
    source = disturbed[0].asked.source
    good = {
        condition: Share.of(
            each.asked.good
            for version in VERSIONS
            for each in select(disturbed, source, condition, version)
        ).value
        for condition in (AS_IT_IS, "noise x1", "50 % occluded")
    }
    changed, points = sum(each.changed for each in moved), sum(each.points for each in moved)
    still = Share.of(each.changed == 0 for each in moved)
    return (
        f"The right region comes back in {100 * good[AS_IT_IS]:.0f} % of the views called "
        f"{source} as they are, in {100 * good['noise x1']:.0f} % with the noise of a stereo "
        f"camera, and in {100 * good['50 % occluded']:.0f} % with half of the object hidden. "
        f"Moving the whole scene to another frame, which should change nothing, leaves the region "
        f"untouched in {still.text()} of the cases, and changes {100 * changed / points:.2g} % of "
        "the points."
    )


ROBUSTNESS = Experiment(
    "robustness",
    "Regions under disturbances",
    "Does the region stay right when the depth is noisy, thinned out, partly hidden or of another "
    "size, and does it stay exactly the same when only the frame of the input changes?",
    run,
    views_per_object=2,
)
