"""Experiment 2 of the thesis: whether the region predicted for a task is the right one."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.framework import Asked, Context, Experiment, Findings, Share, ShownView, ask
from experiments.framework.asking import VERSIONS, Source, each_view
from experiments.framework.gallery import draw_examples
from experiments.regions.plots import bars, distribution
from experiments.regions.tables import by_object, by_task, headline


def run(context: Context) -> Findings:
    """Ask for every task of every view, and for tasks that its object does not afford."""

    def both_versions(source: Source, view: ShownView) -> list[Asked]:
        refused = source.thing.refused_tasks(view.tasks)
        return [
            ask(
                context.sparge,
                source,
                view,
                task,
                version,
                max_grasps=1 if task in view.tasks else 0,
                explain=False,
            )[0]
            for version in VERSIONS
            for task in (*view.tasks, *refused)
        ]

    sets = context.views()
    asked = each_view(
        both_versions,
        sets,
        workers=context.workers,
        console=context.console,
        describe="asking for regions",
    )
    asked = [each for each in asked if each.known]
    tables = [headline(asked)]
    for each in sets:
        own = [row for row in asked if row.source == each.name and row.afforded]
        name = each.name.replace(", ", "-").replace(" ", "-").replace("/", "-")
        tables.append(by_task(own, f"by-task-{name}", each.name))
        tables.append(by_object(own, f"by-object-{name}", each.name))
    plots = [
        *(bars(asked, each.name, index) for index, each in enumerate(sets)),
        distribution(asked),
        *draw_examples(context, sets[0], asked),
    ]
    return Findings(
        meaning=_meaning(asked),
        tables=tuple(tables),
        plots=tuple(plots),
        records=[each.record() for each in asked],
    )


def _meaning(asked: Sequence[Asked]) -> str:
    own = [each for each in asked if each.afforded]
    first = own[0].source
    good = {
        version: Share.of(
            each.good for each in own if (each.source, each.reasoning) == (first, version)
        )
        for version in VERSIONS
    }
    wrong = [each for each in own if each.source == first and not each.good]
    missed = Share.of(not each.found for each in wrong)
    return (
        f"On the views called {first}, the right region comes back in {_percent(good['v1'])} of "
        f"the views with Version 1 and in {_percent(good['v2'])} with Version 2. Of the answers "
        f"that are not good, {_percent(missed)} name no part at all; the others hold another "
        "part, or not enough of the right one."
    )


def _percent(share: Share) -> str:
    return "none" if not share.total else f"{100 * share.value:.0f} %"


REGIONS = Experiment(
    "regions",
    "Grasp regions",
    "Does the backend find the part of the object that is right for the task, and all of it? "
    "Asked for every view, every task of its object, and both versions of the reasoning.",
    run,
    thesis="experiment 2, Tables 6.3 and 6.4",
    noisy_views=5,
)
