"""SPARQL: answered, bounded, read only; and the questions that the ontology is made for."""

from __future__ import annotations

import itertools
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from services.reasoning.ontology import SPARGE
from services.reasoning.questions import OBJECTS, Questions
from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.errors import DeadlineExceeded, InternalError, InvalidInput, NotFound
from shared.schemas.knowledge import AskQuestion, SparqlAnswer, SparqlQuery
from shared.schemas.route import Nothing
from shared.schemas.task import DecideRequest, TaskDefinition, TaskName
from shared.settings import PROJECT_ROOT
from tests.services.reasoning.objects import BOTTLE, HAMMER, KNIFE, LADLE, PAN, TURNER
from tests.services.reasoning.test_taught_rules import affordance, rule

PREFIX = f"PREFIX : <{SPARGE}>\n"
SERVICE = "SERVICE <http://127.0.0.1:1/> { ?s ?p ?o }"


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Reasoner]:
    settings = ReasoningSettings(
        knowledge_dir=tmp_path_factory.mktemp("knowledge"), sparql_timeout_s=5, max_rows=50
    )
    reasoner = Reasoner(settings)
    reasoner.warm_up()
    yield reasoner
    reasoner.close()


def rows(answer: SparqlAnswer) -> list[tuple[str, ...]]:
    """Return the rows as local names and texts."""
    assert answer.results is not None
    return [
        tuple(
            row[name].value.removeprefix(str(SPARGE)).removeprefix(str(OBJECTS))
            for name in answer.head.vars
            if name in row
        )
        for row in answer.results.bindings
    ]


def query(reasoner: Reasoner, text: str) -> SparqlAnswer:
    return reasoner.query_knowledge(SparqlQuery(query=PREFIX + text))


def question(reasoner: Reasoner, name: str, **parameters: str) -> list[tuple[str, ...]]:
    return rows(reasoner.ask_question(AskQuestion(name=name, **parameters)).answer)


def test_select_and_ask(asked: Reasoner) -> None:
    answer = query(
        asked, "SELECT ?t ?l { ?t :requiresAffordance :contain ; rdfs:label ?l } ORDER BY ?t"
    )
    assert answer.head.vars == ("t", "l")
    assert rows(answer) == [("cooking", "cooking"), ("pouring", "pouring")]
    assert answer.results is not None
    assert answer.results.bindings[0]["t"].type == "uri"
    assert answer.results.bindings[0]["l"].type == "literal"
    assert query(asked, "ASK { :pouring a :Task }").boolean is True
    assert query(asked, "ASK { :juggling a :Task }").boolean is False


def test_a_change_is_in_the_next_answer(asked: Reasoner) -> None:
    ask = "ASK { :stirring :hasGraspAffordance :grasp }"
    assert query(asked, ask).boolean is False
    asked.add_task(TaskDefinition(name="stirring", grasp=("grasp",)))
    assert query(asked, ask).boolean is True
    asked.delete_task(TaskName(name="stirring"))
    assert query(asked, ask).boolean is False


def test_many_rows_are_cut_off_and_the_answer_says_so(asked: Reasoner) -> None:
    answer = query(asked, "SELECT ?s { ?s ?p ?o }")
    assert len(rows(answer)) == 50
    assert answer.truncated
    assert not query(asked, "SELECT ?s { ?s ?p ?o } LIMIT 50").truncated


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("SELECT", "not a SPARQL query"),
        ("INSERT DATA { :x a :Task }", "not a SPARQL query"),
        ("DELETE WHERE { ?s ?p ?o }", "not a SPARQL query"),
        ("LOAD <file:///etc/passwd>", "not a SPARQL query"),
        ("CONSTRUCT { ?s ?p ?o } WHERE { ?s ?p ?o }", "only SELECT and ASK"),
        ("DESCRIBE :pouring", "only SELECT and ASK"),
        ("SELECT * FROM <file:///etc/passwd> { ?s ?p ?o }", "FROM"),
        ("SELECT * FROM NAMED <http://127.0.0.1:1/> { ?s ?p ?o }", "FROM"),
        (f"SELECT * {{ {SERVICE} }}", "SERVICE"),
        ("SELECT * { SERVICE ?s { ?s ?p ?o } }", "SERVICE"),
        (
            f"SELECT * {{ ?s ?p ?o FILTER EXISTS {{ {SERVICE} }} }}",
            "SERVICE",
        ),
        (f"SELECT * {{ {{ SELECT * {{ {SERVICE} }} }} }}", "SERVICE"),
        (
            f"ASK {{ ?s ?p ?o OPTIONAL {{ {SERVICE} }} }}",
            "SERVICE",
        ),
        ("SELECT * { GRAPH <file:///etc/passwd> { ?s ?p ?o } }", "dataset"),
    ],
)
def test_nothing_is_written_and_nothing_fetched(asked: Reasoner, text: str, said: str) -> None:
    with pytest.raises(InvalidInput, match=said) as caught:
        query(asked, text)
    assert caught.value.details["field"] == "query"
    assert query(asked, "ASK { :pouring a :Task }").boolean is True


