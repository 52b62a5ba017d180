"""`python -m services.grpc`: serve gRPC alone, for the gateway at SPARGE_GRPC_URL."""

from __future__ import annotations

import argparse
import asyncio
import sys

from services.grpc.app import serve_until_stopped
from services.grpc.settings import GrpcSettings
from shared.errors import SpargeError
from shared.service.logs import log_as_a_server


def main() -> None:
    """Parse the command line and serve; a setting that cannot be is told in one line."""
    parser = argparse.ArgumentParser(prog="python -m services.grpc", description=__doc__)
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on")
    parser.add_argument("--port", type=int, default=50051)
    given = parser.parse_args()
    log_as_a_server()
    try:
        asyncio.run(serve_until_stopped(GrpcSettings(), given.host, given.port))
    except (SpargeError, ValueError) as error:
        sys.exit(f"the gRPC server does not start: {error}")


if __name__ == "__main__":
    main()
