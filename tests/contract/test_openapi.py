"""The public surface changes on purpose only: every OpenAPI document against its snapshot.

After a change that was meant: `python -m tests.contract.test_openapi`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from services.gateway.settings import STAGES
from services.wiring import create_app, create_stage

SNAPSHOTS = Path(__file__).parent / "snapshots"
EVERY_SERVICE = (*STAGES, "gateway")


def document(service: str) -> dict[str, Any]:
    app = create_app() if service == "gateway" else create_stage(service)
    found: dict[str, Any] = app.openapi()
    found["info"].pop("version")
    return found


@pytest.mark.parametrize("service", EVERY_SERVICE)
def test_the_document_is_the_snapshot(service: str) -> None:
    snapshot = json.loads((SNAPSHOTS / f"{service}.json").read_text())
    assert document(service) == snapshot


@pytest.mark.parametrize("service", EVERY_SERVICE)
def test_every_reference_resolves(service: str) -> None:
    found = document(service)
    text = json.dumps(found)
    schemas = found["components"]["schemas"]
    names = {part.split('"')[0] for part in text.split("#/components/schemas/")[1:]}
    assert names
    assert names <= set(schemas)


if __name__ == "__main__":
    SNAPSHOTS.mkdir(exist_ok=True)
    for each in EVERY_SERVICE:
        text = json.dumps(document(each), indent=1, sort_keys=True)
        (SNAPSHOTS / f"{each}.json").write_text(text + "\n")
