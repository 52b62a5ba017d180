"""Every command and every snippet of the README and of docs/ works, and prints what is shown.

What cannot be run here is listed in exceptions.toml, with the reason and where it is run.
A block that is neither run nor listed fails, and so does an exception that nothing needs.
Decision notes are records of their day and left out.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from shared.settings import PROJECT_ROOT
from tests.docs import exceptions, givens
from tests.docs.checkout import Checkout
from tests.docs.fences import OUTPUT, SHELL, Block, blocks, commands
from tests.docs.walk import Walk
from tests.support.serving import serving

PAGES = [
    *sorted(PROJECT_ROOT.glob("*.md")),
    *sorted((PROJECT_ROOT / "docs").glob("*.md")),
]
JSON_BODY = "-H 'Content-Type: application/json'"
NOTHING_LEARNED = "@prefix owl: <http://www.w3.org/2002/07/owl#> .\n"


@pytest.fixture(scope="module")
def port(tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    """Return the port of the one backend that all pages ask."""
    from services.wiring import create_app

    with pytest.MonkeyPatch.context() as environment:
        knowledge = str(tmp_path_factory.mktemp("knowledge"))
        environment.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", knowledge)
        environment.setenv("SPARGE_GATEWAY_QUEUE_WAIT_S", "300")
        environment.setenv("COLUMNS", "80")
        with serving(create_app()) as url:
            with httpx.Client(base_url=url, timeout=60) as http:
                while http.get("/health/ready").status_code != 200:
                    pass
            yield int(url.rsplit(":", 1)[1])


@pytest.fixture
def checkout(port: int, tmp_path: Path) -> Iterator[Checkout]:
    """Return a fresh checkout; what a page teaches is forgotten after it."""
    folder = tmp_path / "sparge"
    folder.mkdir()
    yield Checkout.make(folder, port)
    answer = httpx.post(
        f"http://127.0.0.1:{port}/knowledge?replace=true",
        content=NOTHING_LEARNED,
        headers={"Content-Type": "text/turtle"},
    )
    assert answer.status_code == 200, answer.text


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_page_does_what_it_says(page: Path, checkout: Checkout) -> None:
    given = givens.FOR.get(page.name)
    if given is not None:
        given(checkout.folder)
    walk = Walk(checkout, exceptions.read())
    if page.name in givens.NAMES:
        walk.names.update(givens.NAMES[page.name]())
    for block in blocks(page, PROJECT_ROOT):
        walk.follow(block)


def test_every_exception_is_needed() -> None:
    listed = exceptions.read()
    excused: Counter[str] = Counter()
    for each in (each for page in PAGES for each in blocks(page, PROJECT_ROOT)):
        is_output = listed.command_of_output(each.first_line) is not None
        is_text = not each.language and listed.is_text(each.first_line)
        if each.language in SHELL and each.title != OUTPUT and not (is_text or is_output):
            for command in commands(each):
                listed.is_not_run(command.typed)
                listed.command_for(command.typed)
        else:
            excused[each.first_line] += is_text or listed.is_not_run(each.first_line)
    assert sorted(listed.names() - listed.used) == []
    assert [line for line, times in excused.items() if times > 1] == []  # one line, one block


def block(text: str, language: str = "", title: str = "") -> Block:
    return Block("a.md", 1, language, title, text)


@pytest.mark.parametrize(
    "wrong",
    [
        block("false\n", "sh"),
        block("nobody-has-this-command\n"),
        block("$ echo one two\none three\n", "console"),
        block("$ echo 10 # fails\n10\n", "console"),
        block("assert 1 > 2\n", "python"),
        block('{"name": 3}\n', "json"),
        block("sparge grasp FILE\n", "text"),
        block("fn main() {}\n", "rust"),
        block("sparge task add juggling --grasp no_such_affordance\n", "sh"),
        block("curl http://127.0.0.1:8000/nowhere\n", "sh"),
        block("another output\n", "text", "output"),
        block("apt-get install cowsay\n", "sh"),
        block("docker compose down --volumes\n", "sh"),
    ],
    ids=lambda each: each.first_line,
)
def test_what_does_not_work_is_seen(wrong: Block, checkout: Checkout) -> None:
    walk = Walk(checkout, exceptions.read(), printed="output\n")
    with pytest.raises(AssertionError):
        walk.follow(wrong)


def test_what_works_passes(checkout: Checkout) -> None:
    walk = Walk(checkout, exceptions.read())
    for each in (
        block("$ echo 10 and more # a comment\n11 ...\n$ false # fails\n", "console"),
        block("number = 3\nprint(number, 'ms')\n", "python"),
        block("4 ms\n", "text", "output"),
        block("assert number == 3\n", "python"),
        block('{"name": "juggling", "requires": [], "grasp": ["grasp"]}\n', "json", "a/task.json"),
        block(f"curl http://127.0.0.1:8000/tasks -d @a/task.json \\\n {JSON_BODY}\n"),
        block("sparge task delete juggling\n"),
        block("export NAME=world\necho hello $NAME\n", "sh"),
        block("hello world\n", "text", "output"),
        block("for each in a b; do\n  echo $each\ndone\n", "sh"),
    ):
        walk.follow(each)
    assert len(walk.done) == 10
