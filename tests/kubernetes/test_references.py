"""What one object says about another is true: labels, names, ports, volumes, images."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
import yaml

from services.gateway.settings import STAGES, GatewaySettings
from services.reasoning.settings import ReasoningSettings
from shared import __version__
from tests.kubernetes.manifests import (
    BASE,
    CHECKOUT,
    FOLDER,
    Object,
    base_objects,
    kustomization,
    kustomizations,
    of_kind,
    own_objects,
    patches,
    pod_labels,
    pod_of,
    selects,
)

SERVICES = {"gateway", *(name.replace("_", "-") for name in STAGES)}
OF_ALL = {"SPARGE_STAGE_SECRET"}
"""Settings without the name of a service."""


def containers(pod: Object) -> Iterator[Object]:
    yield from pod.get("initContainers", [])
    yield from pod["containers"]


def environment(container: Object) -> dict[str, str]:
    return {each["name"]: each.get("value", "") for each in container.get("env", [])}


def test_each_service_has_what_it_needs(objects: list[Object]) -> None:
    for kind in ("Deployment", "Service", "PodDisruptionBudget"):
        assert set(of_kind(objects, kind)) == SERVICES, kind


def test_a_deployment_selects_its_own_pods_alone(objects: list[Object]) -> None:
    deployments = of_kind(objects, "Deployment")
    for name, deployment in deployments.items():
        selected = {
            other
            for other, each in deployments.items()
            if selects(deployment["spec"]["selector"], pod_labels(each))
        }
        assert selected == {name}


def test_a_service_leads_to_the_pods_of_its_name(objects: list[Object]) -> None:
    deployments = of_kind(objects, "Deployment")
    for name, service in of_kind(objects, "Service").items():
        selector = {"matchLabels": service["spec"]["selector"]}
        selected = {
            other for other, each in deployments.items() if selects(selector, pod_labels(each))
        }
        assert selected == {name}
        (container,) = pod_of(deployments[name])["containers"]
        ports = {port["name"]: port["containerPort"] for port in container["ports"]}
        assert {each["targetPort"] for each in service["spec"]["ports"]} <= ports.keys()


def test_a_disruption_budget_is_about_the_pods_of_its_name(objects: list[Object]) -> None:
    deployments = of_kind(objects, "Deployment")
    for name, budget in of_kind(objects, "PodDisruptionBudget").items():
        selected = {
            other
            for other, each in deployments.items()
            if selects(budget["spec"]["selector"], pod_labels(each))
        }
        assert selected == {name}
        assert "minAvailable" not in budget["spec"], "one pod could never be moved"


def test_the_gateway_asks_services_that_are_there(objects: list[Object]) -> None:
    (gateway,) = pod_of(of_kind(objects, "Deployment")["gateway"])["containers"]
    services = of_kind(objects, "Service")
    told = environment(gateway)
    for stage in STAGES:
        url = urlsplit(told[f"SPARGE_GATEWAY_{stage.upper()}_URL"])
        assert url.hostname == stage.replace("_", "-")
        assert url.port in {port["port"] for port in services[url.hostname]["spec"]["ports"]}


def test_settings_are_ones_that_the_services_read(objects: list[Object]) -> None:
    known = {
        f"SPARGE_{service}_{field}".upper()
        for service, model in (("gateway", GatewaySettings), ("reasoning", ReasoningSettings))
        for field in model.model_fields
    }
    for deployment in of_kind(objects, "Deployment").values():
        for container in containers(pod_of(deployment)):
            ours = {name for name in environment(container) if name.startswith("SPARGE_")}
            assert ours <= known | OF_ALL


def test_volumes_are_there_and_used(objects: list[Object]) -> None:
    config_maps = of_kind(objects, "ConfigMap")
    claims = of_kind(objects, "PersistentVolumeClaim")
    used_maps, used_claims = set(), set()
    for deployment in of_kind(objects, "Deployment").values():
        pod = pod_of(deployment)
        volumes = {each["name"]: each for each in pod["volumes"]}
        mounted = {m["name"] for c in containers(pod) for m in c.get("volumeMounts", [])}
        assert mounted == set(volumes)
        for volume in volumes.values():
            source = volume.get("configMap", {})
            if source and not source.get("optional"):
                used_maps.add(source["name"])
            if "persistentVolumeClaim" in volume:
                used_claims.add(volume["persistentVolumeClaim"]["claimName"])
    assert used_maps == set(config_maps)
    assert used_claims == set(claims)


def test_the_secret_of_stages_may_be_missing_and_keys_may_not(objects: list[Object]) -> None:
    for deployment in of_kind(objects, "Deployment").values():
        pod = pod_of(deployment)
        (container,) = pod["containers"]
        found = [each["secret"] for each in pod["volumes"] if "secret" in each]
        found += [
            each["valueFrom"]["secretKeyRef"] for each in container["env"] if "valueFrom" in each
        ]
        assert found
        for secret in found:
            assert secret.get("name", secret.get("secretName")) == "sparge-secrets"
            assert secret.get("optional", False) is ("secretName" not in secret)


def test_images_are_targets_of_the_dockerfile(objects: list[Object]) -> None:
    lines = (CHECKOUT / "docker" / "Dockerfile").read_text().splitlines()
    targets = {line.rsplit(" ", 1)[1] for line in lines if line.startswith("FROM base AS ")}
    for name, deployment in of_kind(objects, "Deployment").items():
        for container in containers(pod_of(deployment)):
            image, _, tag = container["image"].partition(":")
            assert image == f"sparge/{name.replace('-', '_')}"
            assert image.removeprefix("sparge/") in targets
            assert tag in ("", __version__)  # the base's files leave it to its kustomization


def test_autoscalers_in_the_files_have_a_target() -> None:
    """Where nothing renders, too."""
    found = [each for folder in kustomizations() for each in own_objects(folder)]
    scaled = of_kind(found, "HorizontalPodAutoscaler")
    assert set(scaled) == SERVICES
    for name, each in scaled.items():
        assert each["spec"]["scaleTargetRef"]["name"] == name
        assert name in of_kind(base_objects(), "Deployment")


def test_autoscalers_have_a_target(overlay: dict[str, list[Object]]) -> None:
    for name, objects in overlay.items():
        deployments = of_kind(objects, "Deployment")
        scaled = of_kind(objects, "HorizontalPodAutoscaler")
        for each in scaled.values():
            target = each["spec"]["scaleTargetRef"]
            assert (target["kind"], target["name"]) == ("Deployment", each["metadata"]["name"])
            assert "replicas" not in deployments[target["name"]]["spec"], "two would decide"
        expected: dict[str, set[str]] = {
            "small": set(),
            "production": SERVICES - {"reasoning"},
            "fleet": SERVICES,
        }
        assert set(scaled) == expected[name]


def test_the_base_names_the_version_of_every_image() -> None:
    images = {each["name"]: each["newTag"] for each in kustomization(BASE)["images"]}
    assert images == {f"sparge/{name.replace('-', '_')}": __version__ for name in SERVICES}


def test_a_volume_that_one_node_has_is_for_one_pod(objects: list[Object]) -> None:
    for deployment in of_kind(objects, "Deployment").values():
        if any("persistentVolumeClaim" in each for each in pod_of(deployment)["volumes"]):
            assert deployment["spec"]["replicas"] == 1
            assert deployment["spec"]["strategy"] == {"type": "Recreate"}


@pytest.mark.parametrize("folder", kustomizations(), ids=lambda each: each.name)
def test_patches_meet_what_they_change(folder: Path) -> None:
    """Where nothing renders: names of objects, containers and volumes are those of the files."""
    known = [*base_objects(), *own_objects(FOLDER / "overlays" / "production")]
    for target, patch in patches(folder):
        meant = [
            each
            for each in known
            if each["kind"] == target["kind"]
            and target.get("name", each["metadata"]["name"]) == each["metadata"]["name"]
        ]
        assert meant, target
        if patch["kind"] != "Deployment":
            continue
        changed = patch["spec"]["template"]["spec"]
        for each in meant:
            for part in ("containers", "volumes"):
                assert _names(changed.get(part, [])) <= _names(pod_of(each)[part])


def test_patches_reach_every_container(overlay: dict[str, list[Object]]) -> None:
    """What an overlay says about all containers is what each of them has as rendered."""
    for name, objects in overlay.items():
        processors = {
            pod_of(each)["containers"][0]["resources"]["requests"]["cpu"]
            for each in of_kind(objects, "Deployment").values()
        }
        assert processors == {"small": {"50m"}, "production": {"1"}, "fleet": {"1"}}[name]


def test_every_container_has_its_name_in_its_own_lines() -> None:
    """kustomize patches none whose name is merged in from a piece that is merged itself."""
    document = yaml.compose((BASE / "deployments.yaml").read_text())
    containers = [
        container
        for key, value in _entries(document)
        if key == "containers"
        for container in value.value
    ]
    assert len(containers) == len(SERVICES)
    for container in containers:
        own = [key.value for key, _ in container.value]
        assert "name" in own, yaml.serialize(container)


def _entries(node: Any) -> Iterator[tuple[str, Any]]:
    """Yield all keys and values below a node of YAML, aliases as often as they are met."""
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if key.value != "<<":
                yield key.value, value
                yield from _entries(value)
    elif isinstance(node, yaml.SequenceNode):
        for each in node.value:
            yield from _entries(each)


def _names(things: Sequence[Object]) -> set[str]:
    return {each["name"] for each in things}
