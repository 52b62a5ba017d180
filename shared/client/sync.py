"""The client for synchronous code."""

from __future__ import annotations

import time
import weakref
from collections.abc import Callable, Iterable
from typing import Self, TypeVar, Unpack

import httpx

from shared.client import question as questions
from shared.client.connection import backend_url, key_headers
from shared.client.parameters import GraspParameters
from shared.client.question import Question
from shared.client.result import GraspResult
from shared.client.retry import TIMEOUT_S, UNTIL_READY, Attempts, RetryPolicy
from shared.client.view import ViewLike
from shared.schemas.answer import KeptExplanation
from shared.schemas.execution import EXECUTE, ExecuteRequest, ExecuteResponse
from shared.schemas.grasp import LIST_GRIPPERS
from shared.schemas.gripper import Gripper
from shared.schemas.route import Nothing, Request, Response, Route
from shared.schemas.task import LIST_AFFORDANCES, LIST_TASKS, Affordance, Task
from shared.service.app import Health, Version

T = TypeVar("T")


class Sparge:
    """A backend.

    Every method raises the errors of `shared.errors`, with `details` and `request_id`, as the
    backend did; `StageUnavailable` where it does not answer or answers nonsense, and
    `DeadlineExceeded` where it does not in time. May be used from several threads.

    Parameters
    ----------
    backend : str or callable, optional
        Its URL; without one that in the environment, `URL_VARIABLE`, or `DEFAULT_URL`. Or what
        sends requests, as `httpx.Client.request` does.
    api_key : str, optional
        For a backend at a URL that wants one; else that of the environment, `API_KEY_VARIABLE`.
    timeout_s : float
        For an answer, with all attempts.
    retries : RetryPolicy
        What is asked again is in `shared.client.retry`.
    """

    def __init__(
        self,
        backend: str | Callable[..., httpx.Response] | None = None,
        *,
        api_key: str | None = None,
        timeout_s: float = TIMEOUT_S,
        retries: RetryPolicy | None = None,
    ) -> None:
        self._timeout_s = timeout_s
        self._retries = retries or RetryPolicy()
        self._close: Callable[[], object] = lambda: None
        if callable(backend):
            self._send = backend
        else:
            http = httpx.Client(base_url=backend_url(backend), headers=key_headers(api_key))
            self._send = http.request
            self._close = weakref.finalize(self, http.close)

    def grasp(
        self, view: ViewLike, task: str, **parameters: Unpack[GraspParameters]
    ) -> GraspResult:
        """Ask where and how to grasp what `view` shows.

        Parameters
        ----------
        view : array, mapping or path
            Points (N, 3) in metres; or a depth image (H, W), with `intrinsics` and `depth_scale`
            beside it; or a mapping of these by name, with `points` or `depth`; or a
            `pathlib.Path` to a file that `grasp_file` takes.
        task : str
            A name from `tasks()`.
        **parameters
            The others of POST /grasp, as in `GraspParameters`.

        Returns
        -------
        GraspResult
            Also where nothing fits the task: `found` is false then, and `reason` says why.
        """
        return self._ask(questions.grasp(view, task, parameters))

    def grasp_file(
        self, name: str, data: bytes, task: str, **parameters: Unpack[GraspParameters]
    ) -> GraspResult:
        """Ask about a `.ply`, `.pcd`, `.xyz`, `.npz` or 16-bit `.png` file.

        A depth image needs `intrinsics` and `depth_scale` among the parameters.
        """
        return self._ask(questions.grasp_file(name, data, task, parameters))

    def execute(self, request: ExecuteRequest) -> ExecuteResponse:
        """Try a grasp in simulation, as in `execute(result.execution())`."""
        return self.call(EXECUTE, request)

    def explanation(self, request_id: str) -> KeptExplanation:
        """Return why an earlier request was answered as it was."""
        return self._ask(questions.explanation(request_id))

    def tasks(self) -> tuple[Task, ...]:
        """Return the tasks that can be asked for."""
        return self.call(LIST_TASKS, Nothing()).tasks

    def add_task(
        self,
        name: str,
        *,
        description: str = "",
        requires: Iterable[str] = (),
        grasp: Iterable[str] = (),
        avoids: Iterable[str] = (),
    ) -> Task:
        """Add a Version 2 task by its relations to affordances; the next request knows it.

        Parameters
        ----------
        name : str
            Lower case, digits and `_`.
        description : str
        requires : iterable of str
            Affordances that the object must have.
        grasp : iterable of str
            Affordances of the part to hold, any of them.
        avoids : iterable of str
            Parts with these are left free.
        """
        return self._ask(questions.add_task(name, description, requires, grasp, avoids))

    def remove_task(self, name: str) -> Task:
        """Forget a task that was added; return it."""
        return self._ask(questions.remove_task(name))

    def affordances(self) -> tuple[Affordance, ...]:
        """Return what parts can afford."""
        return self.call(LIST_AFFORDANCES, Nothing()).affordances

    def grippers(self) -> tuple[Gripper, ...]:
        """Return the grippers that can be asked for."""
        return self.call(LIST_GRIPPERS, Nothing()).grippers

    def version(self) -> Version:
        """Return which build answers."""
        return self._ask(questions.version())

    def health(self) -> Health:
        """Return whether the backend can work, and what it waits for."""
        return self._ask(questions.health())

    def ready(self) -> bool:
        """Return whether the backend can work."""
        return self.health().status == "ready"

    def wait_until_ready(self, timeout_s: float = 60.0) -> None:
        """Return once the backend can work, also if nothing listens there yet.

        Raises
        ------
        StageUnavailable
            It cannot start, or takes longer; says what it waits for.
        """
        self._ask(questions.readiness(), UNTIL_READY, timeout_s)

    def call(self, route: Route[Request, Response], request: Request) -> Response:
        """Ask any other endpoint, as in `call(LIST_RULES, Nothing())`."""
        return self._ask(questions.routed(route, request))

    def close(self) -> None:
        """Close the connections, if they are this client's own."""
        self._close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _ask(
        self,
        question: Question[T],
        policy: RetryPolicy | None = None,
        timeout_s: float | None = None,
    ) -> T:
        attempts = Attempts(question, policy or self._retries, timeout_s or self._timeout_s)
        while True:
            outcome: httpx.Response | Exception
            method, url, options = attempts.request()
            try:
                outcome = answer = self._send(method, url, **options)
            except httpx.RequestError as error:
                outcome = error
            pause_s = attempts.pause_after(outcome)
            if pause_s is None:
                return attempts.read(answer)
            time.sleep(pause_s)


def connect(url: str, timeout_s: float = TIMEOUT_S, api_key: str | None = None) -> Sparge:
    """Return the backend at `url`, to be closed by `with`."""
    return Sparge(url, timeout_s=timeout_s, api_key=api_key)
