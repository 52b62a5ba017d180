"""The tools as an agent sees them, through the client of the protocol's own SDK."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from contextlib import AbstractContextManager, asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any

import anyio
import numpy as np
import pytest
from mcp import Client as Agent
from mcp.shared.exceptions import MCPError
from mcp_types import CallToolResult, TextResourceContents

from services.mcp.app import create_server
from services.mcp.backend import Backend
from services.mcp.files import Root
from shared.client import Sparge
from shared.errors import StageUnavailable
from shared.geometry.rotation import matrix_from_quaternion
from tests.support.asking import cup
from tests.support.samples import sample_path
from tests.support.serving import Client

Json = dict[str, Any]
Story = Callable[[Agent], Coroutine[Any, Any, None]]


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A folder with a view, and a secret beside it."""
    folder = tmp_path / "views"
    (folder / "kitchen").mkdir(parents=True)
    (folder / "kitchen" / "bottle.npz").write_bytes(sample_path("bottle").read_bytes())
    (tmp_path / "secret.npz").write_bytes(sample_path("hammer").read_bytes())
    return folder


@pytest.fixture
def tell(backend: Client, root: Path) -> Callable[..., None]:
    """Runs a story with an agent that is connected to a server on the shared backend."""

    @contextmanager
    def there() -> Iterator[Sparge]:
        yield Sparge(backend.request)

    def run(story: Story, **options: Any) -> None:
        async def play() -> None:
            server = create_server(Backend(there), Root(root), **options)
            async with Agent(server) as agent:
                await story(agent)

        anyio.run(play)

    return run


async def use(agent: Agent, tool: str, **arguments: Any) -> Json:
    """Return the structured answer of a tool; the test fails on an error."""
    result = await agent.call_tool(tool, arguments)
    assert isinstance(result, CallToolResult)
    assert not result.is_error, result.content
    assert json.loads(result.content[0].text) == result.structured_content  # type: ignore[union-attr]
    assert isinstance(result.structured_content, dict)
    return result.structured_content


async def fail(agent: Agent, tool: str, **arguments: Any) -> tuple[str, str]:
    """Return code and text of the error that a tool answers with."""
    result = await agent.call_tool(tool, arguments)
    assert isinstance(result, CallToolResult)
    assert result.is_error
    text = result.content[0].text  # type: ignore[union-attr]
    if result.structured_content is None:
        return "", text
    error = result.structured_content["error"]
    assert text == f"{error['code']}: {error['message']}"
    return error["code"], text


def test_the_tools_say_what_they_do(tell: Callable[..., None]) -> None:
    async def story(agent: Agent) -> None:
        tools = {each.name: each for each in (await agent.list_tools()).tools}
        assert tools.keys() == {"grasp", "explain", "tasks", "add_task", "remove_task"}
        for name, tool in tools.items():
            changes = name in ("add_task", "remove_task")
            assert tool.annotations is not None
            assert tool.annotations.read_only_hint is not changes
            assert tool.annotations.destructive_hint is (
                True if name == "remove_task" else False if changes else None
            )
            assert tool.output_schema is not None
            assert tool.output_schema["type"] == "object"
        described = tools["grasp"].input_schema["properties"]
        assert all("description" in described[name] for name in ("task", "file", "points"))
        assert "metres" in described["points"]["description"]
        assert "+z approaches" in (tools["grasp"].description or "")

    tell(story)


def test_without_teaching(tell: Callable[..., None]) -> None:
    async def story(agent: Agent) -> None:
        names = {each.name for each in (await agent.list_tools()).tools}
        assert names == {"grasp", "explain", "tasks"}
        assert (await fail(agent, "add_task", name="watering"))[0] == ""

    tell(story, read_only=True)


def test_grasps_are_tried_in_simulation_where_that_is_wanted(tell: Callable[..., None]) -> None:
    async def story(agent: Agent) -> None:
        asked = {"task": "cooking", "file": "sample:saucepan"}
        tried = await use(agent, "grasp", **asked, rehearsal="always")
        assert len(tried["grasps"][0]["rehearsed"]) == 2
        never = await use(agent, "grasp", **asked, rehearsal="never")
        assert not any(each["rehearsed"] for each in never["grasps"])

    tell(story)


