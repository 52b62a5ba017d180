"""Who may import whom (docs/decisions/0001-architecture.md), held against the code's imports."""

from __future__ import annotations

import grimp
import pytest

PACKAGES = ("shared", "services", "experiments")
SERVICES = (
    "perception",
    "primitive_recovery",
    "reasoning",
    "grasp_proposal",
    "matching",
    "execution",
    "gateway",
    "grpc",
    "mcp",
)
WITHOUT_ROUTES = ("viewer",)
"""Nobody calls them; the other rules of services are theirs too."""
SHARED_LAYERS = (  # lowest first; a module may import its own layer and those before it
    {"errors", "deadline", "geometry", "loopback", "output"},
    {"superquadric"},
    {"child", "settings", "wire"},
    {"schemas"},
    {"grippers", "rehearsal"},
    {"service"},
    {"client"},
)
WEB = {"fastapi", "starlette", "uvicorn", "httpx"}
MAY_USE_THE_WEB = (
    "shared.service",
    "shared.client",
    "services.wiring",
    "services.cli",
)
SPEAK_HTTP = {
    "gateway": {"pipeline", "openapi", "knowledge", "body", "grasping", "kserve", "__main__"},
    "grpc": {"backend", "service", "__main__"},
}
"""Modules and packages beside `app` that may, by service."""


def violations(graph: grimp.ImportGraph) -> list[str]:
    """Return every import that breaks a rule, as `importer -> imported: rule`."""
    found = []
    for importer in sorted(graph.modules):
        if not importer.startswith(PACKAGES):
            continue
        for imported in sorted(graph.find_modules_directly_imported_by(importer)):
            rule = broken_rule(importer, imported)
            if rule:
                found.append(f"{importer} -> {imported}: {rule}")
    return found


def broken_rule(importer: str, imported: str) -> str | None:
    """Return the rule that this import breaks, if any."""
    source, target = importer.split("."), imported.split(".")
    if source[0] == "shared" and target[0] in ("services", "experiments"):
        return "shared imports no service"
    if source[0] == "services" and target[0] == "experiments" and source[1] != "cli":
        return "only the command line knows the experiments"
    if source[0] == "experiments" and target[0] == "services":
        return "experiments use the public client and shared alone"
    between_services = source[0] == target[0] == "services" and _service(source)
    if between_services and _service(target) not in (None, _service(source)):
        return "services never import each other"
    if source[0] == "services" and _service(source) and target[:2] == ["services", "wiring"]:
        return "only the command line knows the composition root"
    if source[0] == target[0] == "shared" and _layer(source) < _layer(target):
        return "shared has layers"
    if target[0] in WEB or target[:2] == ["shared", "service"]:
        allowed = importer.startswith(MAY_USE_THE_WEB) or (
            source[0] == "services" and _speaks_http(source)
        )
        if not allowed:
            return "domain modules know nothing of HTTP"
    return None


def _service(path: list[str]) -> str | None:
    return path[1] if len(path) > 1 and path[1] in SERVICES + WITHOUT_ROUTES else None


def _speaks_http(path: list[str]) -> bool:
    """A service's `app`, and in those that speak to others what does so."""
    return path[-1] == "app" or bool(set(path[2:3]) & SPEAK_HTTP.get(path[1], set()))


def _layer(path: list[str]) -> int:
    name = path[1] if len(path) > 1 else ""
    return next((i for i, layer in enumerate(SHARED_LAYERS) if name in layer), -1)


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    return grimp.build_graph(*PACKAGES, include_external_packages=True, cache_dir=None)


def test_the_imports_keep_the_rules(graph: grimp.ImportGraph) -> None:
    assert violations(graph) == []


def test_every_service_is_seen(graph: grimp.ImportGraph) -> None:
    assert {f"services.{name}.app" for name in SERVICES} <= graph.modules


@pytest.mark.parametrize(
    ("importer", "imported"),
    [
        ("shared.wire.npz", "services.gateway.request"),
        ("services.perception.clusters", "services.matching.region"),
        ("services.matching.select", "services.wiring"),
        ("services.reasoning.engine", "fastapi"),
        ("services.reasoning.engine", "shared.service.client"),
        ("shared.geometry.plane", "shared.schemas.scene"),
        ("experiments.regions", "services.gateway.pipeline"),
        ("services.grpc.calls", "services.gateway.request"),
        ("services.grpc.answer", "httpx"),
        ("services.mcp.tools", "services.gateway.request"),
    ],
)
def test_a_forbidden_import_is_reported(importer: str, imported: str) -> None:
    graph = grimp.ImportGraph()
    graph.add_import(importer=importer, imported=imported)
    assert len(violations(graph)) == 1
