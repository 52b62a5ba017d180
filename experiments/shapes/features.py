"""What the classifiers see: exponents, and logarithms of sizes relative to the largest.

Written twice over: in NumPy for training and as an ONNX graph that is put before
the exported network, so that serving hands it raw parameters in any unit. A
superquadric with a1 and a2 exchanged is the same body turned by 90 degrees: the
smaller comes first, so the answer cannot depend on it. Values beyond those that the
classifiers learned from count as the nearest that they did.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from experiments.shapes.dataset import EXPONENTS

if TYPE_CHECKING:
    import onnx

Array = NDArray[np.float64]

THINNEST = 0.01
"""Of the largest size: a thinner one counts as this."""

_GRAPH = f"""
<ir_version: 8, opset_import: ["" : 17]>
normalise (float[N, 5] parameters) => (float[N, 5] features)
<int64[1] from0 = {{0}}, int64[1] from2 = {{2}}, int64[1] from3 = {{3}}, int64[1] from4 = {{4}},
 int64[1] to5 = {{5}}, int64[1] column = {{1}},
 float least = {{{EXPONENTS[0]}}}, float most = {{{EXPONENTS[1]}}}, float thinnest = {{{THINNEST}}}>
{{
  raw = Slice (parameters, from0, from2, column)
  exponents = Clip (raw, least, most)
  first = Slice (parameters, from2, from3, column)
  second = Slice (parameters, from3, from4, column)
  third = Slice (parameters, from4, to5, column)
  smaller = Min (first, second)
  larger = Max (first, second)
  ordered = Concat <axis = 1> (smaller, larger, third)
  largest = ReduceMax <axes = [1]> (ordered)
  relative = Div (ordered, largest)
  thick = Max (relative, thinnest)
  sizes = Log (thick)
  features = Concat <axis = 1> (exponents, sizes)
}}
"""


def features(parameters: Array) -> NDArray[np.float32]:
    """Return the network's inputs (N, 5) for [e1, e2, a1, a2, a3] (N, 5)."""
    flat = np.sort(parameters[:, 2:4], axis=1)
    ordered = np.hstack([flat, parameters[:, 4:]])
    relative = ordered / ordered.max(axis=1, keepdims=True)
    sizes = np.log(np.maximum(relative, THINNEST))
    return np.hstack([parameters[:, :2].clip(*EXPONENTS), sizes]).astype(np.float32)


def with_features(network: onnx.ModelProto) -> onnx.ModelProto:
    """Return the network with `features` computed inside; its input is `parameters`."""
    from onnx import compose, parser  # of the training extra

    return compose.merge_models(
        parser.parse_model(_GRAPH), network, io_map=[("features", "features")]
    )
