"""The search: Optuna's Tree-structured Parzen Estimator, its trials kept in SQLite."""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import optuna
from optuna.trial import TrialState

from experiments.tuning.evaluation import Evaluation, TuningView
from experiments.tuning.space import SPACE, drawn_parameters
from shared.errors import Conflict
from shared.schemas.primitive import EmsParameters

FILE = "study.sqlite3"
"""Name of the database: any Optuna tool opens it."""
RANDOM_TRIALS = 10
"""Before the estimator has something to go by; Optuna's default."""


@dataclass(frozen=True)
class Trial:
    """A set of parameters that was tried, and what it cost."""

    number: int
    parameters: EmsParameters
    cost: float


def study_name(views: Sequence[TuningView], seed: int, published: Sequence[Evaluation]) -> str:
    """Return a name that changes with whatever changes what a trial costs.

    That is the views, what is expected of them, the ranges, the seed, and the
    backend's behaviour, for which the costs of the published parameters stand. So
    costs of different things never meet in one study, and an old study stays
    untouched beside the new one.
    """
    digest = hashlib.sha256(f"{seed} {SPACE}".encode())
    for view in views:
        digest.update(f"{view.thing} {view.number} {view.task}".encode())
        digest.update(np.round(view.points * 1e6).astype("<i8").tobytes())
        for each in view.expected:
            digest.update(np.round([*each.size, *each.position], 6).tobytes())
    for evaluation in published:
        digest.update(f"{evaluation.cost:.9f}".encode())
    return f"ems-{digest.hexdigest()[:12]}"


class Search:
    """A study in a folder, as far as it has come.

    Parameters
    ----------
    study : optuna.Study
    seed : int
        Trial k draws from numbers that depend on the seed and k, so that a study
        that was interrupted goes on as if it had not been.
    """

    def __init__(self, study: optuna.Study, seed: int) -> None:
        self._study = study
        self._seed = seed

    def trials(self) -> tuple[Trial, ...]:
        """Return the finished trials in their order, numbered from 0."""
        finished = self._study.get_trials(deepcopy=False, states=(TrialState.COMPLETE,))
        return tuple(
            Trial(number, EmsParameters.model_validate(each.params), float(each.value or 0.0))
            for number, each in enumerate(finished)
        )

    def step(self, cost: Callable[[EmsParameters], float]) -> Trial:
        """Try one more set of parameters."""
        number = len(self.trials())
        entropy = np.random.SeedSequence([self._seed, number]).generate_state(1)[0]
        self._study.sampler = optuna.samplers.TPESampler(
            n_startup_trials=RANDOM_TRIALS, multivariate=False, seed=int(entropy)
        )
        trial = self._study.ask()
        parameters = drawn_parameters(trial)
        try:
            value = cost(parameters)
        except BaseException:
            self._study.tell(trial, state=TrialState.FAIL)
            raise
        self._study.tell(trial, value)
        return Trial(number, parameters, value)


@contextlib.contextmanager
def opened(folder: Path, name: str, seed: int) -> Iterator[Search]:
    """Open a study in a folder, or begin it.

    Raises
    ------
    Conflict
        Another process is tuning in this folder.
    """
    folder.mkdir(parents=True, exist_ok=True)
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    with (folder / ".lock").open("wb") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Conflict(f"another process is tuning in {folder}") from None
        storage = optuna.storages.RDBStorage(f"sqlite:///{(folder / FILE).resolve()}")
        try:
            study = optuna.create_study(
                storage=storage, study_name=name, direction="minimize", load_if_exists=True
            )
            # What a killed process left behind: nobody else can be at work here.
            for each in study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
                study.tell(each.number, state=TrialState.FAIL)
            yield Search(study, seed)
        finally:
            storage.remove_session()
            storage.engine.dispose()
