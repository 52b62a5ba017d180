"""The stage: object points in, classified primitives out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.classify import ShapeClassifier
from services.primitive_recovery.parts.cutter import Cutter
from services.primitive_recovery.parts.recovery import recover_parts
from services.primitive_recovery.rehearsal import ems_rehearsal, rehearsal
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from services.primitive_recovery.validation import checked_cloud, checked_obstacles
from shared.schemas.primitive import (
    PRESETS,
    Method,
    Primitive,
    RecoverRequest,
    RecoverResponse,
    ShapeClass,
)
from shared.superquadric import Superquadric

if TYPE_CHECKING:
    from services.primitive_recovery.ems.hierarchy import Part


class PrimitiveRecovery:
    """Decompose and classify, by either of two methods.

    `parts` cuts the cloud where the object's parts meet and fits each of them;
    `ems` decomposes by hierarchical EMS and removes overlap (thesis 3.2, 4.1, 4.2).
    Safe to call from several threads at once.

    Parameters
    ----------
    settings : PrimitiveRecoverySettings
    """

    def __init__(self, settings: PrimitiveRecoverySettings) -> None:
        self._settings = settings
        self._classifier = ShapeClassifier()
        self._cutter = Cutter.load()

    def recover(self, request: RecoverRequest) -> RecoverResponse:
        """Return the primitives of an object's points, largest support first.

        Raises
        ------
        EmptyCloud, DegenerateCloud, InvalidInput, WrongUnits, PayloadTooLarge
            See `checked_cloud` and `checked_obstacles`.
        """
        points = checked_cloud(request.points, self._settings.max_points)
        if self._method_of(request) == "parts":
            others = checked_obstacles(request.obstacle_points, self._settings.max_points)
            return recover_parts(request, points, others, self._cutter, self._classifier)
        return self._by_ems(request, points)

    def _method_of(self, request: RecoverRequest) -> Method:
        if request.method is not None:
            return request.method
        asks_for_ems = request.preset is not None or request.parameters is not None
        return "ems" if asks_for_ems else self._settings.method

    def _by_ems(self, request: RecoverRequest, points: NDArray[np.float64]) -> RecoverResponse:
        # What these import (scikit-learn, scipy.stats) takes longer than all else at the start.
        from services.primitive_recovery.ems.hierarchy import decompose
        from services.primitive_recovery.ems.overlap import kept_after_overlap

        parameters = request.parameters or PRESETS[request.preset or self._settings.preset]
        rng = np.random.default_rng(request.seed)
        viewpoint = np.array(request.viewpoint)
        parts = decompose(points, parameters, viewpoint, self._settings.fit_points, rng)
        kept = kept_after_overlap([part.superquadric for part in parts])
        remaining = [parts[index] for index in kept]
        shapes = self._classifier.classify([part.superquadric for part in remaining])
        return RecoverResponse(
            primitives=tuple(
                _primitive(index, part, shape, probability)
                for index, (part, (shape, probability)) in enumerate(
                    zip(remaining, shapes, strict=True)
                )
            ),
            method="ems",
            removed_as_overlap=len(parts) - len(remaining),
        )

    def warm_up(self) -> None:
        """Compile the kernels of `parts`, so that the first request is as fast as the next.

        Those of `ems` as well where that is the method unless a request says otherwise.
        """
        for request in rehearsal():
            self.recover(request)
        if self._settings.method == "ems":
            self.warm_up_ems()

    def warm_up_ems(self) -> None:
        """Compile the kernels of `ems`, and import what only it needs."""
        self.recover(ems_rehearsal())


def _primitive(index: int, part: Part, shape: ShapeClass, probability: float) -> Primitive:
    superquadric: Superquadric = part.superquadric
    return Primitive(
        id=index,
        parameters=tuple(superquadric.to_vector().tolist()),
        shape_class=shape,
        shape_probability=probability,
        full_extents=superquadric.full_extents,
        residual_mm=1e3 * part.residual,
        support=part.support,
    )