@pytest.fixture
def hasty(settings: ReasoningSettings) -> Iterator[Reasoner]:
    reasoner = Reasoner(settings.model_copy(update={"sparql_timeout_s": 0.5}))
    reasoner.warm_up()
    yield reasoner
    reasoner.close()


ENDLESS = (
    "SELECT (COUNT(*) AS ?n) { ?a ?p ?b . ?c ?q ?d . ?e ?r ?f . ?g ?s ?h }",
    'ASK { BIND(REPLACE("aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa!", "^(a+)+$", "") AS ?x) }',
)


@pytest.mark.parametrize("text", ENDLESS)
def test_a_query_that_takes_too_long_is_ended(hasty: Reasoner, text: str) -> None:
    begin = time.monotonic()
    with pytest.raises(DeadlineExceeded, match=r"0\.5 s"):
        query(hasty, text)
    assert time.monotonic() - begin < 10
    assert query(hasty, "ASK { :pouring a :Task }").boolean is True


def test_deciding_goes_on_while_a_query_runs(hasty: Reasoner) -> None:
    query(hasty, "ASK { :pouring a :Task }")
    with ThreadPoolExecutor(1) as pool:
        running = pool.submit(query, hasty, ENDLESS[0])
        begin = time.perf_counter()
        assert hasty.decide(DecideRequest(task="cooking", primitives=PAN)).found
        assert time.perf_counter() - begin < 0.4
        with pytest.raises(DeadlineExceeded):
            running.result()


def test_a_process_that_is_killed_is_started_again(asked: Reasoner) -> None:
    assert query(asked, "ASK { :pouring a :Task }").boolean is True
    process = asked._warm().enquiry._sparql._process
    assert process is not None
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert query(asked, "ASK { :pouring a :Task }").boolean is True


def test_a_process_whose_asker_is_gone_ends_by_itself() -> None:
    worker = subprocess.Popen(
        [sys.executable, "-m", "services.reasoning.sparql_worker"],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        cwd=PROJECT_ROOT,
    )
    asked = {"limit_s": 0, "graph": "", "query": ENDLESS[1], "facts": "", "bindings": {}}
    assert worker.stdin is not None
    worker.stdin.write(json.dumps({**asked, "max_rows": 1}).encode() + b"\n")
    worker.stdin.close()
    assert worker.wait(timeout=30) == -signal.SIGALRM


def test_closing_ends_the_process(settings: ReasoningSettings) -> None:
    reasoner = Reasoner(settings)
    query(reasoner, "ASK { ?s ?p ?o }")
    process = reasoner._warm().enquiry._sparql._process
    assert process is not None
    reasoner.close()
    assert process.poll() is not None


def test_every_question_has_an_answer_here(asked: Reasoner) -> None:
    """Each is asked below with an expected answer."""
    assert {each.name for each in asked.list_questions(Nothing()).questions} == {
        "missing",
        "relations_of_task",
        "taught_rules",
        "tasks_of_object",
        "tasks_with_affordance",
        "unused_affordances",
        "why_held",
    }


def test_what_is_missing_for_hammering(asked: Reasoner) -> None:
    assert question(asked, "missing", task="hammering", parts="contain,wrap_grasp;grasp") == [
        ("pound", "Striking other objects with a solid part.")
    ]
    assert question(asked, "missing", task="hammering", parts="pound;grasp") == []
    assert [row[0] for row in question(asked, "missing", task="cutting", parts="")] == [
        "cut",
        "grasp",
    ]


