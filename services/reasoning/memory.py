"""What was learned, held in step with the disk, with other processes and with Prolog."""

from __future__ import annotations

import contextlib
import itertools
import logging
import threading
from collections.abc import Iterator

from services.reasoning.admission import Admission
from services.reasoning.change import Change, Learned
from services.reasoning.journal import Journal
from services.reasoning.ontology import triples_of
from services.reasoning.prolog import Prolog
from services.reasoning.rule_terms import rule_for_prolog
from services.reasoning.settings import ReasoningSettings
from shared.errors import InternalError, JsonObject, NotStored, SpargeError, StageUnavailable

log = logging.getLogger("sparge")

_numbers = itertools.count()
_REWRITE_AFTER = 1000
"""The journal is written anew when it has so many records, and four times the things known."""


class Memory:
    """What was learned; one object per process and knowledge folder.

    Prolog is told of a change when it happens, not with every request, and only
    of what changed. Other processes that share the folder see a change with
    their next request, and this one theirs.

    Parameters
    ----------
    settings : ReasoningSettings
        Where it is kept.
    prolog : Prolog
    admission : Admission

    Attributes
    ----------
    name : str
        Of the knowledge base in Prolog.
    lock : threading.RLock
        Held by whoever reads or changes `learned`.
    learned : Learned
        After `refresh`.
    version : int
        Another one after every change.

    Raises
    ------
    InternalError
        What was stored is damaged, or does not fit the shipped knowledge.
    StageUnavailable
        It cannot be read.
    """

    def __init__(self, settings: ReasoningSettings, prolog: Prolog, admission: Admission) -> None:
        self.name = f"knowledge_{next(_numbers)}"
        self.lock = threading.RLock()
        self.learned = Learned()
        self.version = 0
        self._prolog = prolog
        self._admission = admission
        self._journal = Journal(settings.knowledge_dir)
        self._tell_everything()
        self._take_news()

    def close(self) -> None:
        """Let Prolog forget it."""
        with self.lock:
            self._journal.close()
            self._tell(Change(clear=True))

    def refresh(self) -> None:
        """Take over what other processes changed; costs one `stat` when there is nothing.

        Where the disk cannot be read, what is known stays as it is.

        Raises
        ------
        InternalError
            The stored knowledge is damaged.
        """
        with self.lock:
            try:
                self._take_news()
            except StageUnavailable as error:
                log.warning("%s; going on with what was read before", error.message)

    def _take_news(self) -> None:
        with self.lock:
            news = self._journal.news()
            for change in news:
                self.learned.apply(change)
            if any(change.clear for change in news):
                self._check_stored()
                self._tell_everything()
            else:
                for change in news:
                    self._tell(change)

    def change(self, wanted: Change) -> Change:
        """Admit, store and tell a change; return it as it was admitted.

        Raises
        ------
        Conflict, InvalidInput, NotFound
            It does not fit what is known; nothing of it is taken.
        NotStored
            It cannot be stored.
        StageUnavailable
            What is stored cannot be read.
        TooBusy
            Another process is writing for seconds.
        """
        with self.lock:
            self._take_news()
            self._admission.admit(wanted, self.learned)
        # Waiting for another process is done without the lock: deciding goes on.
        with self._journal.writing(), self.lock:
            self._take_news()
            admitted = self._admission.admit(wanted, self.learned)
            if self._journal.needs_rewrite():
                self._journal.rewrite(self.learned.snapshot())
            self._journal.append(admitted)
            self.learned.apply(admitted)
            if admitted.clear:
                self._tell_everything()
            else:
                self._tell(admitted)
            if self._journal.records > max(_REWRITE_AFTER, 4 * len(self.learned)):
                # The change is stored; that there is no room to tidy up does not undo it.
                with contextlib.suppress(NotStored):
                    self._journal.rewrite(self.learned.snapshot())
        return admitted

    @contextlib.contextmanager
    def reading(self) -> Iterator[Learned]:
        """Give what was learned, as it is now, while nobody changes it."""
        with self.lock:
            self.refresh()
            yield self.learned

    def clauses(self, *names: str) -> JsonObject:
        """Return learned rules as Prolog text, by name; all of them when none is named."""
        with self.lock:
            return self._prolog.ask("clauses", knowledge=self.name, names=names)

    def _check_stored(self) -> None:
        """Check what was stored before; it may not fit what is shipped today."""
        try:
            self._admission.admit(self.learned.snapshot(), Learned())
        except SpargeError as error:
            raise InternalError(f"the stored knowledge is not usable: {error.message}") from error

    def _tell_everything(self) -> None:
        stored = self.learned.snapshot()
        shipped = self._admission.shipped.tasks.values()
        self._tell(stored.model_copy(update={"tasks": (*shipped, *stored.tasks)}))

    def _tell(self, change: Change) -> None:
        """Let Prolog know a change."""
        self.version += 1
        self._prolog.ask(
            "change",
            knowledge=self.name,
            clear=change.clear,
            subjects=change.forget_tasks,
            names=change.forget_rules,
            triples=triples_of(change.tasks),
            rules=[rule_for_prolog(rule) for rule in change.rules],
        )
