"""The four methods of Table A.2, with the thesis's grids of hyper-parameters."""

from __future__ import annotations

import time
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.base import clone
from sklearn.ensemble import RandomForestClassifier
from sklearn.exceptions import ConvergenceWarning
from sklearn.model_selection import GridSearchCV, StratifiedKFold
from sklearn.neural_network import MLPClassifier
from sklearn.pipeline import Pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import SVC

from experiments.shapes.features import features
from experiments.shapes.figures import Figures
from experiments.shapes.heuristic import heuristic_classes

Array = NDArray[np.float64]
Labels = NDArray[np.int64]
Grid = Mapping[str, Sequence[Any]]

FOLDS = 5


class _Steady:
    """Stops at its last iteration without a warning, in any process."""

    def fit(self, x: Array, y: Labels) -> Any:
        """Fit as usual."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ConvergenceWarning)
            return super().fit(x, y)  # type: ignore[misc]  # the classifier's


class SteadyMLP(_Steady, MLPClassifier):  # type: ignore[misc]  # scikit-learn has no types
    """A perceptron that keeps to its number of epochs."""


class SteadySVC(_Steady, SVC):  # type: ignore[misc]  # scikit-learn has no types
    """A support vector machine that keeps to its number of iterations."""


@dataclass(frozen=True)
class Method:
    """A classifier and what its hyper-parameters may be.

    Attributes
    ----------
    name : str
    estimator : scikit-learn classifier
        Untrained.
    grids : tuple of Grid
        The thesis's grid; several where a parameter applies to some choices only.
    thesis_best : mapping
        What the thesis found.
    """

    name: str
    estimator: Any
    grids: tuple[Grid, ...]
    thesis_best: Mapping[str, Any]

    @property
    def candidates(self) -> int:
        return sum(int(np.prod([len(choices) for choices in grid.values()])) for grid in self.grids)


_C, _GAMMA = (1, 10, 100, 1000), tuple(k / 10 for k in range(1, 10))

METHODS: tuple[Method, ...] = (
    Method(
        "random forest",
        RandomForestClassifier(),
        (
            {
                "n_estimators": (200, 500),
                "max_features": ("sqrt", "log2"),
                "max_depth": (4, 5, 6, 7, 8),
                "criterion": ("gini", "entropy"),
            },
        ),
        MappingProxyType(
            {"criterion": "gini", "max_depth": 8, "max_features": "sqrt", "n_estimators": 200}
        ),
    ),
    Method(
        "SVM",
        SteadySVC(max_iter=100_000),
        (
            {"kernel": ("linear",), "C": _C},
            {"kernel": ("poly", "rbf"), "C": _C, "gamma": _GAMMA},
        ),
        MappingProxyType({"C": 1, "gamma": 0.5, "kernel": "rbf"}),
    ),
    Method(
        "MLP",
        SteadyMLP(learning_rate_init=0.01, max_iter=600, n_iter_no_change=30),
        (
            {
                "hidden_layer_sizes": ((50, 50, 50), (50, 100, 50), (100, 100, 100)),
                "learning_rate": ("constant", "adaptive"),
                "activation": ("tanh", "relu"),
                "alpha": (1e-4, 1e-3, 1e-2, 0.1, 1.0),
                "solver": ("sgd", "adam"),
            },
        ),
        MappingProxyType(
            {
                "hidden_layer_sizes": (50, 100, 50),
                "activation": "relu",
                "solver": "sgd",
                "alpha": 1e-4,
                "learning_rate": "adaptive",
            }
        ),
    ),
)
"""Random forest: 'auto', which scikit-learn dropped, was another word for 'sqrt'. SVM: the
thesis prints C as {1, 10, 100, 100}; the last is read as 1000. A polynomial kernel with a
large C would run for minutes where 100,000 iterations take a tenth of a second."""


@dataclass(frozen=True)
class Result:
    """What a method comes to.

    Attributes
    ----------
    method : str
    train, test : Figures
    samples : int
        It learned from; the rules had as many to be tried on.
    best : mapping
        Hyper-parameters that won the grid search; empty for rules.
    validation : float
        Mean accuracy of the winner over the folds; nan for rules.
    seconds : float
        Of the search.
    """

    method: str
    train: Figures
    test: Figures
    samples: int
    best: Mapping[str, Any]
    validation: float
    seconds: float


Split = tuple[Array, Labels]


def by_rules(train: Split, test: Split) -> Result:
    """Return what Eq. A.4 to A.6 come to; they learn nothing."""
    figures = [Figures.of(classes, heuristic_classes(x)) for x, classes in (train, test)]
    return Result("heuristic", figures[0], figures[1], len(train[1]), {}, float("nan"), 0.0)


def searched(
    method: Method,
    train: Split,
    test: Split,
    *,
    seed: int = 0,
    workers: int = 1,
    grid: bool = True,
    folds: int = FOLDS,
) -> Result:
    """Return what a method comes to with the hyper-parameters that do best over the folds.

    Parameters
    ----------
    method : Method
    train, test : tuple
        Superquadrics (N, 5) and their classes (N,). `test` has no part in the choice.
    seed, workers : int
    grid : bool
        False: only what the thesis found, to be quick.
    folds : int
        Of the cross-validation.
    """
    grids = method.grids if grid else ({k: (v,) for k, v in method.thesis_best.items()},)
    search = GridSearchCV(
        _pipeline(method, seed),
        [{f"model__{name}": list(each) for name, each in one.items()} for one in grids],
        cv=StratifiedKFold(folds, shuffle=True, random_state=seed),
        n_jobs=workers if workers > 1 else None,
    )
    start = time.perf_counter()
    search.fit(features(train[0]), train[1])
    seconds = time.perf_counter() - start
    figures = [Figures.of(classes, search.predict(features(x))) for x, classes in (train, test)]
    return Result(
        method.name,
        figures[0],
        figures[1],
        len(train[1]),
        {name.removeprefix("model__"): value for name, value in search.best_params_.items()},
        float(search.best_score_),
        seconds,
    )


def refitted(
    method: Method, best: Mapping[str, Any], train: Split, test: Split, *, seed: int = 0
) -> Result:
    """Return what the winner of a search comes to with other training samples."""
    pipeline = _pipeline(method, seed).set_params(
        **{f"model__{name}": value for name, value in best.items()}
    )
    start = time.perf_counter()
    pipeline.fit(features(train[0]), train[1])
    seconds = time.perf_counter() - start
    figures = [Figures.of(classes, pipeline.predict(features(x))) for x, classes in (train, test)]
    return Result(method.name, figures[0], figures[1], len(train[1]), best, float("nan"), seconds)


def _pipeline(method: Method, seed: int) -> Pipeline:
    estimator = clone(method.estimator)
    if "random_state" in estimator.get_params():
        estimator.set_params(random_state=seed)
    return Pipeline([("scale", StandardScaler()), ("model", estimator)])