def test_why_can_this_part_be_held_for_pouring(asked: Reasoner) -> None:
    found = question(asked, "why_held", task="pouring", parts="contain,wrap_grasp;grasp;support")
    assert [row[:2] for row in found] == [("part_0", "wrap_grasp"), ("part_1", "grasp")]
    assert "Wrapping by hand for holding." in found[0]
    assert question(asked, "why_held", task="cutting", parts="cut,grasp;grasp")[0][0] == "part_1"


def test_which_tasks_can_this_object_do(asked: Reasoner) -> None:
    pan = question(asked, "tasks_of_object", parts="contain,wrap_grasp;grasp")
    assert {("cooking",), ("pouring",)} <= set(pan)
    assert ("hammering",) not in pan
    blade = question(asked, "tasks_of_object", parts="cut,grasp")
    assert ("cutting",) not in blade, "the only part to hold is the blade"


def test_tasks_of_an_object_are_those_that_version_2_finds(asked: Reasoner) -> None:
    """The ontology and the thesis's rules agree on every object that we have."""
    tasks = [task.name for task in asked.list_tasks(Nothing()).tasks]
    for primitives in (PAN, BOTTLE, HAMMER, LADLE, TURNER, KNIFE, BOTTLE[:1], KNIFE[:1]):
        decisions = {
            task: asked.decide(DecideRequest(task=task, primitives=primitives, rule_set="thesis"))
            for task in tasks
        }
        labels = next(iter(decisions.values())).labels
        parts = ";".join(",".join(labels[number]) for number in sorted(labels))
        found = {(task,) for task, decision in decisions.items() if decision.found}
        assert set(question(asked, "tasks_of_object", parts=parts)) == found


def test_relations(asked: Reasoner) -> None:
    found = question(asked, "relations_of_task", task="cutting")
    assert [row[:2] for row in found] == [
        ("avoidsAffordance", "cut"),
        ("hasGraspAffordance", "grasp"),
        ("requiresAffordance", "cut"),
        ("requiresAffordance", "grasp"),
    ]
    assert question(asked, "tasks_with_affordance", affordance="pound") == [
        ("hammering", "requiresAffordance")
    ]


def test_what_was_taught(asked: Reasoner) -> None:
    assert question(asked, "taught_rules") == []
    asked.add_affordance(affordance("press"))
    asked.add_rule(rule())
    found = [(row[0].rsplit("#", 1)[-1], *row[1:]) for row in question(asked, "taught_rules")]
    assert found == [("press_rule", "press", "1"), ("slicing_by_handle", "slicing", "5")]
    assert question(asked, "unused_affordances") == [("press",)]


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        ({"name": "missing", "task": "hammering"}, "takes task, parts; found task"),
        ({"name": "unused_affordances", "task": "hammering"}, "takes none"),
        ({"name": "missing", "task": "juggling", "parts": ""}, "no task 'juggling'"),
        ({"name": "tasks_with_affordance", "affordance": "fly"}, "no affordance 'fly'"),
        ({"name": "tasks_of_object", "parts": "grasp;fly"}, "no affordance 'fly'"),
        ({"name": "tasks_of_object", "parts": ";" * 64}, "64 are allowed"),
    ],
)
def test_bad_parameters(asked: Reasoner, parameters: dict[str, str], said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        asked.ask_question(AskQuestion.model_validate(parameters))


def test_no_such_question(asked: Reasoner) -> None:
    with pytest.raises(NotFound, match="tasks_of_object"):
        asked.ask_question(AskQuestion(name="why"))


@pytest.mark.parametrize(
    ("text", "said"),
    [("SELECT * { ?s ?p ?o }", "begin"), ("# Why?\n# parameters: colour\nASK {}", "colour")],
)
def test_a_question_says_what_it_is(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "why.rq").write_text(text)
    with pytest.raises(InternalError, match=said):
        Questions(tmp_path)


def test_questions_are_fast(asked: Reasoner) -> None:
    question(asked, "tasks_of_object", parts="grasp")
    taken = []
    for parts in itertools.chain.from_iterable([("grasp", "contain;grasp", "cut,grasp;grasp")] * 3):
        begin = time.perf_counter()
        question(asked, "tasks_of_object", parts=parts)
        taken.append(time.perf_counter() - begin)
    assert sorted(taken)[len(taken) // 2] < 0.5
