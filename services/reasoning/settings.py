"""What the reasoning service can be told."""

from __future__ import annotations

from pathlib import Path

from pydantic import Field

from shared.settings import PROJECT_ROOT, ServiceSettings, environment


class ReasoningSettings(ServiceSettings):
    """Read from `SPARGE_REASONING_*`.

    Attributes
    ----------
    rules_dir : Path
        The Prolog rules, with a folder per rule set.
    ontology_file : Path
        The Turtle file to start from; its imports lie beside it.
    knowledge_dir : Path
        Where added tasks are kept, one Turtle file each. It is created when the
        first task is added.
    max_primitives : int
        A request with more is refused: rules are tried on pairs of primitives.
    max_inferences : int
        Prolog gives up on a request after so many; an ordinary one takes a few
        ten thousand.
    max_wait_s : float
        How long a request may wait for Prolog and its answer.
    """

    model_config = environment("reasoning")

    rules_dir: Path = PROJECT_ROOT / "rules"
    ontology_file: Path = PROJECT_ROOT / "ontology" / "sparge.ttl"
    knowledge_dir: Path = PROJECT_ROOT / ".state" / "knowledge"
    max_primitives: int = Field(default=32, gt=0)
    max_inferences: int = Field(default=20_000_000, gt=0)
    max_wait_s: float = Field(default=20.0, gt=0)
