"""What a dataset is made of."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from shared.errors import InvalidInput

LIMITS: dict[str, tuple[float, float]] = {
    "views": (1, 100_000),
    "variants": (0, 10_000),
    "seed": (0, 2**63 - 1),
    "correlation_px": (0.0, 20.0),
}


@dataclass(frozen=True)
class DatasetOptions:
    """The same options make the same files, byte for byte.

    Attributes
    ----------
    views : int
        Per object.
    objects : tuple of str
        Names in the catalogue or, with `meshes`, in that file; none: all.
    meshes : Path, optional
        A file of labelled meshes to use instead of the catalogue (docs/dataset.md).
    noise : bool
        Write a second set of the same views through the stereo noise model.
    correlation_px : float
        Radius over which the noise of neighbouring pixels hangs together.
    variants : int
        Random variants of every chosen class, beside the objects themselves.
    seed : int
        Of everything drawn at random.

    Raises
    ------
    InvalidInput
        A number out of its range, or options that contradict each other.
    """

    views: int = 10
    objects: tuple[str, ...] = ()
    meshes: Path | None = None
    noise: bool = False
    correlation_px: float = 0.0
    variants: int = 0
    seed: int = 0

    def __post_init__(self) -> None:
        for name, (low, high) in LIMITS.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise InvalidInput(
                    f"{name} is {value}, allowed are {low} to {high}", field=name, found=value
                )
        if self.meshes is not None and self.variants:
            raise InvalidInput("variants are of catalogue classes; meshes have none")
        if self.correlation_px and not self.noise:
            raise InvalidInput("correlation is of the noise; ask for noise as well")

    def as_json(self) -> dict[str, Any]:
        """Return the options as the manifest holds them."""
        held = asdict(self)
        held["objects"] = sorted(self.objects)
        held["meshes"] = None if self.meshes is None else self.meshes.name
        return held
