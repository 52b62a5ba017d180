"""Rules <-> statements in the vocabulary of ontology/rules.ttl."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal

from pydantic import ValidationError
from rdflib import OWL, RDF, RDFS, XSD, Graph, Literal, Namespace
from rdflib.term import Node

from services.reasoning.ontology import SPARGE
from shared.errors import InvalidInput
from shared.schemas.rule import RuleCondition, RuleDefinition
from shared.wire.codec import invalid

RULES = Namespace("https://example.org/sparge/rules#")
_LENGTHS = (SPARGE.thickness, SPARGE.width, SPARGE.length)
_OF = (SPARGE.ofPart, SPARGE.comparedWith)


def add_rule(graph: Graph, rule: RuleDefinition, affordance_words: frozenset[str]) -> None:
    """Add the statements about one rule.

    Parameters
    ----------
    graph : Graph
    rule : RuleDefinition
    affordance_words : frozenset of str
        The words of the vocabulary whose value is an affordance.
    """
    subject = RULES[rule.name]
    graph.add((subject, RDF.type, OWL.NamedIndividual))
    graph.add((subject, RDF.type, SPARGE.Rule))
    graph.add((subject, RDFS.label, Literal(rule.name.replace("_", " "))))
    if rule.description:
        graph.add((subject, RDFS.comment, Literal(rule.description)))
    if rule.task is not None:
        graph.add((subject, SPARGE.ruleForTask, SPARGE[rule.task]))
    if rule.affordance is not None:
        graph.add((subject, SPARGE.ruleForAffordance, SPARGE[rule.affordance]))
    graph.add((subject, SPARGE.heldPart, Literal(rule.part, datatype=XSD.string)))
    for number, condition in enumerate(rule.conditions):
        part = RULES[f"{rule.name}.{number}"]
        graph.add((subject, SPARGE.hasCondition, part))
        graph.add((part, RDF.type, OWL.NamedIndividual))
        graph.add((part, RDF.type, SPARGE.Condition))
        graph.add((part, SPARGE.position, Literal(number)))
        graph.add((part, SPARGE.word, Literal(condition.condition, datatype=XSD.string)))
        for property_, name in zip(_OF, condition.of, strict=False):
            graph.add((part, property_, Literal(name, datatype=XSD.string)))
        for bound, value in _value(condition, affordance_words):
            graph.add((part, bound, value))


def rules_in(graph: Graph) -> dict[str, RuleDefinition]:
    """Return the rules by name.

    Raises
    ------
    InvalidInput
        Statements that make no rule; names it.
    """
    found = {}
    for subject in sorted(graph.subjects(RDF.type, SPARGE.Rule), key=str):
        rule = _rule(graph, subject)
        found[rule.name] = rule
    return found


def _value(
    condition: RuleCondition, affordance_words: frozenset[str]
) -> Iterator[tuple[Node, Node]]:
    value = condition.value
    values = value if isinstance(value, tuple) else () if value is None else (value,)
    is_lengths = isinstance(value, tuple) and any(isinstance(each, float) for each in value)
    for number, each in enumerate(values):
        if isinstance(each, float):
            property_ = _LENGTHS[number] if is_lengths else SPARGE.number
            yield property_, Literal(f"{Decimal(repr(each)):f}", datatype=XSD.decimal)
        elif condition.condition in affordance_words:
            yield SPARGE.asksForAffordance, SPARGE[each]
        else:
            yield SPARGE.shapeClass, Literal(each, datatype=XSD.string)


def _rule(graph: Graph, subject: Node) -> RuleDefinition:
    name = str(subject).removeprefix(str(RULES))
    parts = sorted(
        graph.objects(subject, SPARGE.hasCondition),
        key=lambda part: (_number(graph.value(part, SPARGE.position)), str(part)),
    )
    fields = {
        "name": name,
        "description": str(graph.value(subject, RDFS.comment) or ""),
        "task": _local(graph.value(subject, SPARGE.ruleForTask)),
        "affordance": _local(graph.value(subject, SPARGE.ruleForAffordance)),
        "part": str(graph.value(subject, SPARGE.heldPart) or ""),
        "conditions": [_condition(graph, part) for part in parts],
    }
    try:
        return RuleDefinition.model_validate(fields)
    except ValidationError as error:
        reason = invalid(error)
        raise InvalidInput(
            f"the statements about {subject} make no rule: {reason.message}", found=str(subject)
        ) from None


def _condition(graph: Graph, part: Node) -> dict[str, object]:
    of = [str(name) for each in _OF if (name := graph.value(part, each)) is not None]
    fields: dict[str, object] = {"condition": str(graph.value(part, SPARGE.word) or ""), "of": of}
    lengths = [graph.value(part, each) for each in _LENGTHS]
    classes = sorted(str(each) for each in graph.objects(part, SPARGE.shapeClass))
    if (number := graph.value(part, SPARGE.number)) is not None:
        fields["value"] = _number(number)
    elif any(each is not None for each in lengths):
        fields["value"] = [_number(each) for each in lengths]
    elif (affordance := graph.value(part, SPARGE.asksForAffordance)) is not None:
        fields["value"] = _local(affordance)
    elif classes:
        fields["value"] = classes
    return fields


def _number(node: Node | None) -> float:
    try:
        return float(str(node))
    except ValueError:
        return float("nan")


def _local(node: Node | None) -> str | None:
    return None if node is None else str(node).removeprefix(str(SPARGE))
