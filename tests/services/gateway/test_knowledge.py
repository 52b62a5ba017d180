"""Teaching and asking through the gateway, in JSON, Turtle and SPARQL."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from shared.client import Sparge
from shared.errors import InvalidInput, UnknownTask
from shared.schemas.knowledge import (
    ASK_QUESTION,
    EXPORT_KNOWLEDGE,
    IMPORT_KNOWLEDGE,
    QUERY_KNOWLEDGE,
    AskQuestion,
    KnowledgeImport,
    SparqlQuery,
)
from shared.schemas.route import Nothing
from tests.support.samples import sample_view
from tests.support.serving import Client

RULE = {
    "name": "slicing_by_size",
    "task": "slicing",
    "conditions": [{"condition": "largest"}],
}
AFFORDANCE = {
    "name": "press",
    "rules": [{"name": "press_rule", "conditions": [{"condition": "largest"}]}],
}
TURTLE = {"Content-Type": "text/turtle"}


@pytest.fixture
def forgetful(backend: Client) -> Iterator[Client]:
    """The backend, which forgets in the end what it was taught."""
    yield backend
    done = backend.request(
        "POST", "/knowledge", content=b"", headers=TURTLE, params={"replace": "true"}
    )
    assert done.status_code == 200


def test_a_task_that_is_gone_is_gone_at_once(forgetful: Client) -> None:
    """Though the gateway remembers for a moment which names are known."""
    sparge = Sparge(forgetful.request)
    task = {"name": "rinsing", "requires": ["contain"], "grasp": ["wrap_grasp"]}
    assert forgetful.request("POST", "/tasks", json=task).status_code == 200
    assert sparge.grasp(sample_view("bottle"), "rinsing", max_grasps=0).answer.found
    assert forgetful.request("DELETE", "/tasks/rinsing").status_code == 200
    with pytest.raises(UnknownTask) as caught:
        sparge.grasp(sample_view("bottle"), "rinsing", max_grasps=0)
    assert "pouring" in caught.value.details["known"]


def test_a_taught_rule_decides(forgetful: Client) -> None:
    sparge = Sparge(forgetful.request)
    taught = forgetful.request("POST", "/rules", json=RULE)
    assert taught.status_code == 200
    assert taught.json()["prolog"].startswith("affordTask(ID_part, slicing) :-")
    result = sparge.grasp(sample_view("bottle"), "slicing", reasoning="v1", max_grasps=0)
    assert result.answer.found
    assert result.answer.explanation is not None
    assert "learned/slicing_by_size/version1:slicing" in result.answer.explanation.text
    gone = forgetful.request("DELETE", "/rules/slicing_by_size")
    assert gone.json() == taught.json()
    status = forgetful.request("DELETE", "/rules/slicing_by_size").status_code
    assert status == 404


def test_an_affordance_and_a_task(forgetful: Client) -> None:
    assert forgetful.request("POST", "/affordances", json=AFFORDANCE).status_code == 200
    task = {"name": "pressing", "grasp": ["press"]}
    assert forgetful.request("POST", "/tasks", json=task).status_code == 200
    sparge = Sparge(forgetful.request)
    assert sparge.grasp(sample_view("bottle"), "pressing", max_grasps=0).answer.found
    refused = forgetful.request("DELETE", "/affordances/press")
    assert (refused.status_code, refused.json()["error"]["code"]) == (409, "conflict")


@pytest.mark.parametrize(
    ("path", "body", "status"),
    [
        ("/rules", {**RULE, "conditions": [{"condition": "halt"}]}, 422),
        ("/rules", {**RULE, "name": "x), halt, y("}, 422),
        ("/rules", {**RULE, "prolog": "halt."}, 422),
        ("/rules", {**RULE, "task": "grasp"}, 409),
        ("/affordances", {**AFFORDANCE, "name": "grasp"}, 409),
        ("/affordances", {**AFFORDANCE, "rules": []}, 422),
        ("/knowledge", {"turtle": "nonsense"}, 422),
        ("/sparql", {"query": "nonsense"}, 422),
        ("/sparql", {"query": "x" * 10_001}, 422),
    ],
)
def test_bad_input(forgetful: Client, path: str, body: object, status: int) -> None:
    response = forgetful.request("POST", path, json=body)
    assert response.status_code == status
    assert response.json()["error"]["message"]


def test_turtle_out_and_in(forgetful: Client) -> None:
    forgetful.request("POST", "/rules", json=RULE)
    document = forgetful.request("GET", "/knowledge")
    assert document.headers["content-type"].startswith("text/turtle")
    assert "slicing_by_size" in document.text
    forgetful.request("DELETE", "/rules/slicing_by_size")
    imported = forgetful.request("POST", "/knowledge", content=document.content, headers=TURTLE)
    assert imported.json() == {
        "tasks": [],
        "affordances": [],
        "rules": ["slicing_by_size"],
        "ignored": 0,
    }
    listed = forgetful.request("GET", "/rules").json()["rules"]
    assert [rule["name"] for rule in listed] == ["slicing_by_size"]


def test_turtle_as_a_message(forgetful: Client) -> None:
    plain = forgetful.request("GET", "/knowledge").text
    as_json = forgetful.request("GET", "/knowledge", headers={"Accept": "application/json"})
    sparge = Sparge(forgetful.request)
    message = sparge.call(EXPORT_KNOWLEDGE, Nothing())
    assert as_json.json()["turtle"] == message.turtle == plain
    assert sparge.call(IMPORT_KNOWLEDGE, KnowledgeImport(turtle=plain)).rules == ()


@pytest.mark.parametrize(
    ("content", "parameters", "status"),
    [
        (b"\xff\xfe", {}, 400),
        (b"nonsense", {}, 422),
        (b"", {"replace": "perhaps"}, 422),
    ],
)
def test_bad_turtle(
    forgetful: Client, content: bytes, parameters: dict[str, str], status: int
) -> None:
    response = forgetful.request(
        "POST", "/knowledge", content=content, headers=TURTLE, params=parameters
    )
    assert response.status_code == status


def test_sparql_as_the_w3c_has_it(backend: Client) -> None:
    query = "SELECT ?task { ?task <https://example.org/sparge#requiresAffordance> ?a } LIMIT 1"
    by_get = backend.request("GET", "/sparql", params={"query": query})
    assert by_get.headers["content-type"] == "application/sparql-results+json"
    by_post = backend.request(
        "POST", "/sparql", content=query, headers={"Content-Type": "application/sparql-query"}
    )
    assert by_get.json() == by_post.json()
    assert by_get.json()["head"] == {"vars": ["task"]}
    (row,) = by_get.json()["results"]["bindings"]
    assert row["task"]["type"] == "uri"
    asked = Sparge(backend.request).call(QUERY_KNOWLEDGE, SparqlQuery(query="ASK { ?s ?p ?o }"))
    assert asked.boolean
    assert backend.request("GET", "/sparql").status_code == 422


def test_questions(backend: Client) -> None:
    listed = backend.request("GET", "/ontology/questions").json()["questions"]
    assert {"missing", "why_held", "tasks_of_object"} <= {each["name"] for each in listed}
    answer = backend.request(
        "GET", "/ontology/questions/missing", params={"task": "hammering", "parts": "grasp"}
    ).json()
    (row,) = answer["answer"]["results"]["bindings"]
    assert row["affordance"]["value"].endswith("#pound")
    sparge = Sparge(backend.request)
    asked = AskQuestion(name="missing", task="hammering", parts="grasp")
    assert sparge.call(ASK_QUESTION, asked).answer.results is not None
    with pytest.raises(InvalidInput, match="takes task, parts"):
        sparge.call(ASK_QUESTION, AskQuestion(name="missing", task="hammering"))
