"""The parts of a view: as they are, one of them cut in two, or recovered."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from experiments.dataset.view import DEPTH_SCALE
from services.perception.perceive import Perception
from services.perception.settings import PerceptionSettings
from services.primitive_recovery.classify import ShapeClassifier
from services.primitive_recovery.fitting import fit_part
from services.primitive_recovery.parts.borders import joints_of
from services.primitive_recovery.parts.openings import count_holes
from services.primitive_recovery.parts.view import part_view
from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from shared.errors import SpargeError
from shared.geometry.points import points_from_depth
from shared.schemas.primitive import Joint, Primitive, RecoverRequest
from shared.schemas.scene import PerceiveRequest, PerceiveResponse, SupportPlane
from tests.bench.rules.views import PartView

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

LEAST_POINTS = 30
"""A true part of which less is seen is no part of its own."""
CUTS = ("true", "halved", "recovered")


@dataclass(frozen=True)
class Parts:
    """The parts of one view, and the truth about it.

    Attributes
    ----------
    name, class_name : str
    cut : str
        One of `CUTS`.
    primitives, joints, plane
        What reasoning is asked with.
    owner : (N,) int16 array
        Part of each labelled point of the object, -1 for none.
    regions : dict
        Which of these points each task's region has.
    not_afforded : tuple of str
    """

    name: str
    class_name: str
    cut: str
    primitives: tuple[Primitive, ...]
    joints: tuple[Joint, ...]
    plane: SupportPlane | None
    owner: NDArray[np.int16]
    regions: dict[str, Mask]
    not_afforded: tuple[str, ...]


class Workshop:
    """Makes the parts of views; the stages are those of the services."""

    def __init__(self) -> None:
        self._perception = Perception(PerceptionSettings())
        self._recovery = PrimitiveRecovery(PrimitiveRecoverySettings())
        self._classifier = ShapeClassifier()

    def parts_of(self, seen: PartView, rng: np.random.Generator) -> list[Parts]:
        """Return the parts of a view in every cut; none where perception finds no object."""
        view = seen.view
        try:
            scene = self._perception.perceive(
                PerceiveRequest(
                    depth=view.depth, intrinsics=view.intrinsics, depth_scale=DEPTH_SCALE
                )
            )
        except SpargeError:
            return []
        on_object = view.on_object.ravel()
        regions = {
            task: view.region(task).ravel()[on_object]
            for task in view.tasks
            if view.region(task).any()
        }
        points = points_from_depth(view.depth, view.intrinsics, DEPTH_SCALE)[on_object]
        labels = _merged(points, seen.part.ravel()[on_object])

        def made(
            cut: str,
            primitives: tuple[Primitive, ...],
            joints: tuple[Joint, ...],
            owner: NDArray[np.int16],
        ) -> Parts:
            return Parts(
                view.object_name,
                seen.thing.class_name,
                cut,
                primitives,
                joints,
                scene.plane,
                owner,
                regions,
                seen.thing.not_afforded,
            )

        halves = _halved(points, labels, rng)
        return [
            made("true", *self._fitted(points, labels, scene), labels),
            made("halved", *self._fitted(points, halves, scene), halves),
            made("recovered", *self._recovered(scene, on_object)),
        ]

    def _fitted(
        self, points: Array, labels: NDArray[np.int16], scene: PerceiveResponse
    ) -> tuple[tuple[Primitive, ...], tuple[Joint, ...]]:
        viewpoint, rng = np.zeros(3), np.random.default_rng(0)
        picture = part_view(points, viewpoint, scene.plane).picture
        count = int(labels.max()) + 1
        fits = [
            fit_part(
                points[labels == part],
                viewpoint=viewpoint,
                plane=scene.plane,
                up=np.array(scene.up),
                others=points[labels != part],
                rng=rng,
            )
            for part in range(count)
        ]
        shapes = self._classifier.classify([fit.superquadric for fit in fits])
        primitives = tuple(
            Primitive(
                id=index,
                parameters=tuple(fit.superquadric.to_vector().tolist()),
                shape_class=shape,
                shape_probability=probability,
                full_extents=fit.superquadric.full_extents,
                residual_mm=1e3 * fit.residual,
                support=int((labels == index).sum()),
                holes=holes,
            )
            for index, (fit, (shape, probability), holes) in enumerate(
                zip(fits, shapes, count_holes(picture, labels), strict=True)
            )
        )
        joints = tuple(
            Joint(primitive_ids=each.parts, position=tuple(each.position.tolist()))
            for each in joints_of(points, picture, labels)
        )
        return primitives, joints

    def _recovered(
        self, scene: PerceiveResponse, on_object: Mask
    ) -> tuple[tuple[Primitive, ...], tuple[Joint, ...], NDArray[np.int16]]:
        answer = self._recovery.recover(
            RecoverRequest(points=scene.object_points, plane=scene.plane, up=scene.up)
        )
        owner = np.full(len(on_object), -1, dtype=np.int16)
        assert answer.point_primitive is not None
        owner[scene.object_indices] = answer.point_primitive
        return answer.primitives, answer.joints, owner[on_object]


def _merged(points: Array, labels: NDArray[np.int16]) -> NDArray[np.int16]:
    """Return labels from 0, those of few points given to the nearest other part."""
    names, counts = np.unique(labels, return_counts=True)
    kept = names[counts >= LEAST_POINTS]
    if not len(kept):
        return np.zeros(len(labels), dtype=np.int16)
    centres = np.stack([points[labels == name].mean(axis=0) for name in kept])
    nearest = kept[np.linalg.norm(points[:, None] - centres, axis=2).argmin(axis=1)]
    whole = np.where(np.isin(labels, kept), labels, nearest)
    return np.searchsorted(kept, whole).astype(np.int16)


def _halved(
    points: Array, labels: NDArray[np.int16], rng: np.random.Generator
) -> NDArray[np.int16]:
    """Return the labels where a random part is cut in the middle of its longest axis."""
    part = int(rng.integers(int(labels.max()) + 1))
    own = np.flatnonzero(labels == part)
    apart = points[own] - points[own].mean(axis=0)
    axis = np.linalg.svd(apart, full_matrices=False)[2][0]
    along = apart @ axis
    upper = along > (along.min() + along.max()) / 2
    halves = labels.copy()
    if min(upper.sum(), (~upper).sum()) >= LEAST_POINTS:
        halves[own[upper]] = labels.max() + 1
    return halves
