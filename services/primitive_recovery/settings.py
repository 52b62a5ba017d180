"""What the primitive recovery service can be told."""

from __future__ import annotations

from pydantic import Field

from shared.schemas.primitive import Method, Preset
from shared.settings import ServiceSettings, environment


class PrimitiveRecoverySettings(ServiceSettings):
    """Read from `SPARGE_PRIMITIVE_RECOVERY_*`.

    Attributes
    ----------
    method : {"parts", "ems"}
        For requests that ask for neither a method nor parameters of one.
    preset : {"simulation", "real_world"}
        Parameters of Table A.1 for requests that name none.
    fit_points : int
        A superquadric is fitted to at most this many points, drawn evenly from
        the cloud; its inliers are then told from outliers on all of them.
    max_points : int
        A larger cloud is refused.
    """

    model_config = environment("primitive_recovery")

    method: Method = "parts"
    preset: Preset = "simulation"
    fit_points: int = Field(default=2000, ge=100)
    max_points: int = Field(default=1_000_000, ge=100)
