"""What the network sees: sizes relative to the largest, the like ones in order.

Written twice over: in NumPy for training and as an ONNX graph that is put before
the exported network, so that serving hands it raw parameters in any unit. A
superquadric with a1 and a2 exchanged is the same body turned by 90 degrees: the
smaller comes first, so the answer cannot depend on it.
"""

from __future__ import annotations

import numpy as np
import onnx
from numpy.typing import NDArray

Array = NDArray[np.float64]

_GRAPH = """
<ir_version: 8, opset_import: ["" : 17]>
normalise (float[N, 5] parameters) => (float[N, 5] features)
<int64[1] from0 = {0}, int64[1] from2 = {2}, int64[1] from3 = {3}, int64[1] from4 = {4},
 int64[1] to5 = {5}, int64[1] column = {1}>
{
  exponents = Slice (parameters, from0, from2, column)
  first = Slice (parameters, from2, from3, column)
  second = Slice (parameters, from3, from4, column)
  third = Slice (parameters, from4, to5, column)
  smaller = Min (first, second)
  larger = Max (first, second)
  ordered = Concat <axis = 1> (smaller, larger, third)
  largest = ReduceMax <axes = [1]> (ordered)
  relative = Div (ordered, largest)
  features = Concat <axis = 1> (exponents, relative)
}
"""


def features(parameters: Array) -> NDArray[np.float32]:
    """Return the network's inputs (N, 5) for [e1, e2, a1, a2, a3] (N, 5)."""
    flat = np.sort(parameters[:, 2:4], axis=1)
    ordered = np.hstack([flat, parameters[:, 4:]])
    relative = ordered / ordered.max(axis=1, keepdims=True)
    return np.hstack([parameters[:, :2], relative]).astype(np.float32)


def with_features(network: onnx.ModelProto) -> onnx.ModelProto:
    """Return the network with `features` computed inside; its input is `parameters`."""
    return onnx.compose.merge_models(
        onnx.parser.parse_model(_GRAPH), network, io_map=[("features", "features")]
    )
