"""The objects, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from experiments.catalogue.bottles import bottle
from experiments.catalogue.cookware import ladle, saucepan, spatula
from experiments.catalogue.cutlery import knife, spoon
from experiments.catalogue.model import CatalogueObject
from experiments.catalogue.tools import hammer, scissors

CATALOGUE: Mapping[str, Callable[[], CatalogueObject]] = MappingProxyType(
    {
        build.__name__: build
        for build in (saucepan, ladle, spatula, hammer, scissors, bottle, spoon, knife)
    }
)


def build(name: str) -> CatalogueObject:
    """Return the object of this name, in its default dimensions.

    Raises
    ------
    ValueError
        No such object; the message lists the known ones.
    """
    if name not in CATALOGUE:
        raise ValueError(f"no object {name!r} in the catalogue; known are {', '.join(CATALOGUE)}")
    return CATALOGUE[name]()
