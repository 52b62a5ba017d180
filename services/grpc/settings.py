"""What the gRPC server can be told."""

from __future__ import annotations

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict

from shared.settings import environment


class GrpcSettings(BaseSettings):
    """Read from `SPARGE_GRPC_*`.

    Attributes
    ----------
    url : str or None
        The gateway that is asked; None: the one of this process, where there is one.
    insecure : bool
        Listen on other addresses than the loopback although the gateway wants no API keys.
    max_message_bytes : int
        A larger request is refused with RESOURCE_EXHAUSTED before it is unpacked. The gateway
        has a limit of its own (`SPARGE_GATEWAY_MAX_BODY_BYTES`).
    max_calls : int
        So many calls are open at once; further ones are refused with RESOURCE_EXHAUSTED.
        Who works and who waits is up to the gateway's queue.
    timeout_s : float
        How long the gateway is waited for where a call has no deadline.
    health_s : float
        Seconds between two looks at the gateway's `/health/ready`.
    stop_s : float
        Calls that are open at SIGTERM may take so much longer.
    """

    model_config = SettingsConfigDict(**environment("grpc"), frozen=True, extra="ignore")

    url: str | None = None
    insecure: bool = False
    max_message_bytes: int = Field(default=32 * 2**20, gt=0)
    max_calls: int = Field(default=128, ge=1)
    timeout_s: float = Field(default=120.0, gt=0)
    health_s: float = Field(default=1.0, gt=0)
    stop_s: float = Field(default=4.0, ge=0)
