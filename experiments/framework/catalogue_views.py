"""Views of the catalogue's objects and of random ones of the same classes, made when needed."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path

from experiments.camera import StereoNoise
from experiments.catalogue import CATALOGUE
from experiments.dataset import CLEAN, NOISY, DatasetOptions, ViewFile, make_dataset, view_files
from experiments.dataset.choice import chosen_objects
from experiments.dataset.manifest import encode, manifest_of
from experiments.framework.views import ViewSet, things_of

CATALOGUE_SET, VARIANT_SET, NOISY_SUFFIX = "catalogue", "variants", ", noisy"
"""What the sets are called in tables."""

UNSEEN = 1000
"""Added to the seed of variants: whoever develops on the first seeds is judged on others."""


def _silent(_done: int, _total: int) -> None:
    """Show no progress."""


def catalogue_sets(
    folder: Path,
    views: int,
    seed: int,
    *,
    noisy: int = 0,
    variants: int = 0,
    workers: int = 1,
    progress: Callable[[int, int], None] = _silent,
) -> tuple[ViewSet, ...]:
    """Return views, rendered unless `folder` has them.

    Parameters
    ----------
    folder : Path
        Keeps them, apart for other options and other states of the catalogue.
    views : int
        Of each object.
    seed : int
        Of the scenes and the noise; with variants all is drawn from `seed + UNSEEN`.
    noisy : int
        Of each object, so many of the same views also with the noise of a stereo camera.
    variants : int
        Random objects of every class, as sets of their own.
    workers : int
        Processes that render.
    progress : callable
        Called with how many views are done, and of how many.

    Returns
    -------
    tuple of ViewSet
        The catalogue's objects; then, where asked for, the variants, and both with noise.
    """
    options = DatasetOptions(
        views=views,
        seed=seed + UNSEEN if variants else seed,
        variants=variants,
        noise=noisy > 0,
    )
    objects = {thing.name: thing for thing in chosen_objects(options)}
    manifest = manifest_of(options, StereoNoise(), tuple(objects.values()))
    place = folder / hashlib.sha256(encode(manifest)).hexdigest()[:12]
    make_dataset(place, options, workers=workers, progress=progress)
    things = things_of(place)
    sets = []
    for kind, suffix, count in ((CLEAN, "", None), (NOISY, NOISY_SUFFIX, noisy)):
        if count == 0:
            continue
        files = view_files(place / kind)
        every = ViewSet("all", files, things, is_catalogue=True, objects=objects).limited(count)
        for name, chosen in (
            (CATALOGUE_SET, every.only(_in_catalogue)),
            (VARIANT_SET, every.only(lambda file: not _in_catalogue(file))),
        ):
            if chosen.files:
                sets.append(chosen.named(name + suffix))
    return tuple(sets)


def _in_catalogue(file: ViewFile) -> bool:
    return file.object_name in CATALOGUE
