"""One open page: what it asks, and what it shows."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass

import viser

from services.viewer.controls import Controls
from services.viewer.disturbance import Disturbance
from services.viewer.drawing import Shown, Stage, draw_answer
from services.viewer.drawing.rejected import draw_rejected, legend
from services.viewer.newest import Newest
from services.viewer.replay import replay
from services.viewer.sources import Seen, Sources
from services.viewer.words import (
    answer_in_words,
    error_in_words,
    execution_in_words,
    rejected_in_words,
)
from shared.client import GraspResult, Sparge
from shared.errors import SpargeError
from shared.schemas.answer import RejectedGrasp
from shared.schemas.gripper import Gripper

REJECTED = 60
"""How many hands that were left out are shown."""

log = logging.getLogger("sparge")

StillNewest = Callable[[], bool]


@dataclass(frozen=True)
class Asked:
    """What the controls said when a question was asked."""

    source: str
    task: str
    reasoning: str
    gripper: str
    disturbance: Disturbance
    with_rejected: bool
    rehearsed: bool


@dataclass(frozen=True)
class Known:
    """The answer on the page, and what it is about."""

    asked: Asked
    seen: Seen
    result: GraspResult


class Session:
    """The state of one page; every page has its own.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser.
    sparge : Sparge
        The backend, asked through its public interface alone.
    sources : Sources
        What can be looked at; this page's own, uploads are added.
    """

    def __init__(self, client: viser.ClientHandle, sparge: Sparge, sources: Sources) -> None:
        self._client, self._sparge, self._sources = client, sparge, sources
        self._drawing = threading.RLock()
        """What is drawn is changed by work and by switches, in different threads."""
        self._newest = Newest()
        self._known: Known | None = None
        self._before: tuple[str, Seen, GraspResult] | None = None
        """The undisturbed view of a source with its answer: where the object is."""
        self._shown: Shown | None = None
        self._grippers: dict[str, Gripper] = {}
        self.controls = Controls(client.gui, list(sources))
        self.controls.listen(self.ask, self._redraw, self._try_out, self._upload, self._teach)
        self._newest.submit(lambda _: self._start())

    def close(self) -> None:
        """Stop working for a page that is gone."""
        self._newest.close()

    def ask(self) -> None:
        """Ask what the controls say, and show the answer when it is there."""
        asked = self._asked()
        if asked is not None:
            self._newest.submit(lambda is_newest: self._answer(asked, is_newest))

    def _start(self) -> None:
        """Learn what the backend knows; the page says what is wrong where it does not answer."""
        if self._careful(self._learn):
            self.ask()

    def _learn(self) -> None:
        self.controls.say("reaching the backend …")
        tasks = [each.name for each in self._sparge.tasks()]
        labels = [each.name for each in self._sparge.affordances()]
        self._grippers = {each.name: each for each in self._sparge.grippers()}
        self.controls.offer(tasks, list(self._grippers), labels)

    def _asked(self) -> Asked | None:
        said = self.controls
        if not said.task:
            return None
        return Asked(
            said.source,
            said.task,
            said.reasoning,
            said.gripper,
            Disturbance(said.noise_mm, said.hidden),
            said.shows_rejected,
            said.rehearses,
        )

    def _answer(self, asked: Asked, is_newest: StillNewest) -> None:
        def work() -> None:
            if not is_newest():
                return
            self.controls.say("asking …")
            seen, result = self._seen_and_answered(asked)
            if is_newest():
                moved = self._known is None or self._known.asked.source != asked.source
                self._known = Known(asked, seen, result)
                self._show(moves_eye=moved)

        if not self._careful(work) and is_newest():
            self._forget()

    def _forget(self) -> None:
        """Show no answer: the one before is not that to the question on the page."""
        with self._drawing:
            self._known = self._shown = None
            self._client.scene.remove_by_name("/answer")
        self.controls.offer_ranks(0)
        self.controls.list_reasons("")
        self.controls.tell("")

    def _seen_and_answered(self, asked: Asked) -> tuple[Seen, GraspResult]:
        plain = asked.disturbance == Disturbance()
        if plain or self._before is None or self._before[0] != asked.source:
            seen = self._sources[asked.source]()
            result = self._grasp(seen, asked)
            self._before = (asked.source, seen, result)
            if plain:
                return seen, result
        _, whole, before = self._before
        on_object = before.point_primitive >= 0
        seen = asked.disturbance.of(whole, on_object, before.answer.scene.up)
        return seen, self._grasp(seen, asked)

    def _grasp(self, seen: Seen, asked: Asked) -> GraspResult:
        return self._sparge.grasp(
            seen.arrays(),
            asked.task,
            reasoning=asked.reasoning,  # type: ignore[arg-type]
            gripper=asked.gripper,
            viewpoint=seen.viewpoint,
            rejected=REJECTED if asked.with_rejected else 0,
            rehearsal="auto" if asked.rehearsed else None,
        )

    def _show(self, *, moves_eye: bool) -> None:
        known = self._known
        if known is None:
            return
        result, gripper = known.result, self._grippers.get(known.asked.gripper)
        self.controls.offer_ranks(len(result.grasps))
        with self._drawing, self._client.atomic():
            self._shown = draw_answer(
                self._client.scene,
                result,
                known.seen.points,
                gripper,
                viewpoint=known.seen.viewpoint,
                best=self.controls.rank,
            )
            if gripper is not None and known.asked.with_rejected:
                draw_rejected(self._client.scene, result.answer.rejected, gripper, self._tell_why)
            self._redraw()
        if moves_eye:
            self._look_at(self._shown.stage)
        self.controls.list_reasons(legend(result.answer.rejected))
        self.controls.tell(answer_in_words(result.answer))
        self.controls.say(_counted(known))

    def _tell_why(self, hand: RejectedGrasp) -> None:
        self.controls.say(rejected_in_words(hand))

    def _look_at(self, stage: Stage) -> None:
        camera = self._client.camera
        camera.up_direction = (0.0, 0.0, 1.0)
        camera.fov = stage.field_of_view
        camera.position, camera.look_at = stage.eye, stage.look_at

    def _redraw(self) -> None:
        """Show and hide what the switches say."""
        with self._drawing:
            if self._shown is not None:
                self._switch(self._shown)

    def _switch(self, shown: Shown) -> None:
        said = self.controls
        for handle in (shown.cloud, shown.glow):
            if handle is not None:
                handle.visible = said.shows_cloud
        if shown.background is not None:
            shown.background.visible = said.shows_table
        for part in (*shown.parts.values(), *shown.labels.values()):
            part.visible = said.shows_parts
        shown.choose(said.rank if said.shows_grasps else None, with_others=said.shows_all_grasps)

    def _try_out(self) -> None:
        known, rank = self._known, self.controls.rank
        if known is None or not len(known.result.grasps):
            self.controls.say("there is no grasp to try")
            return

        def work(is_newest: StillNewest) -> None:
            self._careful(lambda: play(is_newest))

        def play(is_newest: StillNewest) -> None:
            self.controls.say("trying it in simulation …")
            asked = known.result.execution(rank, strict=True, motion=True)
            request = asked.model_copy(update={"actor": "hand"})
            outcome = self._sparge.execute(request)
            self.controls.say(execution_in_words(outcome))
            gripper = self._grippers.get(known.asked.gripper)
            if gripper is not None and self._shown is not None:
                replay(
                    self._client.scene,
                    self._shown,
                    outcome,
                    gripper,
                    is_newest,
                    self.controls.say,
                )
            if is_newest():
                self._show(moves_eye=False)
                self.controls.say(execution_in_words(outcome))

        self._newest.submit(work)

    def _upload(self, name: str, data: bytes) -> None:
        def work() -> None:
            taken = self._sources.take_in(name, data)
            self.controls.offer_sources(list(self._sources), taken)

        if self._careful(work):
            self.ask()

    def _teach(self, name: str, requires: str, grasp: str) -> None:
        def work() -> None:
            task = self._sparge.add_task(
                name,
                requires=[requires] if requires else [],
                grasp=[grasp] if grasp else [],
            )
            tasks = [each.name for each in self._sparge.tasks()]
            self.controls.offer_tasks(tasks, task.name)

        if self._careful(work):
            self.ask()

    def _careful(self, work: Callable[[], object]) -> bool:
        """Do it; what goes wrong is said on the page, which goes on."""
        try:
            work()
        except SpargeError as error:
            self.controls.say(error_in_words(error))
            return False
        except Exception:
            log.exception("the viewer failed at a piece of work")
            self.controls.say("**internal**: the page failed at this; the log has the details")
            return False
        return True


def _counted(known: Known) -> str:
    answer = known.result.answer
    left_out = f"{len(answer.rejected)} hands left out, " if known.asked.with_rejected else ""
    return (
        f"{known.asked.source}: {len(answer.primitives)} parts, {len(answer.grasps)} grasps, "
        f"{left_out}{answer.timings_ms.get('total', 0.0):.0f} ms"
    )
