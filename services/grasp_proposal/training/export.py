"""Networks and their calibration as one ONNX file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from onnx import ModelProto, NodeProto, TensorProto, checker, helper, numpy_helper

from services.grasp_proposal.descriptor import CHANNELS, SIZE
from services.grasp_proposal.learned import IMAGES, LOGIT, NUMBERS
from services.grasp_proposal.measures import NAMES
from services.grasp_proposal.training.calibration import Platt
from services.grasp_proposal.training.network import FAR, HEADS, Network

OPSET, IR_VERSION = 17, 9


def to_onnx(networks: Sequence[Network], platt: Platt) -> ModelProto:
    """Return the model: `images` and `numbers` to the calibrated `logit` of all heads."""
    graph = _Graph()
    heads = [graph.add_network(f"n{index}_", each) for index, each in enumerate(networks)]
    summed = heads[0] if len(heads) == 1 else graph.node("Sum", heads, "heads")
    share = np.array(HEADS, dtype=np.float32)[:, None] * platt.slope / len(networks)
    graph.tensor("share", share)
    graph.tensor("shift", np.full(1, platt.shift, dtype=np.float32))
    graph.node("Gemm", [summed, "share", "shift"], "column")
    graph.tensor("column_axis", np.array([1], dtype=np.int64))
    graph.node("Squeeze", ["column", "column_axis"], LOGIT)
    made = helper.make_graph(
        graph.nodes,
        "grasp_scorer",
        [
            helper.make_tensor_value_info(IMAGES, TensorProto.FLOAT, ["G", CHANNELS, SIZE, SIZE]),
            helper.make_tensor_value_info(NUMBERS, TensorProto.FLOAT, ["G", len(NAMES)]),
        ],
        [helper.make_tensor_value_info(LOGIT, TensorProto.FLOAT, ["G"])],
        graph.tensors,
    )
    model = helper.make_model(
        made, opset_imports=[helper.make_opsetid("", OPSET)], producer_name="sparge"
    )
    model.ir_version = IR_VERSION
    checker.check_model(model)
    return model


class _Graph:
    def __init__(self) -> None:
        self.nodes: list[NodeProto] = []
        self.tensors: list[TensorProto] = []

    def tensor(self, name: str, value: NDArray[Any]) -> str:
        self.tensors.append(numpy_helper.from_array(np.ascontiguousarray(value), name))
        return name

    def node(self, kind: str, inputs: Sequence[str], output: str, **attributes: Any) -> str:
        self.nodes.append(helper.make_node(kind, list(inputs), [output], **attributes))
        return output

    def add_network(self, prefix: str, network: Network) -> str:
        """Add a network's nodes; return the name of its logits (G, 2)."""
        seen = self._layers(prefix + "pictures_", network.pictures, IMAGES)
        mean = self.tensor(prefix + "mean", network.mean)
        deviation = self.tensor(prefix + "deviation", network.deviation)
        low = self.tensor(prefix + "low", np.array(-FAR, dtype=np.float32))
        high = self.tensor(prefix + "high", np.array(FAR, dtype=np.float32))
        centred = self.node("Sub", [NUMBERS, mean], prefix + "centred")
        scaled = self.node("Div", [centred, deviation], prefix + "scaled")
        cut = self.node("Clip", [scaled, low, high], prefix + "cut")
        known = self._layers(prefix + "numbers_", network.numbers, cut)
        both = self.node("Concat", [seen, known], prefix + "both", axis=1)
        return self._layers(prefix + "joint_", network.joint, both)

    def _layers(self, prefix: str, layers: Any, name: str) -> str:
        for index, layer in enumerate(layers):
            kind, output = type(layer).__name__, f"{prefix}{index}"
            if kind == "Conv2d":
                name = self.node(
                    "Conv",
                    [name, *self._weights(output, layer)],
                    output,
                    strides=list(layer.stride),
                    pads=list(layer.padding) * 2,
                )
            elif kind == "Linear":
                name = self.node("Gemm", [name, *self._weights(output, layer)], output, transB=1)
            elif kind == "ReLU":
                name = self.node("Relu", [name], output)
            elif kind == "Flatten":
                name = self.node("Flatten", [name], output, axis=1)
            elif kind != "Dropout":  # which does nothing after training
                raise TypeError(f"no ONNX for the layer {kind}")
        return name

    def _weights(self, name: str, layer: Any) -> list[str]:
        return [
            self.tensor(f"{name}_{which}", getattr(layer, which).detach().numpy())
            for which in ("weight", "bias")
        ]
