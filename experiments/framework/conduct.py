"""Running an experiment from its name to its page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from rich.console import Console

from experiments.catalogue.mesh_folder import read_mesh_folder
from experiments.framework.asking import progress_bar
from experiments.framework.catalogue_views import catalogue_sets
from experiments.framework.experiment import Context, Experiment, Findings
from experiments.framework.provenance import provenance
from experiments.framework.report import save
from experiments.framework.views import ViewSet, scan_sets
from shared.client import Sparge

VIEWS = "views"
"""Folder under the results that keeps the catalogue's views."""


def conduct(
    experiment: Experiment, context: Context, results: Path, where: str
) -> tuple[Findings, Path]:
    """Run an experiment and keep what it finds.

    Parameters
    ----------
    experiment : Experiment
    context : Context
    results : Path
        Folder of all experiments.
    where : str
        What is asked, in words.

    Returns
    -------
    findings : Findings
    page : Path
        The report.

    Raises
    ------
    SpargeError
        The backend is down or failed, or there is nothing to ask about.
    """
    run = provenance(context.sparge, where, context.seed)
    context.folder.mkdir(parents=True, exist_ok=True)
    findings = experiment.run(context)
    return findings, save(results, experiment, findings, run)


def view_sets(
    experiment: Experiment,
    results: Path,
    scans: Sequence[Path],
    *,
    catalogue: bool,
    limit: int | None,
    seed: int,
    console: Console,
    workers: int = 1,
    meshes: Path | None = None,
) -> tuple[ViewSet, ...]:
    """Return what the experiment is to be asked about; renders the catalogue's views if need be.

    Parameters
    ----------
    meshes : Path, optional
        Label file of the scans' meshes (docs/catalogue.md), for what needs the true object.

    Raises
    ------
    InvalidInput
        A folder of scans holds no views, or the label file or a mesh cannot be read.
    """
    if experiment.views_per_object is None:
        return ()
    sets = scan_sets(scans)
    if meshes is not None:
        objects = read_mesh_folder(meshes)
        sets = tuple(replace(each, objects=objects) for each in sets)
    if not catalogue:
        return sets
    with progress_bar(console) as progress:
        bar = progress.add_task("rendering views")
        views = limit or experiment.views_per_object
        made = catalogue_sets(
            results / VIEWS,
            views,
            seed,
            noisy=min(experiment.noisy_views, views),
            variants=experiment.variants,
            workers=workers,
            progress=lambda done, total: progress.update(bar, completed=done, total=total),
        )
    return (*made, *sets)


def context_for(
    experiment: Experiment,
    sparge: Sparge,
    console: Console,
    results: Path,
    sets: tuple[ViewSet, ...],
    *,
    limit: int | None,
    seed: int,
    workers: int,
) -> Context:
    """Return what an experiment is given."""
    return Context(
        sparge=sparge,
        console=console,
        folder=results / experiment.name,
        sets=tuple(
            each.limited(limit or experiment.asked_views(each.is_catalogue)) for each in sets
        ),
        limit=limit,
        seed=seed,
        workers=workers,
    )
