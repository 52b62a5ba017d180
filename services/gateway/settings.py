"""What the gateway can be told."""

from __future__ import annotations

from pathlib import Path

from pydantic import Field

from shared.schemas.primitive import Preset
from shared.schemas.rehearsal import Rehearsing
from shared.schemas.task import RuleSet
from shared.settings import ServiceSettings, environment, processors

STAGES = (
    "perception",
    "primitive_recovery",
    "reasoning",
    "grasp_proposal",
    "matching",
    "execution",
)


NETWORKED = 16
"""Requests worked on at once where every stage is a process of its own."""


class GatewaySettings(ServiceSettings):
    """Read from `SPARGE_GATEWAY_*`.

    Attributes
    ----------
    perception_url, ... : str or None
        Where each stage is served. Run alone, the gateway needs all of them;
        in the composition root a stage without a URL runs in the same process.
    deadline_s : float
        Bound on the time to answer POST /grasp; a request's `X-Request-Timeout` may be less.
    execution_deadline_s : float
        The same for POST /execute.
    rehearsal : str
        Whether grasps are tried in simulation before they are answered, where a request does not
        say: `auto`, those in doubt; `never`; `always`.
    rehearsal_time_s : float
        How long grasps may be rehearsed for one answer with `auto`; those in doubt after that are
        not.
    samples : int
        Points at which grasps are sought (thesis 6.4.1: 300).
    preset : str or None
        Recover primitives by the method `ems` with these parameters of Table A.1, where a
        request does not ask for another method; None: the recovery's own settings decide.
    rule_set : str
        Which rules decide where a request does not say: `default`, or `thesis` for
        those that were published.
    queue_wait_s : float
        As for every service. Where stages run in this process, as many requests are worked on
        at once as there are processors, otherwise `NETWORKED`: the gateway itself does little.
    api_keys_file : Path or None
        Who may ask what (`sparge key`); without it only the loopback is answered.
    insecure : bool
        Answer everybody who reaches this gateway, without keys.
    rate_per_s, rate_burst : float or None, float
        Requests a second that a key without a rate of its own may make in the long run, and at
        once; None: any number.
    cors_origins : tuple of str
        Web pages of these origins may ask; none unless told.
    kept_explanations, keep_explanations_s : int, float
        GET /grasp/{request_id}/explanation knows so many of the latest, for so long.
    file_memory_bytes : int
        What reading an uploaded file may take beside the reading process itself; a sound one
        takes up to four times what it unpacks to.
    file_time_s : float
        Processor time that reading an uploaded file may take.
    approach_distance, retreat_distance : float
        Of the pregrasp and the retreat from the grasp, in metres.
    opening_margin : float
        How much wider than the part the hand is open on its way in, in `format=moveit`: as it was
        when collisions were looked for, metres.
    """

    model_config = environment("gateway")

    max_body_bytes: int = Field(default=32 * 2**20, gt=0)
    perception_url: str | None = None
    primitive_recovery_url: str | None = None
    reasoning_url: str | None = None
    grasp_proposal_url: str | None = None
    matching_url: str | None = None
    execution_url: str | None = None
    queue_wait_s: float = Field(default=1.0, ge=0)
    deadline_s: float = Field(default=30.0, gt=0)
    execution_deadline_s: float = Field(default=60.0, gt=0)
    rehearsal: Rehearsing = "never"
    rehearsal_time_s: float = Field(default=5.0, gt=0)
    samples: int = Field(default=300, ge=1, le=5000)
    preset: Preset | None = None
    rule_set: RuleSet = "default"
    api_keys_file: Path | None = None
    insecure: bool = False
    rate_per_s: float | None = Field(default=None, gt=0)
    rate_burst: float = Field(default=10.0, ge=1)
    cors_origins: tuple[str, ...] = ()
    kept_explanations: int = Field(default=256, ge=0)
    keep_explanations_s: float = Field(default=3600.0, gt=0)
    file_memory_bytes: int = Field(default=2**30, gt=0)
    file_time_s: float = Field(default=10.0, gt=0)
    approach_distance: float = Field(default=0.10, gt=0)
    retreat_distance: float = Field(default=0.10, gt=0)
    opening_margin: float = Field(default=0.010, ge=0)

    @property
    def concurrency(self) -> int:
        """How many POST /grasp are worked on at once."""
        networked = all(self.stage_url(stage) for stage in STAGES)
        return self.max_running or (NETWORKED if networked else processors())

    def stage_url(self, stage: str) -> str | None:
        """Return where `stage` is served, or None."""
        url: str | None = getattr(self, f"{stage}_url")
        return url or None
