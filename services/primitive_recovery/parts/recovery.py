"""Method `parts`: cut the object where its parts meet, then complete each part."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.classify import ShapeClassifier
from services.primitive_recovery.fitting import fit_part
from services.primitive_recovery.parts.cutter import Cutter
from services.primitive_recovery.parts.segment import segment
from shared.deadline import check_deadline
from shared.schemas.primitive import Joint, Primitive, RecoverRequest, RecoverResponse

Array = NDArray[np.float64]


def recover_parts(
    request: RecoverRequest,
    points: Array,
    others: Array | None,
    cutter: Cutter,
    classifier: ShapeClassifier,
) -> RecoverResponse:
    """Return a classified superquadric of every part, largest part first.

    Parameters
    ----------
    request : RecoverRequest
        Viewpoint, support plane and seed.
    points : (N, 3) array
        Its points, checked; metres.
    others : (M, 3) array or None
        Its obstacles, checked; metres.
    cutter : Cutter
        Where to cut.
    classifier : ShapeClassifier
        What to call the shapes.
    """
    rng = np.random.default_rng(request.seed)
    viewpoint = np.array(request.viewpoint)
    up = None if request.up is None else np.array(request.up)
    found = segment(points, viewpoint, request.plane, cutter, others)
    members = [found.labels == part for part in range(len(found.holes))]
    fits = []
    for own in members:
        check_deadline()
        others = np.concatenate([points[~own], found.front])
        fits.append(
            fit_part(
                points[own], viewpoint=viewpoint, plane=request.plane, up=up, others=others, rng=rng
            )
        )
    shapes = classifier.classify([fit.superquadric for fit in fits])
    primitives = tuple(
        Primitive(
            id=index,
            parameters=tuple(fit.superquadric.to_vector().tolist()),
            shape_class=shape,
            shape_probability=probability,
            full_extents=fit.superquadric.full_extents,
            residual_mm=1e3 * fit.residual,
            support=int(own.sum()),
            deformation=fit.deformation,
            holes=holes,
        )
        for index, (fit, own, (shape, probability), holes) in enumerate(
            zip(fits, members, shapes, found.holes, strict=True)
        )
    )
    return RecoverResponse(
        primitives=primitives,
        method="parts",
        removed_as_overlap=0,
        point_primitive=found.labels,
        joints=tuple(
            Joint(primitive_ids=each.parts, position=_triple(each.position))
            for each in found.joints
        ),
        covariances=np.stack([fit.covariance for fit in fits]),
    )


def _triple(vector: Array) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
