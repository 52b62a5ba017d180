"""One page without its browser: what it shows when questions fail, and whose its files are."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import viser

from services.viewer.session import Session
from services.viewer.sources import Sources
from shared.client import Sparge
from tests.support.samples import sample_path
from tests.support.serving import Client, free_ports

WAIT_S = 60.0


@pytest.fixture(scope="module")
def server() -> Iterator[viser.ViserServer]:
    (port,) = free_ports(1)
    running = viser.ViserServer(host="127.0.0.1", port=port, verbose=False)
    yield running
    running.stop()


@pytest.fixture
def session(server: viser.ViserServer, backend: Client, tmp_path: Path) -> Iterator[Session]:
    """A page on the real backend, with its first answer; its scene is the server's own."""
    (tmp_path / "bottle.npz").write_bytes(sample_path("bottle").read_bytes())
    (tmp_path / "broken.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 9\n")
    client: Any = SimpleNamespace(
        gui=server.gui, scene=server.scene, atomic=server.atomic, camera=SimpleNamespace()
    )
    made = Session(client, Sparge(backend.request), Sources(tmp_path))
    until(lambda: "hold part" in told(made))
    yield made
    made.close()
    server.gui.reset()


def told(session: Session) -> str:
    return session.controls._words.content


def said(session: Session) -> str:
    return session.controls._status.content


def choose(session: Session, source: str) -> None:
    control: Any = session.controls._source
    control.value = source


def until(is_so: Callable[[], bool]) -> None:
    ends = time.monotonic() + WAIT_S
    while not is_so():
        assert time.monotonic() < ends, "it did not come to that"
        time.sleep(0.02)


def test_an_answer_goes_when_the_next_question_fails(session: Session) -> None:
    choose(session, "broken.ply")
    until(lambda: "malformed" in said(session))
    until(lambda: told(session) == "")
    assert "/answer" not in session._client.scene._handle_from_node_name
    choose(session, "bottle.npz")
    until(lambda: "hold part" in told(session))


def test_a_file_that_is_opened_is_looked_at_and_replaces_none(session: Session) -> None:
    before = session.controls._source.options
    session._upload("bottle.npz", sample_path("spatula").read_bytes())
    until(lambda: said(session).startswith("bottle.npz (2)"))
    assert session.controls._source.options == (*before, "bottle.npz (2)")
    session._upload("new.ply", b"ply\n")
    until(lambda: "malformed" in said(session))
    assert "new.ply" not in session.controls._source.options


def test_every_grasp_can_be_chosen(session: Session) -> None:
    assert session._known is not None
    assert session._shown is not None
    assert len(session._shown.grasps) == len(session._known.result.grasps) > 5


def test_a_fault_of_ours_is_said(session: Session, caplog: pytest.LogCaptureFixture) -> None:
    def fault() -> None:
        raise ZeroDivisionError

    assert not session._careful(fault)
    assert "internal" in said(session)
