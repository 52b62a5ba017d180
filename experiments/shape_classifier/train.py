"""Train the shape classifier anew: `python -m experiments.shape_classifier.train`.

Writes the network and its card into the primitive recovery service. With
`--outside FILE`, a CSV of e1, e2, a1, a2, a3, class that the training never sees,
the card reports on it as well.
"""

from __future__ import annotations

import argparse
import logging
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from skl2onnx import to_onnx
from skl2onnx.common.data_types import FloatTensorType
from sklearn.neural_network import MLPClassifier
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler

from experiments.shape_classifier.dataset import labelled
from experiments.shape_classifier.features import features, with_features
from experiments.shape_classifier.heuristic import heuristic_classes
from experiments.shape_classifier.report import Row, card
from shared.settings import PROJECT_ROOT

Array = NDArray[np.float64]
Labels = NDArray[np.int64]

MODEL_FOLDER = PROJECT_ROOT / "services" / "primitive_recovery" / "model"
SAMPLES = 8000
SEED = 0

logger = logging.getLogger(__name__)


def train(parameters: Array, classes: Labels) -> Pipeline:
    """Return the fitted network of A.1.2: MLP (50, 100, 50), ReLU, SGD, adaptive rate."""
    network = MLPClassifier(
        hidden_layer_sizes=(50, 100, 50),
        activation="relu",
        solver="sgd",
        alpha=1e-4,
        learning_rate="adaptive",
        learning_rate_init=0.05,
        max_iter=400,
        random_state=SEED,
    )
    return make_pipeline(StandardScaler(), network).fit(features(parameters), classes)


def export(model: Pipeline, path: Path) -> None:
    """Write the network as ONNX: `parameters` (N, 5) in, `probabilities` (N, 3) out."""
    network = to_onnx(
        model,
        name="shape_classifier",
        initial_types=[("features", FloatTensorType([None, 5]))],
        options={"zipmap": False},
        target_opset={"": 17, "ai.onnx.ml": 3},
    )
    path.write_bytes(with_features(network).SerializeToString())


def main(arguments: list[str] | None = None) -> None:
    """Label, train, measure, export."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--outside", type=Path, help="CSV that the card reports on as well")
    parser.add_argument("--output", type=Path, default=MODEL_FOLDER)
    options = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(message)s")

    logger.info("labelling %d random superquadrics", SAMPLES)
    parameters, classes = labelled(SAMPLES, np.random.default_rng(SEED))
    held_out = SAMPLES // 4
    model = train(parameters[held_out:], classes[held_out:])
    sets = {
        "training": (parameters[held_out:], classes[held_out:]),
        "held out": (parameters[:held_out], classes[:held_out]),
    }
    if options.outside is not None:
        table = np.loadtxt(options.outside, delimiter=",", skiprows=1)
        sets["outside"] = (table[:, :5], table[:, 5].astype(np.int64))
    rows = []
    for name, (x, y) in sets.items():
        rows.append(Row("MLP", name, y, model.predict(features(x))))
        rows.append(Row("Eq. A.4-A.6", name, y, heuristic_classes(x)))
    export(model, options.output / "shape_classifier.onnx")
    text = card(rows, np.bincount(classes, minlength=3))
    (options.output / "card.md").write_text(text, encoding="utf-8")
    logger.info("%s", text)


if __name__ == "__main__":
    main()
