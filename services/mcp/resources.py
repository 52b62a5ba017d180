"""What an agent can read: the bundled views, the grippers, the pages of the documentation."""

from __future__ import annotations

import json
from pathlib import Path

from mcp.server import MCPServer
from mcp.server.mcpserver.exceptions import ResourceError
from mcp.server.mcpserver.resources import FunctionResource

from services.mcp.backend import Backend
from services.mcp.files import samples
from shared.errors import SpargeError
from shared.settings import PROJECT_ROOT

PAGES = {
    "http-api": "Units, frames, parameters, errors",
    "reasons": "Every reason for an empty answer",
    "grippers": "The grippers, and how to add one",
}
"""Of docs/, which a checkout has."""
_JSON = "application/json"


def add_resources(server: MCPServer, backend: Backend) -> None:
    """Give `server` its resources."""

    @server.resource("sparge://samples", name="samples", mime_type=_JSON)
    def bundled() -> str:
        """List the bundled views, for the argument `file` of the tool `grasp`."""
        return json.dumps(samples())

    @server.resource("sparge://grippers", name="grippers", mime_type=_JSON)
    def grippers() -> str:
        """List the grippers, for the argument `gripper` of the tool `grasp`; metres and newtons."""
        try:
            known = backend.sparge.grippers()
        except SpargeError as error:
            raise ResourceError(f"{error.code}: {error.message}") from None
        return json.dumps([each.model_dump(mode="json", exclude={"urdf"}) for each in known])

    for name, description in PAGES.items():
        path = PROJECT_ROOT / "docs" / f"{name}.md"
        if path.is_file():
            server.add_resource(_page(path, description))


def _page(path: Path, description: str) -> FunctionResource:
    return FunctionResource.from_function(
        fn=path.read_text,
        uri=f"sparge://docs/{path.stem}",
        name=path.stem,
        description=description,
        mime_type="text/markdown",
    )
