"""Name a superquadric's shape: the network of A.1.2, run by ONNX Runtime."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import get_args

import numpy as np
import onnxruntime

from shared.schemas.primitive import ShapeClass
from shared.superquadric import Superquadric

MODEL = Path(__file__).parent / "model" / "shape_classifier.onnx"
CLASSES: tuple[ShapeClass, ...] = get_args(ShapeClass)


class ShapeClassifier:
    """The trained network; see `model/card.md` for its data and figures.

    Parameters
    ----------
    model : Path
        ONNX file: `parameters` (N, 5) in, `probabilities` (N, 3) out, in the order
        of CLASSES.
    """

    def __init__(self, model: Path = MODEL) -> None:
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1
        options.inter_op_num_threads = 1
        options.log_severity_level = 3
        self._session = onnxruntime.InferenceSession(
            str(model), options, providers=["CPUExecutionProvider"]
        )

    def classify(self, superquadrics: Sequence[Superquadric]) -> list[tuple[ShapeClass, float]]:
        """Return shape class and its probability of each superquadric."""
        if not superquadrics:
            return []
        rows = np.array(
            [[*one.exponents, *one.semi_axes] for one in superquadrics], dtype=np.float64
        )
        # Relative to the largest, before the step to single precision: any unit will do.
        rows[:, 2:] /= rows[:, 2:].max(axis=1, keepdims=True)
        (probabilities,) = self._session.run(
            ["probabilities"], {"parameters": rows.astype(np.float32)}
        )
        best = probabilities.argmax(axis=1)
        return [
            (CLASSES[k], min(max(float(row[k]), 0.0), 1.0))
            for k, row in zip(best, probabilities, strict=True)
        ]
