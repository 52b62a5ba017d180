"""The Open Inference Protocol (KServe V2): POST /grasp as a model named `sparge`."""

from services.gateway.kserve.messages import MODEL, error_body
from services.gateway.kserve.openapi import describe_kserve
from services.gateway.kserve.routes import serve_kserve

__all__ = ["MODEL", "describe_kserve", "error_body", "serve_kserve"]
