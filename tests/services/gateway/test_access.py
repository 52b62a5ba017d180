"""Who is let in: keys, scopes, rates, the loopback; over the real gateway with small stages."""

from __future__ import annotations

import contextlib
import logging
import subprocess
import sys
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from fastapi import FastAPI

from services.gateway.access import Access, needed_scope
from services.gateway.app import create_app
from services.gateway.keys import Scope, add_key
from services.gateway.settings import STAGES, GatewaySettings
from shared.errors import Forbidden, RateLimited
from shared.loopback import is_loopback
from shared.schemas.route import Nothing
from shared.schemas.task import DELETE_TASK, LIST_TASKS, TaskList, TaskName
from shared.service import bind, create_service
from shared.settings import ServiceSettings
from tests.support.gateways import all_elsewhere
from tests.support.serving import Client, in_process, over_socket


def stage(secret: str | None = None) -> FastAPI:
    def forget(asked: TaskName) -> TaskList:
        return TaskList(tasks=())

    def tasks(_: Nothing) -> TaskList:
        return TaskList(tasks=())

    settings = ServiceSettings.model_validate({"stage_secret": secret})
    return create_service(
        "reasoning", "test", settings, [bind(LIST_TASKS, tasks), bind(DELETE_TASK, forget)]
    )


def gateway(stage_secret: str | None = None, **settings: Any) -> FastAPI:
    app = stage(stage_secret)
    transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
    served = create_app(all_elsewhere(**settings), network=lambda: transport)
    alone = served.router.lifespan_context

    @contextlib.asynccontextmanager
    async def lifespan(gateway: FastAPI) -> AsyncIterator[None]:
        async with app.router.lifespan_context(app), alone(gateway):
            yield

    served.router.lifespan_context = lifespan
    return served


@pytest.fixture
def keys(tmp_path: Path) -> Path:
    return tmp_path / "keys.json"


