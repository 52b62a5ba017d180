"""How likely is a grasp to lift and keep the object? A network's answer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import onnxruntime
from numpy.typing import NDArray

from services.grasp_proposal.closing_region import closing_regions, upright
from services.grasp_proposal.contacts import Contacts
from services.grasp_proposal.descriptor import describe
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.measures import measure
from services.grasp_proposal.scorer import tool_centre
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace
from shared.errors import InternalError

Array = NDArray[np.float64]
Single = NDArray[np.float32]

MODEL = Path(__file__).parent / "model" / "grasp_scorer.onnx"
IMAGES, NUMBERS, LOGIT = "images", "numbers", "logit"


class LearnedScorer:
    """Scores grasps by a network on images of their closing regions; calls may overlap.

    Parameters
    ----------
    path : Path
        ONNX file: `images` (G, 15, 20, 20) and `numbers` (G, M), float32, in; `logit` (G,)
        out, the calibrated log odds that a grasp lifts the object, raised and lowered by
        how likely it is to keep it when shaken.

    Raises
    ------
    InternalError
        There is no such file, or no such network in it.
    """

    def __init__(self, path: Path = MODEL) -> None:
        if not path.is_file():
            raise InternalError(
                f"the network that scores grasps is missing: no file {path}; "
                "`make train-grasps` makes it anew"
            )
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1
        options.inter_op_num_threads = 1
        options.log_severity_level = 3
        try:
            self._session = onnxruntime.InferenceSession(
                str(path), options, providers=["CPUExecutionProvider"]
            )
            taken = [each.name for each in self._session.get_inputs()]
            given = [each.name for each in self._session.get_outputs()]
        except Exception as error:
            raise InternalError(f"{path} is no network that can be run: {error}") from None
        if taken != [IMAGES, NUMBERS] or LOGIT not in given:
            raise InternalError(f"{path} is no scorer of grasps: it maps {taken} to {given}")

    def score(
        self,
        workspace: Workspace,
        hand: Hand,
        contacts: Contacts,
        palm_height: Array,
        tip_height: Array,
        sight: SightMap | None,
    ) -> Array:
        """Return the probability (G,) that each grasp lifts the object; order by it.

        Parameters
        ----------
        palm_height, tip_height : (G,) arrays
            From `support_clearance`.
        sight : SightMap or None
            Without it, all space but the points counts as free.
        """
        images, numbers = inputs(workspace, hand, contacts, palm_height, tip_height, sight)
        return self.probabilities(images, numbers)

    def probabilities(self, images: Single, numbers: Single) -> Array:
        """Return the network's answer (G,) about images and numbers."""
        if not len(images):
            return np.empty(0)
        (logit,) = self._session.run([LOGIT], {IMAGES: images, NUMBERS: numbers})
        return sigmoid(logit.astype(np.float64))


def inputs(
    workspace: Workspace,
    hand: Hand,
    contacts: Contacts,
    palm_height: Array,
    tip_height: Array,
    sight: SightMap | None,
) -> tuple[Single, Single]:
    """Return what the network sees of G grasps: images (G, 15, 20, 20) and numbers (G, M)."""
    rotation = upright(contacts.placed.rotation)
    centre = tool_centre(contacts.placed, hand)
    regions = closing_regions(hand, centre, rotation, contacts.width)
    numbers = measure(workspace, hand, contacts, rotation, palm_height, tip_height, sight)
    return describe(workspace, regions, sight), numbers.astype(np.float32)


def sigmoid(logits: Array | Sequence[float]) -> Array:
    """Return 1 / (1 + exp(-logits))."""
    return np.asarray(0.5 * (1 + np.tanh(0.5 * np.asarray(logits, dtype=np.float64))))
