"""The snippets of docs/grpc.md."""

from __future__ import annotations

import base64
from pathlib import Path

import pytest
from google.protobuf.json_format import Parse

from services.grpc.generated import sparge_pb2 as pb
from tests.docs.fences import blocks
from tests.support.grpc_calls import Through, grpc_port
from tests.support.processes import CHECKOUT
from tests.support.serving import Client

SNIPPETS = {each.language: each.text for each in blocks(CHECKOUT / "docs" / "grpc.md", CHECKOUT)}


def test_the_snippet_finds_where_to_hold_the_bottle(
    backend: Client, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(CHECKOUT)
    with grpc_port(Through(backend)) as port:
        exec(SNIPPETS["python"].replace("50051", str(port)), {})
    printed = capsys.readouterr().out
    assert "wrap_grasp position" in printed
    assert "Hold part 0 for pouring" in printed


def test_the_json_is_a_request(tmp_path: Path) -> None:
    content = base64.b64encode(b"ply").decode()
    asked = Parse(SNIPPETS["json"].replace("cGx5...", content), pb.GraspRequest())
    assert (asked.task, asked.file.name, asked.file.content) == ("pouring", "scan.ply", b"ply")
