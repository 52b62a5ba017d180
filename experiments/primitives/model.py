"""What came of a view: its parts against the labelled regions."""

from __future__ import annotations

from dataclasses import dataclass

from shared.schemas.primitive import Method

METHODS: tuple[Method, ...] = ("parts", "ems")
VERY_GOOD_IOU = 0.85


@dataclass(frozen=True)
class RegionCut:
    """A labelled region and the parts that were found.

    Attributes
    ----------
    task : str
    single, union : float
        Intersection over union of the best part, and of the best set of parts.
    extents : tuple of float, or None
        log(found / true) of the shortest, middle and longest full extent of the best
        part, where it overlaps by `GOOD_IOU` and the true ones are known.
    shape_is_right : bool or None
        Its shape has the right name; None as for extents, or where no name is clear.
    """

    task: str
    single: float
    union: float
    extents: tuple[float, float, float] | None = None
    shape_is_right: bool | None = None


@dataclass(frozen=True)
class Cut:
    """The parts of one view by one method.

    Attributes
    ----------
    source, thing, class_name, view : str
        The set of views, the object, its class, the file.
    method : str
        That was asked for.
    answered : str
        That the answer says was used; empty for an error.
    regions : tuple of RegionCut
        One for each task of the object.
    parts, points : int
        How many were found, and in how many points that perception took for the object.
    assigned : float
        Share of the object's labelled points that are some part's.
    seconds : float or None
        The stage as the gateway measured it; None for an error.
    code : str
        Of the error that was answered instead.
    """

    source: str
    thing: str
    class_name: str
    view: str
    method: Method
    answered: str
    regions: tuple[RegionCut, ...]
    parts: int = 0
    points: int = 0
    assigned: float = 0.0
    seconds: float | None = None
    code: str = ""

    @property
    def worst(self) -> RegionCut:
        """The region whose best part overlaps it least."""
        return min(self.regions, key=lambda region: region.single)

    def records(self) -> list[dict[str, str]]:
        """Return one line of a CSV file for each region."""
        return [
            {
                "source": self.source,
                "object": self.thing,
                "class": self.class_name,
                "view": self.view,
                "method": self.method,
                "answered": self.answered,
                "parts": str(self.parts),
                "points": str(self.points),
                "assigned": f"{self.assigned:.4f}",
                "ms": "" if self.seconds is None else f"{1e3 * self.seconds:.2f}",
                "code": self.code,
                "task": region.task,
                "single_iou": f"{region.single:.6f}",
                "union_iou": f"{region.union:.6f}",
                **{
                    f"log_error_{name}": f"{error:.6f}"
                    for name, error in zip(
                        ("shortest", "middle", "longest"), region.extents or (), strict=False
                    )
                },
                "shape_is_right": ""
                if region.shape_is_right is None
                else str(region.shape_is_right).lower(),
            }
            for region in self.regions
        ]
