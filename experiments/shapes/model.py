"""The shipped model: how it is trained, written and asked."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import onnxruntime
from numpy.typing import NDArray
from sklearn.exceptions import ConvergenceWarning
from sklearn.neural_network import MLPClassifier
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler

from experiments.shapes.criterion import names, perceived
from experiments.shapes.dataset import random_superquadrics
from experiments.shapes.features import features, with_features
from shared.settings import PROJECT_ROOT

Array = NDArray[np.float64]
Labels = NDArray[np.int64]

FOLDER = PROJECT_ROOT / "services" / "primitive_recovery" / "model"
FILE = "shape_classifier.onnx"
SAMPLES = 120_000
EPOCHS = 80


def training_set(count: int, rng: np.random.Generator) -> tuple[Array, Labels]:
    """Return superquadrics (count, 5) and the names (count,) that a viewer gives them."""
    parameters = random_superquadrics(count, rng)
    return parameters, names(perceived(parameters, rng))


def trained(parameters: Array, classes: Labels, *, epochs: int = EPOCHS, seed: int = 0) -> Pipeline:
    """Return the fitted network of A.1.2: MLP (50, 100, 50), ReLU, SGD, adaptive rate."""
    network = MLPClassifier(
        hidden_layer_sizes=(50, 100, 50),
        activation="relu",
        solver="sgd",
        alpha=1e-4,
        learning_rate="adaptive",
        learning_rate_init=0.05,
        n_iter_no_change=5,
        max_iter=epochs,
        random_state=seed,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # the number of epochs is fixed
        return make_pipeline(StandardScaler(), network).fit(features(parameters), classes)


def export(model: Pipeline, path: Path) -> None:
    """Write the network as ONNX: `parameters` (N, 5) in, `probabilities` (N, 3) out."""
    from skl2onnx import to_onnx
    from skl2onnx.common.data_types import FloatTensorType

    network = to_onnx(
        model,
        name="shape_classifier",
        initial_types=[("features", FloatTensorType([None, 5]))],
        options={"zipmap": False},
        target_opset={"": 17, "ai.onnx.ml": 3},
    )
    path.write_bytes(with_features(network).SerializeToString())


def probabilities(parameters: Array, path: Path = FOLDER / FILE) -> Array:
    """Return what a written model says (N, 3) of superquadrics (N, 5)."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    session = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
    rows = parameters.copy()
    rows[:, 2:] /= rows[:, 2:].max(axis=1, keepdims=True)
    (found,) = session.run(["probabilities"], {"parameters": rows.astype(np.float32)})
    return np.asarray(found, dtype=np.float64)
