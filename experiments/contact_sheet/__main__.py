"""Draw the catalogue, or variants of a class: `python -m experiments.contact_sheet [options]`.

Without options it writes docs/images/catalogue.png.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import track

from experiments.catalogue import CATALOGUE, CLASSES, CatalogueObject, build, variant
from experiments.contact_sheet.sheet import contact_sheet

PICTURE = Path(__file__).parents[2] / "docs" / "images" / "catalogue.png"


def main() -> None:
    """Write the picture and say where it is."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=PICTURE, help="where to write")
    parser.add_argument("--variants", choices=CLASSES, help="random ones of this class instead")
    parser.add_argument("--count", type=int, default=12, help="how many variants")
    parser.add_argument("--seed", type=int, default=0, help="of the variants")
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    things: list[CatalogueObject] = (
        [variant(arguments.variants, rng) for _ in range(arguments.count)]
        if arguments.variants
        else [build(name) for name in CATALOGUE]
    )
    picture = contact_sheet(track(things, description="drawing", console=Console(stderr=True)))
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_bytes(picture)
    sys.stdout.write(f"{arguments.out}  {len(picture) / 1000:.0f} kB\n")


if __name__ == "__main__":
    main()
