"""The panel of a page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import viser

ANY = "(any)"
VERSIONS = {"v2: affordances": "v2", "v1: a rule per task": "v1"}


class Controls:
    """Everything that can be set, and where the answer is told.

    Parameters
    ----------
    gui : viser.GuiApi
        Of one client.
    sources : sequence of str
        What can be looked at.
    """

    def __init__(self, gui: viser.GuiApi, sources: Sequence[str]) -> None:
        gui.set_panel_label("SPaRGE")
        self._status = gui.add_markdown("starting …")
        self._source = gui.add_dropdown("View", tuple(sources))
        self._task = gui.add_dropdown("Task", ("",), disabled=True)
        self._version = gui.add_dropdown("Reasoning", tuple(VERSIONS))
        self._gripper = gui.add_dropdown("Gripper", ("",), disabled=True)
        tabs = gui.add_tab_group()
        with tabs.add_tab("Why"):
            self._words = gui.add_markdown("")
        with tabs.add_tab("Grasps"):
            self._rank = gui.add_slider("Rank", 0, 1, 1, 0, hint="0 is the best")
            self._all = gui.add_checkbox("All grasps", initial_value=True)
            self._rejected = gui.add_checkbox(
                "Rejected hands", initial_value=False, hint="Click one to see why it was left out"
            )
            self._rehearsed = gui.add_checkbox(
                "Try them first", initial_value=False, hint="Those in doubt, before they are shown"
            )
            self._legend = gui.add_html("")
            self._try = gui.add_button("Try it in simulation", icon=viser.Icon.PLAYER_PLAY)
        with tabs.add_tab("Look"):
            self._cloud = gui.add_checkbox("Points", initial_value=True)
            self._parts = gui.add_checkbox("Parts", initial_value=True)
            self._grasps = gui.add_checkbox("Grippers", initial_value=True)
            self._table = gui.add_checkbox("Table", initial_value=True)
            self._file = gui.add_upload_button("Open a file")
        with tabs.add_tab("Disturb"):
            gui.add_markdown("The backend is asked again with a worse view.")
            self._noise = gui.add_slider("Noise (mm)", 0.0, 8.0, 0.5, 0.0, hint="Of depth, at 1 m")
            self._hidden = gui.add_slider("Hidden (%)", 0, 90, 5, 0, hint="Of the object's left")
        with tabs.add_tab("Teach"):
            gui.add_markdown("A new task, known to the next question.")
            self._name = gui.add_text("Name", "watering")
            self._requires = gui.add_dropdown("Object must", (ANY,))
            self._holds = gui.add_dropdown("Hold what can", (ANY,))
            self._teach = gui.add_button("Add the task", icon=viser.Icon.PLUS)

    def listen(
        self,
        ask: Callable[[], None],
        redraw: Callable[[], None],
        try_out: Callable[[], None],
        upload: Callable[[str, bytes], None],
        teach: Callable[[str, str, str], None],
    ) -> None:
        """Call these when something is set or pressed."""
        asking = (
            self._source,
            self._task,
            self._version,
            self._gripper,
            self._noise,
            self._hidden,
            self._rejected,
            self._rehearsed,
        )
        for control in asking:
            control.on_update(lambda _: ask())
        showing = (self._rank, self._all, self._cloud, self._parts, self._grasps, self._table)
        for switch in showing:
            switch.on_update(lambda _: redraw())
        self._try.on_click(lambda _: try_out())
        self._file.on_upload(lambda _: upload(self._file.value.name, self._file.value.content))
        self._teach.on_click(
            lambda _: teach(self._name.value, _chosen(self._requires), _chosen(self._holds))
        )

    @property
    def source(self) -> str:
        return self._source.value

    @property
    def task(self) -> str:
        return self._task.value

    @property
    def reasoning(self) -> str:
        return VERSIONS[self._version.value]

    @property
    def gripper(self) -> str:
        return self._gripper.value

    @property
    def noise_mm(self) -> float:
        return float(self._noise.value)

    @property
    def hidden(self) -> float:
        """Share of the object."""
        return self._hidden.value / 100

    @property
    def rank(self) -> int:
        return int(self._rank.value)

    @property
    def shows_rejected(self) -> bool:
        return self._rejected.value

    @property
    def rehearses(self) -> bool:
        return self._rehearsed.value

    @property
    def shows_all_grasps(self) -> bool:
        return self._all.value

    @property
    def shows_cloud(self) -> bool:
        return self._cloud.value

    @property
    def shows_parts(self) -> bool:
        return self._parts.value

    @property
    def shows_grasps(self) -> bool:
        return self._grasps.value

    @property
    def shows_table(self) -> bool:
        return self._table.value

    def say(self, status: str) -> None:
        """Say in a line what is going on, or what went wrong."""
        self._status.content = status

    def tell(self, words: str) -> None:
        """Tell the answer and why."""
        self._words.content = words

    def list_reasons(self, legend: str) -> None:
        """Tell the colours of rejected hands, as HTML."""
        self._legend.content = legend

    def offer(
        self, tasks: Sequence[str], grippers: Sequence[str], affordances: Sequence[str]
    ) -> None:
        """Offer what the backend knows."""
        _offer(self._gripper, grippers, "panda")
        _offer(self._task, tasks, "pouring")
        for control in (self._requires, self._holds):
            _offer(control, (ANY, *affordances), ANY)

    def offer_tasks(self, tasks: Sequence[str], chosen: str) -> None:
        """Offer tasks anew, with one of them chosen."""
        _offer(self._task, tasks, chosen)

    def offer_sources(self, sources: Sequence[str], chosen: str) -> None:
        """Offer views anew, with one of them chosen."""
        _offer(self._source, sources, chosen)

    def offer_ranks(self, count: int) -> None:
        """Offer as many grasps as there are."""
        self._rank.max = max(count - 1, 1)
        self._rank.disabled = count < 2
        self._try.disabled = count == 0
        if self.rank >= max(count, 1):
            _set(self._rank, 0)


def _offer(control: Any, options: Sequence[str], preferred: str) -> None:
    """Give a dropdown options; what is chosen stays, if it can."""
    listed = tuple(options) or ("",)
    held = control.value
    control.options = listed
    kept = held if held in listed else listed[0]
    _set(control, preferred if preferred in listed else kept)
    control.disabled = not options


def _set(control: Any, value: object) -> None:
    """Set what a control holds; viser's types know it as read-only."""
    control.value = value


def _chosen(control: viser.GuiDropdownHandle[Any]) -> str:
    return "" if control.value == ANY else control.value
