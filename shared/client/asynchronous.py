"""The client for asynchronous code: the same questions, awaited."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterable
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


class AsyncSparge:
    """A backend, as `shared.client.Sparge`: same parameters, same methods, same errors.

    Used in one event loop, best as `async with AsyncSparge(url) as sparge`. Cancelling a method
    ends its request, and with it the work of the backend.

    Parameters
    ----------
    backend : str or callable, optional
        URL, or what sends requests, as `httpx.AsyncClient.request` does.
    api_key, timeout_s, retries
        As for `Sparge`.
    """

    def __init__(
        self,
        backend: str | Callable[..., Awaitable[httpx.Response]] | None = None,
        *,
        api_key: str | None = None,
        timeout_s: float = TIMEOUT_S,
        retries: RetryPolicy | None = None,
    ) -> None:
        self._timeout_s = timeout_s
        self._retries = retries or RetryPolicy()
        self._http: httpx.AsyncClient | None = None
        if callable(backend):
            self._send = backend
        else:
            headers = key_headers(api_key)
            self._http = httpx.AsyncClient(base_url=backend_url(backend), headers=headers)
            self._send = self._http.request

    async def grasp(
        self, view: ViewLike, task: str, **parameters: Unpack[GraspParameters]
    ) -> GraspResult:
        """As `Sparge.grasp`."""
        return await self._ask(questions.grasp(view, task, parameters))

    async def grasp_file(
        self, name: str, data: bytes, task: str, **parameters: Unpack[GraspParameters]
    ) -> GraspResult:
        """As `Sparge.grasp_file`."""
        return await self._ask(questions.grasp_file(name, data, task, parameters))

    async def execute(self, request: ExecuteRequest) -> ExecuteResponse:
        """As `Sparge.execute`."""
        return await self.call(EXECUTE, request)

    async def explanation(self, request_id: str) -> KeptExplanation:
        """As `Sparge.explanation`."""
        return await self._ask(questions.explanation(request_id))

    async def tasks(self) -> tuple[Task, ...]:
        """As `Sparge.tasks`."""
        return (await self.call(LIST_TASKS, Nothing())).tasks

    async def add_task(
        self,
        name: str,
        *,
        description: str = "",
        requires: Iterable[str] = (),
        grasp: Iterable[str] = (),
        avoids: Iterable[str] = (),
    ) -> Task:
        """As `Sparge.add_task`."""
        return await self._ask(questions.add_task(name, description, requires, grasp, avoids))

    async def remove_task(self, name: str) -> Task:
        """As `Sparge.remove_task`."""
        return await self._ask(questions.remove_task(name))

    async def affordances(self) -> tuple[Affordance, ...]:
        """As `Sparge.affordances`."""
        return (await self.call(LIST_AFFORDANCES, Nothing())).affordances

    async def grippers(self) -> tuple[Gripper, ...]:
        """As `Sparge.grippers`."""
        return (await self.call(LIST_GRIPPERS, Nothing())).grippers

    async def version(self) -> Version:
        """As `Sparge.version`."""
        return await self._ask(questions.version())

    async def health(self) -> Health:
        """As `Sparge.health`."""
        return await self._ask(questions.health())

    async def ready(self) -> bool:
        """As `Sparge.ready`."""
        return (await self.health()).status == "ready"

    async def wait_until_ready(self, timeout_s: float = 60.0) -> None:
        """As `Sparge.wait_until_ready`."""
        await self._ask(questions.readiness(), UNTIL_READY, timeout_s)

    async def call(self, route: Route[Request, Response], request: Request) -> Response:
        """As `Sparge.call`."""
        return await self._ask(questions.routed(route, request))

    async def close(self) -> None:
        """Close the connections, if they are this client's own."""
        if self._http is not None:
            await self._http.aclose()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    async def _ask(
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
                async with asyncio.timeout(attempts.left_s()):
                    outcome = answer = await self._send(method, url, **options)
            except (TimeoutError, httpx.RequestError) as error:
                outcome = error
            pause_s = attempts.pause_after(outcome)
            if pause_s is None:
                return attempts.read(answer)
            await asyncio.sleep(pause_s)
