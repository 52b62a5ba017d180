"""Who may talk to whom, by the policies as Kubernetes reads them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tests.kubernetes.manifests import (
    FOLDER,
    Object,
    base_objects,
    of_kind,
    own_objects,
    pod_labels,
    pod_of,
    selects,
)

Labels = Mapping[str, str]
STRANGER: Labels = {"app.kubernetes.io/name": "somebody"}
WATCHER: Labels = {"namespace:kubernetes.io/metadata.name": "monitoring"}
"""A pod of another namespace: the labels of that one, so named."""
OBSERVED = FOLDER / "components" / "observed"


def allowed(policies: list[Object], source: Labels | None, target: Labels | None) -> set[Any]:
    """Return the ports on which `source` may reach `target`; None is outside of the namespace.

    A policy isolates the pods that it selects; what any of their policies lets through, passes.
    Both ends have to let it through.
    """
    leaving = _passing(policies, "Egress", source, target)
    coming = _passing(policies, "Ingress", target, source)
    if leaving is None or coming is None:
        return {"any"} if leaving is coming else (coming if leaving is None else leaving) or set()
    return leaving & coming


def _passing(
    policies: list[Object], direction: str, here: Labels | None, there: Labels | None
) -> set[Any] | None:
    """Return the ports that the policies of `here` open to `there`; None: all of them."""
    if here is None or any(key.startswith("namespace:") for key in here):
        return None  # these policies are not about it
    mine = [
        each["spec"]
        for each in policies
        if selects(each["spec"]["podSelector"], here) and direction in each["spec"]["policyTypes"]
    ]
    if not mine:
        return None
    return {port for spec in mine for port in _opened(spec, direction, there)}


def _opened(spec: Object, direction: str, there: Labels | None) -> Iterator[Any]:
    peers = "to" if direction == "Egress" else "from"
    for rule in spec.get(direction.lower(), []):
        meant = peers not in rule or (
            there is not None and any(_is_peer(each, there) for each in rule[peers])
        )
        if meant:
            yield from (port["port"] for port in rule["ports"])


def _is_peer(peer: Object, there: Labels) -> bool:
    """Return whether a rule's peer means pods with such labels; `namespace:` marks another's."""
    names = {key.removeprefix("namespace:"): value for key, value in there.items()}
    if "namespaceSelector" in peer:
        assert "podSelector" not in peer, "both at once are not read here"
        return names.keys() != there.keys() and selects(peer["namespaceSelector"], names)
    return names.keys() == there.keys() and selects(peer["podSelector"], there)


def test_only_the_gateway_reaches_the_stages(objects: list[Object]) -> None:
    policies = list(of_kind(objects, "NetworkPolicy").values())
    labels = {n: pod_labels(each) for n, each in of_kind(objects, "Deployment").items()}
    gateway = labels.pop("gateway")
    assert len(labels) == 6
    for stage in labels.values():
        assert allowed(policies, gateway, stage) == {8000}
        assert allowed(policies, None, stage) == set()
        assert allowed(policies, STRANGER, stage) == set()
        for other in (*labels.values(), gateway, None):
            assert allowed(policies, stage, other) == set(), "a stage asks nobody"


def test_the_gateway_is_reached_and_asks_for_names_and_stages(objects: list[Object]) -> None:
    policies = list(of_kind(objects, "NetworkPolicy").values())
    gateway = pod_labels(of_kind(objects, "Deployment")["gateway"])
    assert allowed(policies, None, gateway) == {8000}
    assert allowed(policies, gateway, None) == {53}


def test_policies_name_a_port_that_pods_have(objects: list[Object]) -> None:
    for deployment in of_kind(objects, "Deployment").values():
        (container,) = pod_of(deployment)["containers"]
        assert [port["containerPort"] for port in container["ports"]] == [8000]


def test_without_policies_everything_passes() -> None:
    """The reading of policies can say that something is open."""
    assert allowed([], None, STRANGER) == {"any"}


def test_the_observed_are_scraped_and_send_traces_and_nothing_else_changes() -> None:
    plain = base_objects()
    before = list(of_kind(plain, "NetworkPolicy").values())
    policies = [*before, *of_kind(own_objects(OBSERVED), "NetworkPolicy").values()]
    for name, deployment in of_kind(plain, "Deployment").items():
        pod = pod_labels(deployment)
        assert allowed(before, WATCHER, pod) == ({8000} if name == "gateway" else set())
        assert allowed(policies, WATCHER, pod) == {8000}
        assert allowed(policies, pod, WATCHER) == {4317, 4318, 53}
        assert allowed(policies, pod, None) == {53}
        assert allowed(policies, None, pod) == ({8000} if name == "gateway" else set())
        assert allowed(policies, STRANGER, pod) == set()
