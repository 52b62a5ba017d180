"""The process that answers SPARQL: started by sparql.py, ended when it takes too long.

It reads one JSON object per line and writes one: a graph in N-Triples when it
is a new one, a query with the values of some variables, and statements that
hold for this query alone. Only SELECT and ASK are answered, nothing is written
and nothing is fetched: SERVICE and FROM are refused, and the process cannot
open a socket. Its memory is bounded.

A process of its own, for a query cannot be interrupted within one.
"""

from __future__ import annotations

import json
import resource
import signal
import socket
import sys
from collections.abc import Iterator
from itertools import islice
from typing import Any

from rdflib import Graph, URIRef
from rdflib.plugins.sparql import prepareQuery
from rdflib.plugins.sparql.algebra import traverse
from rdflib.plugins.sparql.parserutils import CompValue
from rdflib.plugins.sparql.sparql import Query
from rdflib.query import Result
from rdflib.term import BNode, Node

_MAX_MEMORY = 2 * 2**30
_GRACE_S = 1.0
_ANSWERED = ("SelectQuery", "AskQuery")


class Refused(Exception):
    """A query that is not answered here."""


def main() -> None:
    """Answer until the input ends."""
    resource.setrlimit(resource.RLIMIT_AS, (_MAX_MEMORY, _MAX_MEMORY))
    socket.socket = _NoSocket  # type: ignore[misc, assignment]
    _write("ready")
    graph = Graph()
    for line in sys.stdin:
        asked = json.loads(line)
        # The asker ends this process when time is up; should the asker be gone, this does.
        signal.setitimer(signal.ITIMER_REAL, asked["limit_s"] + _GRACE_S)
        if asked["graph"] is not None:
            graph = Graph().parse(data=asked["graph"], format="nt")
        _write(json.dumps(_reply(graph, asked)))
        signal.setitimer(signal.ITIMER_REAL, 0)


def _write(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


class _NoSocket:
    def __init__(self, *_: object, **__: object) -> None:
        raise OSError("this process opens no sockets")


def _reply(graph: Graph, asked: dict[str, Any]) -> dict[str, Any]:
    facts = Graph().parse(data=asked["facts"], format="nt")
    try:
        query = prepared(asked["query"])
        graph += facts
        bindings = {name: URIRef(iri) for name, iri in asked["bindings"].items()}
        return {"answer": answer_of(graph.query(query, initBindings=bindings), asked["max_rows"])}
    except Refused as error:
        return {"refused": str(error)}
    except MemoryError:
        return {"refused": "the query takes too much memory"}
    except Exception as error:  # rdflib has no common error class
        return {"refused": " ".join(f"{type(error).__name__}: {error}".split())[:500]}
    finally:
        graph -= facts


def prepared(text: str) -> Query:
    """Return a query that may be asked.

    Raises
    ------
    Refused
        It is no SPARQL, or more than a question to this graph.
    """
    try:
        query = prepareQuery(text)
    except Exception as error:
        raise Refused(f"not a SPARQL query: {' '.join(str(error).split())[:300]}") from None
    if query.algebra.name not in _ANSWERED:
        raise Refused("only SELECT and ASK are answered")
    traverse(query.algebra, visitPre=_check)
    return query


def _check(node: Any) -> None:
    if isinstance(node, CompValue):
        if node.name == "ServiceGraphPattern":
            raise Refused("SERVICE is not followed")
        if dict.get(node, "datasetClause"):
            raise Refused("FROM is not followed")


def answer_of(result: Result, max_rows: int) -> dict[str, Any]:
    """Return a result as the message SparqlAnswer."""
    if result.type == "ASK":
        return {"boolean": bool(result.askAnswer)}
    names = [str(name) for name in result.vars or ()]
    rows = list(islice(_rows(result, names), max_rows + 1))
    return {
        "head": {"vars": names},
        "results": {"bindings": rows[:max_rows]},
        "truncated": len(rows) > max_rows,
    }


def _rows(result: Result, names: list[str]) -> Iterator[dict[str, Any]]:
    for row in result:
        values = zip(names, row, strict=True)  # type: ignore[arg-type]  # a row is a tuple
        yield {name: _term(value) for name, value in values if value is not None}


def _term(value: Node) -> dict[str, str]:
    kind = (
        "uri" if isinstance(value, URIRef) else "bnode" if isinstance(value, BNode) else "literal"
    )
    return {"type": kind, "value": str(value)}


if __name__ == "__main__":
    main()