def test_a_file_is_grasped_and_explained(tell: Callable[..., None], backend: Client) -> None:
    async def story(agent: Agent) -> None:
        found = await use(agent, "grasp", task="pouring", file="kitchen/bottle.npz")
        full = backend.request(
            "POST",
            "/grasp",
            params={"task": "pouring", "max_grasps": 3},
            content=sample_path("bottle").read_bytes(),
            headers={"Content-Type": "application/x-npz"},
        ).json()
        assert found["found"]
        assert found["nearest_miss"] is None
        assert found["hold"]["parts"] == full["region"]["primitive_ids"]
        assert found["explanation"] == full["explanation"]["text"]
        assert len(found["grasps"]) == len(full["grasps"]) == 3
        for short, long in zip(found["grasps"], full["grasps"], strict=True):
            assert short["position"] == pytest.approx(long["pose"]["position"], abs=6e-5)
            assert short["rehearsed"] == []
            turn = matrix_from_quaternion(np.array(short["quaternion_xyzw"]))
            np.testing.assert_allclose(turn[:, 2], short["approach"], atol=5e-5)
            before = np.array(short["position"]) - 0.1 * np.array(short["approach"])
            np.testing.assert_allclose(before, short["pregrasp_position"], atol=2e-4)
            assert short["width_m"] == pytest.approx(long["width"], abs=6e-5)
        sizes = [1e3 * extent for extent in full["primitives"][0]["full_extents"]]
        assert found["parts"][0]["extents_mm"] == pytest.approx(sizes, abs=0.06)
        why = await use(agent, "explain", request_id=found["request_id"])
        assert why["explanation"] == found["explanation"]
        conditions = [each for rule in why["rules"] for each in rule["conditions"]]
        assert all(each["holds"] for each in conditions)
        assert any(each["margin"] is not None for each in conditions)

    tell(story)


def test_points_and_the_bundled_views(tell: Callable[..., None]) -> None:
    async def story(agent: Agent) -> None:
        found = await use(
            agent,
            "grasp",
            task="handover",
            points=cup(),
            input="object",
            max_grasps=0,
            frame_id="table",
            viewpoint=[0, 0, 0],
        )
        assert found["frame_id"] == "table"
        assert found["parts"]
        listed = await agent.read_resource("sparge://samples")
        names = json.loads(text_of(listed.contents[0]))
        assert "sample:bottle" in names
        found = await use(agent, "grasp", task="pouring", file="sample:bottle", max_grasps=0)
        assert found["found"]
        assert found["reason"]["code"] == "no_grasps_requested"

    tell(story)


def text_of(contents: Any) -> str:
    assert isinstance(contents, TextResourceContents)
    return contents.text


def test_what_does_not_fit_says_what_is_missing(tell: Callable[..., None]) -> None:
    async def story(agent: Agent) -> None:
        found = await use(
            agent, "grasp", task="turning", file="sample:bottle", reasoning="v1", max_grasps=1
        )
        assert not found["found"]
        assert found["hold"] is None
        assert found["grasps"] == []
        assert found["reason"]["code"] == "no_part_matches"
        missed = found["nearest_miss"]
        assert missed["failed"]
        assert not any(each["holds"] for each in missed["failed"])
        why = await use(agent, "explain", request_id=found["request_id"])
        assert why["nearest_miss"]["rule"] == missed["rule"]
        assert len(why["nearest_miss"]["conditions"]) >= len(missed["failed"])

    tell(story)


def test_a_task_is_taught_and_forgotten(tell: Callable[..., None]) -> None:
    async def story(agent: Agent) -> None:
        known = await use(agent, "tasks")
        assert "wrap_grasp" in {each["name"] for each in known["affordances"]}
        pouring = next(each for each in known["tasks"] if each["name"] == "pouring")
        assert not pouring["can_be_removed"]
        added = await use(
            agent, "add_task", name="watering", requires=["contain"], grasp=["wrap_grasp"]
        )
        assert added["can_be_removed"]
        found = await use(agent, "grasp", task="watering", file="sample:bottle", max_grasps=0)
        assert found["found"]
        assert (await fail(agent, "add_task", name="watering", grasp=["grasp"]))[0] == "conflict"
        await use(agent, "remove_task", name="watering")
        code, text = await fail(agent, "grasp", task="watering", file="sample:bottle")
        assert code == "unknown_task"
        assert "pouring" in text

    tell(story)


OUTSIDE = ("../secret.npz", "kitchen/../../secret.npz", "link.npz", "folder/secret.npz")
WRONG = {
    "sample:../../secret": "forbidden",
    "sample:teapot": "not_found",
    "kitchen/teapot.npz": "not_found",
    "kitchen": "unsupported_media_type",
    "kitchen/passwd": "unsupported_media_type",
    "folder.npz": "invalid_input",
    "pipe.npz": "invalid_input",
    "circle.npz": "invalid_input",
    "a\0b.npz": "invalid_input",
    "large.npz": "too_large",
    "empty.npz": "malformed",
}