def bearer(key: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {key}"}


def ask(
    client: Client, key: str | None, method: str = "GET", path: str = "/tasks"
) -> tuple[int, str | None]:
    response = client.request(method, path, headers=bearer(key) if key else {})
    error = response.json().get("error", {}) if response.content[:1] == b"{" else {}
    return response.status_code, error.get("code")


@pytest.mark.parametrize("serve", [in_process, over_socket], ids=["in_process", "socket"])
def test_with_keys_every_request_needs_one_that_opens_it(keys: Path, serve: Any) -> None:
    reader = add_key(keys, "reader", (Scope.READ,))
    robot = add_key(keys, "robot", (Scope.GRASP,))
    teacher = add_key(keys, "teacher", (Scope.KNOWLEDGE,))
    root = add_key(keys, "root", (Scope.ADMIN,))
    with serve(gateway(api_keys_file=keys)) as client:
        assert ask(client, None, path="/health/live") == (200, None)
        assert ask(client, None) == (401, "unauthorized")
        assert ask(client, "sparge_wrong") == (401, "unauthorized")
        refused = client.request("GET", "/tasks")
        assert refused.headers["www-authenticate"] == "Bearer"
        assert refused.json()["error"]["request_id"] == refused.headers["x-request-id"]
        assert ask(client, reader) == (200, None)
        assert client.request("GET", "/tasks", headers={"X-API-Key": reader}).status_code == 200
        assert ask(client, robot) == (403, "forbidden")
        assert ask(client, robot, "POST", "/grasp") == (415, "unsupported_media_type")
        assert ask(client, reader, "POST", "/grasp") == (403, "forbidden")
        assert ask(client, reader, "DELETE", "/tasks/pouring") == (403, "forbidden")
        assert ask(client, teacher, "DELETE", "/tasks/pouring") != (403, "forbidden")
        for path in ("/tasks", "/metrics", "/openapi.json", "/nowhere"):
            assert ask(client, None, path=path) == (401, "unauthorized")
            assert ask(client, root, path=path)[0] in (200, 404)


def test_what_nobody_opened_needs_an_admin() -> None:
    assert needed_scope("GET", "/health/ready") is None
    assert needed_scope("GET", "/tasks") is Scope.READ
    assert needed_scope("POST", "/sparql") is Scope.READ
    assert needed_scope("POST", "/execute") is Scope.GRASP
    assert needed_scope("POST", "/knowledge") is Scope.KNOWLEDGE
    assert needed_scope("DELETE", "/rules/x") is Scope.KNOWLEDGE
    assert needed_scope("PUT", "/tasks") is Scope.ADMIN
    assert needed_scope("POST", "/new") is Scope.ADMIN


def test_a_key_has_its_rate(keys: Path) -> None:
    add_key(keys, "other", (Scope.READ,))
    text = add_key(keys, "robot", (Scope.READ,), rate_per_s=2.0)
    now = 0.0
    access = Access(GatewaySettings(api_keys_file=keys, rate_burst=3), lambda: now)
    scope = {"method": "GET", "path": "/tasks", "headers": [(b"x-api-key", text.encode())]}
    for _ in range(3):
        access(scope)
    with pytest.raises(RateLimited) as caught:
        access(scope)
    assert caught.value.details["retry_after_s"] == 1
    now += 0.5  # one more has grown
    access(scope)
    with pytest.raises(RateLimited):
        access(scope)
    now += 100.0  # never more than the burst
    for _ in range(3):
        access(scope)
    with pytest.raises(RateLimited):
        access(scope)


def test_the_rate_is_told_over_http(keys: Path) -> None:
    text = add_key(keys, "robot", (Scope.READ,), rate_per_s=0.01)
    with in_process(gateway(api_keys_file=keys, rate_burst=1)) as client:
        assert ask(client, text) == (200, None)
        refused = client.request("GET", "/tasks", headers=bearer(text))
    assert (refused.status_code, refused.json()["error"]["code"]) == (429, "rate_limited")
    assert 1 <= int(refused.headers["retry-after"]) <= 100


def scope_of(server: tuple[str, int | None], host: str) -> dict[str, Any]:
    return {
        "method": "GET",
        "path": "/tasks",
        "server": server,
        "headers": [(b"host", host.encode())],
    }


def test_without_keys_only_the_loopback_is_answered() -> None:
    access = Access(GatewaySettings())
    access(scope_of(("127.0.0.1", 8000), "localhost:8000"))
    access(scope_of(("::1", 8000), "[::1]:8000"))
    access(scope_of(("/run/sparge.sock", None), "localhost"))
    with pytest.raises(Forbidden, match="no API keys"):
        access(scope_of(("192.0.2.7", 8000), "localhost"))
    with pytest.raises(Forbidden, match="robots-shop"):  # a name that was made to lead here
        access(scope_of(("127.0.0.1", 8000), "robots-shop.example:8000"))
    Access(GatewaySettings(insecure=True))(scope_of(("192.0.2.7", 8000), "sparge.example"))
    assert is_loopback("127.3.2.1")
    assert not is_loopback("0.0.0.0")


def start(*arguments: str, module: str = "services.cli", **environment: str) -> tuple[int, str]:
    code = f"from {module} import main; import sys; sys.argv[1:] = {list(arguments)!r}; main()"
    ended = subprocess.run(
        [sys.executable, "-c", code],
        env={"PATH": "/usr/bin:/bin", "COLUMNS": "300", **environment},
        cwd=Path(__file__).parents[3],
        capture_output=True,
        text=True,
        timeout=60,
    )
    return ended.returncode, ended.stderr


def test_a_gateway_on_another_address_does_not_start_without_keys(tmp_path: Path) -> None:
    status, told = start("serve", "--host", "0.0.0.0", "--port", "0")
    assert status == 1
    assert "sparge key add" in told
    assert "--insecure" in told
    urls = {f"SPARGE_GATEWAY_{name.upper()}_URL": "http://127.0.0.1:9" for name in STAGES}
    for extra in ({}, {"SPARGE_GATEWAY_API_KEYS_FILE": str(tmp_path / "missing.json")}):
        status, told = start(
            "--host", "0.0.0.0", "--port", "0", module="services.gateway.__main__", **urls, **extra
        )
        assert status == 1
        assert "does not start" in told
        assert "Traceback" not in told


def test_pages_of_other_origins_are_let_in_only_when_told() -> None:
    preflight = {"Origin": "https://lab.example", "Access-Control-Request-Method": "POST"}
    with in_process(gateway()) as client:
        closed = client.request("OPTIONS", "/grasp", headers=preflight)
        assert "access-control-allow-origin" not in closed.headers
    with in_process(gateway(cors_origins=("https://lab.example",))) as client:
        opened = client.request("OPTIONS", "/grasp", headers=preflight)
        assert opened.headers["access-control-allow-origin"] == "https://lab.example"
        other = client.request(
            "OPTIONS", "/grasp", headers={**preflight, "Origin": "https://evil.example"}
        )
        assert "access-control-allow-origin" not in other.headers


SECRET = "a secret of sixteen or more"


def test_stages_answer_their_gateway_only() -> None:
    with in_process(stage(SECRET)) as client:
        assert client.request("GET", "/health/ready").status_code == 200
        for headers in ({}, bearer("another secret, as long")):
            refused = client.request("GET", "/tasks", headers=headers)
            assert (refused.status_code, refused.json()["error"]["code"]) == (401, "unauthorized")
        assert client.request("GET", "/tasks", headers=bearer(SECRET)).status_code == 200
    with in_process(gateway(stage_secret=SECRET, SPARGE_STAGE_SECRET=SECRET)) as client:
        assert client.request("GET", "/tasks").status_code == 200


def test_a_wrong_secret_is_a_stage_that_cannot_be_used() -> None:
    with in_process(gateway(stage_secret=SECRET)) as client:
        refused = client.request("GET", "/tasks")
    assert refused.status_code == 503
    error = refused.json()["error"]
    assert error["details"]["stage"] == "reasoning"
    assert "secret" in error["message"]


def test_no_secret_is_logged_or_shown(keys: Path, caplog: pytest.LogCaptureFixture) -> None:
    text = add_key(keys, "root", (Scope.ADMIN,))
    settings = {"api_keys_file": keys, "SPARGE_STAGE_SECRET": SECRET}
    with caplog.at_level(logging.DEBUG), in_process(gateway(SECRET, **settings)) as client:
        shown = [
            client.request("GET", path, headers=bearer(key)).text
            for path in ("/tasks", "/metrics", "/openapi.json", "/nowhere")
            for key in (text, text + "x")
        ]
    everything = caplog.text + "".join(shown) + repr(GatewaySettings.model_validate(settings))
    assert text not in everything
    assert SECRET not in everything


@pytest.fixture(autouse=True)
def _no_settings_of_the_shell(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("SPARGE_STAGE_SECRET", "SPARGE_GATEWAY_API_KEYS_FILE", "SPARGE_GATEWAY_INSECURE"):
        monkeypatch.delenv(name, raising=False)
