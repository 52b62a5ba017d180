"""`python -m services.gateway`: serve the gateway alone; its stages are found by URL."""

from __future__ import annotations

import argparse
import sys
from functools import partial

import uvicorn

from services.gateway.access import require_guarded
from services.gateway.app import create_app
from services.gateway.settings import GatewaySettings
from shared.errors import SpargeError


def main() -> None:
    """Parse the command line and serve; a setting that cannot be is told in one line."""
    parser = argparse.ArgumentParser(prog="python -m services.gateway", description=__doc__)
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on")
    parser.add_argument("--port", type=int, default=8000)
    parser.add_argument(
        "--insecure", action="store_true", help="answer other machines without API keys"
    )
    given = parser.parse_args()
    try:
        settings = GatewaySettings()
        if given.insecure:
            settings = settings.model_copy(update={"insecure": True})
        require_guarded(given.host, settings)
        uvicorn.run(
            partial(create_app, settings),
            factory=True,  # made once uvicorn has set up its logs, so that ours are the same
            host=given.host,
            port=given.port,
            timeout_graceful_shutdown=4,
        )
    except (SpargeError, ValueError) as error:
        sys.exit(f"the gateway does not start: {error}")


if __name__ == "__main__":
    main()
