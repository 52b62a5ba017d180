"""The driver: reads files, hands out questions, settles each of them once."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from services.annotate.inputs import name_of, read_input
from services.annotate.pool import WorkerPool
from services.annotate.question import Job, Question, Refusal, Terms

if TYPE_CHECKING:
    from services.annotate.book import Book, Settled

MAX_ATTEMPTS = 3
"""How often a file is asked about when workers die on it, or fail for reasons of their own."""

Progress = Callable[[int], None]
"""Called with how many questions are settled."""


@dataclass
class Summary:
    """How many questions were settled, and how.

    Attributes
    ----------
    annotated, annotated_before : int
        Rows of this run, and of earlier ones that still hold.
    rejected, rejected_before : Counter
        The same for rejects, by code.
    """

    annotated: int = 0
    annotated_before: int = 0
    rejected: Counter[str] = field(default_factory=Counter)
    rejected_before: int = 0

    @property
    def settled(self) -> int:
        return self.annotated + self.annotated_before + self.rejected.total() + self.rejected_before


@dataclass
class Driver:
    """One run over a folder.

    Attributes
    ----------
    folder : Path
        Of the inputs.
    question : Question
    terms : Terms
        What the answers depend on beside file and task.
    book : Book
        Where they go.
    max_file_bytes : int
        A larger file is rejected before it is read whole.
    retry_rejects : bool
        Ask again about what was rejected before.
    progress : callable
    """

    folder: Path
    question: Question
    terms: Terms
    book: Book
    max_file_bytes: int
    retry_rejects: bool = False
    progress: Progress = lambda _: None
    summary: Summary = field(default_factory=Summary)

    def run(self, paths: Sequence[Path], pool: WorkerPool) -> Summary:
        """Settle every question about these files; return how.

        No more files are in memory than there are workers, one that is next and those
        that are asked about again.
        """
        attempts: Counter[tuple[str, str]] = Counter()
        again: deque[Job] = deque()
        new = self._jobs(paths)

        def next_job() -> Job | None:
            return again.popleft() if again else next(new, None)

        under_way = 0
        job = next_job()
        while job is not None or under_way:
            while job is not None and pool.idle:
                attempts[job.key] += 1
                pool.give(job)
                under_way += 1
                job = next_job()
            for done, outcome in pool.take():
                under_way -= 1
                if not isinstance(outcome, Refusal):
                    self.book.annotate(done, outcome)
                    self.summary.annotated += 1
                elif outcome.passing and attempts[done.key] < MAX_ATTEMPTS:
                    again.append(done)
                    continue
                else:
                    self._reject(done.key, done.sha256, outcome, attempts[done.key])
                del attempts[done.key]
            job = job or next_job()
            self.progress(self.summary.settled)
        return self.summary

    def _jobs(self, paths: Sequence[Path]) -> Iterator[Job]:
        """Yield what is open, reading one file at a time; settle what need not be asked."""
        for path in paths:
            name = name_of(path, self.folder)
            read = read_input(path, self.max_file_bytes)
            for task in self.question.tasks:
                if isinstance(read, Refusal):
                    self._reject((name, task), None, read, 0)
                    continue
                earlier = self.book.earlier((name, task))
                if earlier is None or not self._holds(earlier, read.sha256):
                    yield Job(name, task, read.sha256, read.data)
                elif earlier.rejected:
                    self.summary.rejected_before += 1
                else:
                    self.summary.annotated_before += 1
            self.progress(self.summary.settled)

    def _holds(self, earlier: Settled, sha256: str) -> bool:
        """Whether what an earlier run settled need not be asked again."""
        same = (earlier.sha256, earlier.terms) == (sha256, self.terms)
        return same and not (earlier.rejected and self.retry_rejects)

    def _reject(
        self, key: tuple[str, str], sha256: str | None, refusal: Refusal, attempts: int
    ) -> None:
        self.book.reject(key, sha256, refusal, attempts, self.terms)
        self.summary.rejected[refusal.code] += 1
