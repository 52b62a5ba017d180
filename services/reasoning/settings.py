"""What the reasoning service can be told."""

from __future__ import annotations

from pathlib import Path

from pydantic import Field

from services.reasoning.confidence import MAPS
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
        Where what is learned is kept: added tasks and affordances, taught rules.
        It is created with the first of them. Several processes may share it.
    max_learned : int
        So many tasks, affordances and rules can be added.
    sparql_timeout_s : float
        A SPARQL query that takes longer is given up.
    max_rows : int
        Of an answer to a SPARQL query.
    max_primitives : int
        A request with more is refused: rules are tried on pairs of primitives.
    max_inferences : int
        Prolog gives up on a request after so many; an ordinary one takes a few
        ten thousand.
    confidence_file : Path or None
        How certainties of proofs become confidences; None: they stay as they are.
    max_wait_s : float
        How long a request may wait for Prolog and its answer.
    """

    model_config = environment("reasoning")

    rules_dir: Path = PROJECT_ROOT / "rules"
    ontology_file: Path = PROJECT_ROOT / "ontology" / "sparge.ttl"
    knowledge_dir: Path = PROJECT_ROOT / ".state" / "knowledge"
    max_learned: int = Field(default=50_000, ge=0)
    sparql_timeout_s: float = Field(default=2.0, gt=0)
    max_rows: int = Field(default=1000, gt=0)
    max_primitives: int = Field(default=32, gt=0)
    max_inferences: int = Field(default=20_000_000, gt=0)
    confidence_file: Path | None = MAPS
    max_wait_s: float = Field(default=20.0, gt=0)
