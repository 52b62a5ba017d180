"""Films of trials: their frames, a strip of stills, two side by side."""

from __future__ import annotations

import io
from collections.abc import Sequence
from itertools import zip_longest

import numpy as np
from PIL import Image, ImageDraw, ImageFont, ImageSequence

from experiments.demo.trials import Trial
from experiments.framework import Plot
from experiments.framework.plots import new_figure

FRAME_MS = 100
LAST_FRAME_MS = 2000
TITLE_HEIGHT = 34
INK, PAPER = (31, 41, 51), (255, 255, 255)
COLOURS = 128
MOMENTS = {"before": "settle", "before the grasp": "drive", "gripped": "close", "in the end": ""}
"""Heading of a still -> the phase at whose end it is taken, as in Figure 6.8; the last is last."""


def frames(film: bytes) -> list[Image.Image]:
    """Return the pictures of a film, one for every `FRAME_MS`; the last one once."""
    shown: list[Image.Image] = []
    with Image.open(io.BytesIO(film)) as held:
        for picture in ImageSequence.Iterator(held):
            repeats = max(1, round(picture.info["duration"] / FRAME_MS))
            shown += [picture.convert("RGB")] * repeats
    return shown[: len(shown) - round(LAST_FRAME_MS / FRAME_MS) + 1]


def title_of(trial: Trial) -> str:
    """Return what a film is about."""
    wrong = ", by the wrong part" if trial.lifted and not trial.in_region else ""
    where = f"{trial.version}, view {trial.number}"
    return f"{trial.task}, bottle {trial.pose}: {trial.outcome}{wrong} ({where})"


def side_by_side(trials: Sequence[Trial]) -> bytes:
    """Return the films of trials next to each other as one animated GIF.

    A film that is over stands still until the others are.
    """
    films = [frames(trial.film) for trial in trials]
    width, height = films[0][0].size
    font = ImageFont.load_default(18)
    pictures = []
    ends = [film[-1] for film in films]
    for moment in zip_longest(*films):
        sheet = Image.new("RGB", (width * len(films), TITLE_HEIGHT + height), PAPER)
        draw = ImageDraw.Draw(sheet)
        for index, (trial, picture, end) in enumerate(zip(trials, moment, ends, strict=True)):
            sheet.paste(picture or end, (index * width, TITLE_HEIGHT))
            title = f"{trial.task}, bottle {trial.pose}; orange: the part to hold"
            draw.text((index * width + 14, 7), title, fill=INK, font=font)
        pictures.append(sheet)
    return _gif(pictures)


def strips(trials: Sequence[Trial]) -> Plot:
    """Return stills of trials, a line each, at the ends of the phases."""
    figure = new_figure(2.4 * len(MOMENTS), 2.1 * len(trials) + 0.2)
    grid = figure.subplots(len(trials), len(MOMENTS), squeeze=False)
    for line, trial in enumerate(trials):
        shown, ends = frames(trial.film), _ends(trial)
        for column, (heading, phase) in enumerate(MOMENTS.items()):
            axes = grid[line, column]
            axes.set_axis_off()
            if not phase:
                axes.imshow(np.asarray(shown[-1]))
            elif phase in ends:
                axes.imshow(np.asarray(shown[min(ends[phase], len(shown) - 1)]))
            if line == 0:
                axes.text(0.5, 1.03, heading, transform=axes.transAxes, fontsize=10, ha="center")
        label = grid[line, 0].text(
            0.0, -0.03, title_of(trial), transform=grid[line, 0].transAxes, fontsize=9, va="top"
        )
        label.set_in_layout(False)
    return Plot(
        "stills",
        "What the arm did: one trial of each kind, and the first that went wrong. Orange is the "
        "part to hold for the task. The films are the GIF files beside this picture.",
        figure,
    )


def _ends(trial: Trial) -> dict[str, int]:
    """Return the last frame of each phase that came to its end."""
    if trial.executed is None:
        return {}
    phases = trial.executed.phases
    start = phases[0].simulated_s
    return {phase.name: round(1000 * (phase.simulated_s - start) / FRAME_MS) for phase in phases}


def _gif(pictures: Sequence[Image.Image]) -> bytes:
    every = max(1, len(pictures) // 6)
    samples = [*pictures[::every], pictures[-1]]
    width, height = pictures[0].size
    mosaic = Image.new("RGB", (width, height * len(samples)))
    for index, picture in enumerate(samples):
        mosaic.paste(picture, (0, index * height))
    palette = mosaic.quantize(COLOURS, Image.Quantize.FASTOCTREE)
    shown = [each.quantize(palette=palette, dither=Image.Dither.NONE) for each in pictures]
    stream = io.BytesIO()
    shown[0].save(
        stream,
        format="GIF",
        save_all=True,
        append_images=shown[1:],
        duration=[FRAME_MS] * (len(shown) - 1) + [LAST_FRAME_MS],
        loop=0,
        optimize=True,
    )
    return stream.getvalue()
