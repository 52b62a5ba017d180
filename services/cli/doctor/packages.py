"""What each extra of pyproject.toml brings, and the name it is imported by."""

from __future__ import annotations

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
    "tracing": {
        "opentelemetry-sdk": "opentelemetry.sdk.trace",
        "opentelemetry-exporter-otlp-proto-http": (
            "opentelemetry.exporter.otlp.proto.http.trace_exporter"
        ),
    },
}


def extra_of(service: str) -> str:
    """Return the extra of a service; the names differ in one character."""
    return service.replace("_", "-")
