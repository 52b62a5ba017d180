"""Write the bundled sample views: `python -m experiments.samples [--folder FOLDER]`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from experiments.samples.views import FOLDER, SAMPLES, make_view
from shared.wire.npz import write_npz


def main() -> None:
    """Write `<name>.npz` and `<name>.labels.npz` for every sample."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, default=FOLDER, help="where to write")
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    for name, sample in SAMPLES.items():
        for suffix, arrays in zip((".npz", ".labels.npz"), make_view(sample), strict=True):
            path = folder / f"{name}{suffix}"
            path.write_bytes(write_npz(arrays, compress=True))
            sys.stdout.write(f"{path}  {path.stat().st_size / 1000:.0f} kB\n")


if __name__ == "__main__":
    main()
