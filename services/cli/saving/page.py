"""The answer as a page of its own: turn it around in any browser, without a network."""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Iterator
from html import escape
from pathlib import Path

import viser

from services.cli.ask import Answered
from services.viewer.drawing import draw_answer
from services.viewer.drawing.answer import describe
from shared.client import headline

BEST_OPACITY = 0.5
"""Of the gripper at the best grasp, which would hide what it holds."""
STYLE = """<style>
#root { position: absolute; left: min(24rem, 40vw); right: 0; top: 0; bottom: 0; width: auto; }
#sparge { position: fixed; top: 0; left: 0; width: min(24rem, 40vw); height: 100vh;
  overflow: auto; box-sizing: border-box; padding: 0.9rem 1.1rem; background: #fff;
  color: #1f2933; font: 14px/1.45 system-ui, sans-serif; }
#sparge h1 { font-size: 1.05rem; margin: 0 0 0.4rem; }
#sparge table { border-collapse: collapse; margin: 0.5rem 0; font-size: 0.85rem; }
#sparge td, #sparge th { text-align: left; padding: 0.1rem 0.7rem 0.1rem 0; font-weight: normal; }
#sparge th { color: #6b7785; }
#sparge summary { cursor: pointer; color: #6b7785; }
</style>"""


def write_page(path: Path, answered: Answered) -> None:
    """Write one HTML file with scene, headline and reasons; it loads nothing."""
    with _server() as server:
        _draw(server, answered)
        page = server.get_scene_serializer().as_html()
    path.write_text(with_words(page, answered), encoding="utf-8")


def _draw(server: viser.ViserServer, answered: Answered) -> None:
    result = answered.result
    shown = draw_answer(
        server.scene,
        result,
        answered.points,
        answered.gripper,
        viewpoint=answered.viewpoint,
    )
    for hand in shown.grasps[:1]:
        hand.full.opacity = BEST_OPACITY
    if result.best is not None:
        behind = [[0.0, 0.0, -answered.gripper.palm_size[2]]]
        server.scene.add_label(
            "/answer/best",
            f"opening {1e3 * result.best.width:.0f} mm, score {result.best.score:.2f}",
            position=result.best.pregrasp.apply(behind)[0],
            anchor="bottom-center",
            font_screen_scale=0.85,
        )
    stage, camera = shown.stage, server.initial_camera
    camera.up, camera.fov = (0.0, 0.0, 1.0), stage.field_of_view
    camera.look_at, camera.position = stage.look_at, stage.eye


def with_words(page: str, answered: Answered) -> str:
    """Return viser's page with a title and a panel of words on top."""
    title = f"{answered.name}, {headline(answered.result.answer)}"
    page = re.sub(r"<title>.*?</title>", lambda _: f"<title>{escape(title)}</title>", page, count=1)
    end = page.rindex("</body>")
    return page[:end] + STYLE + panel(answered, title) + page[end:]


def panel(answered: Answered, title: str) -> str:
    """Return what the answer says, as HTML; every text of the answer is escaped."""
    answer = answered.result.answer
    held = answer.region.primitive_ids if answer.region else ()
    lines = [f"<h1>{escape(title)}</h1>"]
    if answer.reason is not None:
        lines.append(f"<p><b>{escape(answer.reason.code)}</b>: {escape(answer.reason.message)}</p>")
    lines.append(
        _table(
            ("part", "affordances"),
            [
                (describe(each) + (" · hold" if each.id in held else ""), ", ".join(each.labels))
                for each in answer.primitives
            ],
        )
    )
    lines.append(
        _table(
            ("grasp", "opening", "score"),
            [
                (str(each.rank), f"{1e3 * each.width:.0f} mm", f"{each.score:.2f}")
                for each in answered.result.ranked
            ],
        )
    )
    if answered.result.why:
        lines.append(
            f"<details open><summary>Why</summary><p>{escape(answered.result.why)}</p></details>"
        )
    colour = "Orange: what to hold. " if answer.region else ""
    lines.append(
        f"<p>{colour}Frame {escape(answer.frame_id)}, gripper {escape(answer.gripper)}. Drag to "
        "turn, scroll to zoom; the button at the upper right hides what is in the way.</p>"
    )
    return f'<aside id="sparge">{"".join(lines)}</aside>'


def _table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    if not rows:
        return ""
    head = "".join(f"<th>{escape(each)}</th>" for each in heads)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(each)}</td>" for each in row) + "</tr>" for row in rows
    )
    return f"<table><tr>{head}</tr>{body}</table>"


@contextlib.contextmanager
def _server() -> Iterator[viser.ViserServer]:
    """Give a scene; viser has one only with a server, which nobody is told of here."""
    with contextlib.redirect_stdout(io.StringIO()):  # it greets and takes leave
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        try:
            yield server
        finally:
            server.stop()
