"""What each extra of pyproject.toml brings, and the name it is imported by."""

from __future__ import annotations

from collections.abc import Iterable
from importlib.util import find_spec

EXTRAS: dict[str, dict[str, str]] = {
    "perception": {"numba": "numba"},
    "primitive-recovery": {
        "numba": "numba",
        "onnxruntime": "onnxruntime",
        "scikit-learn": "sklearn.cluster",
    },
    "reasoning": {"rdflib": "rdflib"},  # pyswip starts Prolog: see `probes.reasoning`
    "grasp-proposal": {"numba": "numba", "onnxruntime": "onnxruntime"},
    "matching": {},
    "execution": {"pillow": "PIL.Image", "pybullet": "pybullet"},
    "gateway": {
        "cachetools": "cachetools",
        "pillow": "PIL.Image",
        "python-multipart": "python_multipart",
        "python-neo-lzf": "lzf",
    },
    "grpc": {
        "grpcio": "grpc",
        "grpcio-health-checking": "grpc_health.v1.health_pb2",
        "grpcio-reflection": "grpc_reflection.v1alpha.reflection",
        "protobuf": "google.protobuf",
    },
    "mcp": {"mcp": "mcp"},
    "tracing": {
        "opentelemetry-sdk": "opentelemetry.sdk.trace",
        "opentelemetry-exporter-otlp-proto-http": (
            "opentelemetry.exporter.otlp.proto.http.trace_exporter"
        ),
    },
}

OPTIONAL = ("grpc", "mcp")
"""Extras of commands that an installation may do without: `sparge grpc`, `sparge mcp`."""


def installed(extras: Iterable[str]) -> list[str]:
    """Return those extras whose package, of the same name, is there: then all should be."""
    return [extra for extra in extras if find_spec(extra) is not None]


def extra_of(service: str) -> str:
    """Return the extra of a service; the names differ in one character."""
    return service.replace("_", "-")
