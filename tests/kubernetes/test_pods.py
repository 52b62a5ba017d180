"""How pods run: locked up, with limits, started warm, watched and ended in good order."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tests.kubernetes.manifests import CHECKOUT, Object, of_kind, pod_of

DOCKERFILE = (CHECKOUT / "docker" / "Dockerfile").read_text()


def pods(objects: list[Object]) -> Iterator[tuple[str, Object]]:
    for name, deployment in of_kind(objects, "Deployment").items():
        yield name, pod_of(deployment)


def found(pattern: str) -> str:
    """Return what the Dockerfile says."""
    match = re.search(pattern, DOCKERFILE)
    assert match is not None, pattern
    return match[1]


def test_pods_are_locked_up(objects: list[Object]) -> None:
    user = int(found(r"--uid (\d+)"))
    for _, pod in pods(objects):
        assert pod["automountServiceAccountToken"] is False
        assert pod["enableServiceLinks"] is False
        assert not {"hostNetwork", "hostPID", "hostIPC"} & set(pod)
        context = pod["securityContext"]
        assert context["runAsNonRoot"] is True
        assert context["runAsUser"] == context["runAsGroup"] == context["fsGroup"] == user
        assert context["seccompProfile"] == {"type": "RuntimeDefault"}
        for container in (*pod["containers"], *pod.get("initContainers", [])):
            assert container["securityContext"] == {
                "allowPrivilegeEscalation": False,
                "readOnlyRootFilesystem": True,
                "capabilities": {"drop": ["ALL"]},
            }


def test_the_namespace_holds_others_to_it(objects: list[Object]) -> None:
    labels = of_kind(objects, "Namespace")["sparge"]["metadata"]["labels"]
    assert labels["pod-security.kubernetes.io/enforce"] == "restricted"


def test_memory_has_a_limit_and_the_processor_a_request(objects: list[Object]) -> None:
    for _, pod in pods(objects):
        for container in (*pod["containers"], *pod.get("initContainers", [])):
            resources = container["resources"]
            assert set(resources["requests"]) == {"cpu", "memory"}
            assert set(resources["limits"]) == {"memory"}
            assert _bytes(resources["requests"]["memory"]) <= _bytes(resources["limits"]["memory"])
        for volume in pod["volumes"]:
            assert "sizeLimit" in volume.get("emptyDir", {"sizeLimit": ""})


def test_there_is_a_place_for_temporary_files(objects: list[Object]) -> None:
    for _, pod in pods(objects):
        (container,) = pod["containers"]
        mounts = {each["mountPath"]: each["name"] for each in container["volumeMounts"]}
        (scratch,) = (each for each in pod["volumes"] if each["name"] == mounts["/tmp"])
        assert "emptyDir" in scratch


def test_compiled_kernels_are_brought_to_where_numba_may_write(objects: list[Object]) -> None:
    # The images' entry point does it, into /tmp: nothing may replace it, and there is room.
    assert found(r'ENTRYPOINT \["sh", "(\S+)"\]') == "/app/docker/start.sh"
    for _, pod in pods(objects):
        (container,) = pod["containers"]
        assert "command" not in container
        (scratch,) = (each for each in pod["volumes"] if each["name"] == "tmp")
        assert scratch["emptyDir"]["sizeLimit"] == "256Mi"


def test_probes_ask_what_services_answer(objects: list[Object]) -> None:
    for name, pod in pods(objects):
        (container,) = pod["containers"]
        asked = {
            probe: container[f"{probe}Probe"]["httpGet"]["path"]
            for probe in ("startup", "readiness", "liveness")
        }
        # The gateway's readiness is that of all stages, and would take it away with any of them.
        ready = "/health/live" if name == "gateway" else "/health/ready"
        assert asked == {"startup": ready, "readiness": ready, "liveness": "/health/live"}
        ports = {each["name"]: each["containerPort"] for each in container["ports"]}
        assert ports == {"http": int(found(r"--port (\d+)"))}


def test_a_pod_has_time_to_end_in_good_order(objects: list[Object]) -> None:
    uvicorn_s = int(found(r"--timeout-graceful-shutdown (\d+)"))
    for _, pod in pods(objects):
        (container,) = pod["containers"]
        command, seconds = container["lifecycle"]["preStop"]["exec"]["command"]
        assert command == "sleep"
        assert int(seconds) + uvicorn_s < pod["terminationGracePeriodSeconds"]


def _bytes(quantity: str) -> int:
    units = {"Mi": 2**20, "Gi": 2**30}
    return int(quantity[:-2]) * units[quantity[-2:]]