def test_files_are_read_below_the_root_alone(tell: Callable[..., None], root: Path) -> None:
    (root / "link.npz").symlink_to(root.parent / "secret.npz")
    (root / "folder").symlink_to(root.parent)
    (root / "inside.npz").symlink_to(root / "kitchen" / "bottle.npz")
    (root / "circle.npz").symlink_to(root / "circle.npz")
    (root / "folder.npz").mkdir()
    os.mkfifo(root / "pipe.npz")
    (root / "empty.npz").touch()
    with (root / "large.npz").open("wb") as stream:
        stream.truncate(33 * 2**20)

    async def story(agent: Agent) -> None:
        for name in (*OUTSIDE, str(root.parent / "secret.npz")):
            code, text = await fail(agent, "grasp", task="pouring", file=name)
            assert code == "forbidden", name
            assert "folder" in text
        for name, expected in WRONG.items():
            code, _ = await fail(agent, "grasp", task="pouring", file=name)
            assert code == expected, name
        for name in ("inside.npz", str(root / "kitchen" / "bottle.npz")):
            assert (await use(agent, "grasp", task="pouring", file=name, max_grasps=0))["found"]

    tell(story)


def test_errors_are_the_backends(tell: Callable[..., None]) -> None:
    async def story(agent: Agent) -> None:
        bottle = {"task": "pouring", "file": "sample:bottle"}
        assert (await fail(agent, "grasp", task="pouring"))[0] == "invalid_input"
        assert (await fail(agent, "grasp", **bottle, points=[[0, 0, 1]]))[0] == "invalid_input"
        code, text = await fail(agent, "grasp", **bottle, gripper="tentacle")
        assert code == "unknown_gripper"
        assert "panda" in text
        assert (await fail(agent, "grasp", task="pouring", points=[]))[0] == "empty_cloud"
        assert (await fail(agent, "explain", request_id="nobody"))[0] == "not_found"
        assert (await fail(agent, "remove_task", name="pouring"))[0] == "conflict"
        _, text = await fail(agent, "grasp", task="pouring", points=[[0, 1]])
        assert "points" in text
        _, text = await fail(agent, "grasp", **bottle, max_grasps=21)
        assert "max_grasps" in text

    tell(story)


def test_the_resources(tell: Callable[..., None]) -> None:
    async def story(agent: Agent) -> None:
        listed = {str(each.uri) for each in (await agent.list_resources()).resources}
        assert {"sparge://samples", "sparge://grippers", "sparge://docs/reasons"} <= listed
        page = await agent.read_resource("sparge://docs/reasons")
        assert "no_part_matches" in text_of(page.contents[0])
        grippers = json.loads(text_of((await agent.read_resource("sparge://grippers")).contents[0]))
        assert "panda" in {each["name"] for each in grippers}
        with pytest.raises(MCPError):
            await agent.read_resource("sparge://docs/../../pyproject")

    tell(story)


def test_a_backend_that_is_not_there_is_told(tmp_path: Path) -> None:
    ready = threading.Event()

    @contextmanager
    def slow() -> Iterator[Sparge]:
        ready.wait(20)
        yield Sparge("http://127.0.0.1:9")

    def broken(error: Exception) -> Backend:
        def start() -> AbstractContextManager[Sparge]:
            raise error

        return Backend(start)

    @asynccontextmanager
    async def connected(backend: Backend) -> AsyncIterator[Agent]:
        async with Agent(create_server(backend, Root(tmp_path))) as agent:
            yield agent

    async def play() -> None:
        async with connected(
            broken(StageUnavailable("the stage reasoning is not installed"))
        ) as agent:
            code, text = await fail(agent, "tasks")
            assert (code, "reasoning is not installed" in text) == ("stage_unavailable", True)
        async with connected(broken(ImportError("no module named numba"))) as agent:
            assert "numba" in (await fail(agent, "tasks"))[1]
        async with connected(Backend(slow, patience_s=0.05)) as agent:
            code, text = await fail(agent, "tasks")
            assert (code, "still starting" in text) == ("stage_unavailable", True)
            with pytest.raises(MCPError, match="still starting"):
                await agent.read_resource("sparge://grippers")
            ready.set()

    anyio.run(play)
