"""The network: a small convolutional one on the images, joined by the numbers; two heads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from services.grasp_proposal.descriptor import CHANNELS, SIZE
from services.grasp_proposal.measures import MIRROR_X, MIRROR_Y, NAMES
from services.grasp_proposal.training.lessons import Lessons
from services.grasp_proposal.training.mirror import mirrored

Array = NDArray[np.float64]

FILTERS = (16, 32)
SEEN, KNOWN, JOINT = 32, (96, 64), 64
"""Features of the images, of the numbers in two layers, and of both."""
DROPPED = 0.3
BATCH = 64
RATE, DECAY = 2e-3, 1e-1
HEADS = (0.2, 0.8)
"""What lifting and keeping count for in the order. Keeping is harder, and who keeps lifts."""
FAR = 4.0
"""Standard deviations at which the numbers are cut off."""


@dataclass(frozen=True)
class Network:
    """Layers, and the scale of the numbers.

    Attributes
    ----------
    pictures, numbers, joint : torch.nn.Sequential
        Images to `SEEN` features, scaled numbers to `KNOWN`, both to the two heads' logits:
        lifts, keeps when shaken.
    mean, deviation : (M,) arrays
        Of the numbers, float32.
    """

    pictures: Any
    numbers: Any
    joint: Any
    mean: NDArray[np.float32]
    deviation: NDArray[np.float32]

    def __call__(self, images: Any, numbers: Any) -> Any:
        """Return logits (G, 2) of tensors (G, 15, 20, 20) and (G, M)."""
        scaled = (numbers - torch.from_numpy(self.mean)) / torch.from_numpy(self.deviation)
        known = self.numbers(scaled.clamp(-FAR, FAR))
        return self.joint(torch.cat([self.pictures(images), known], dim=1))

    def layers(self) -> tuple[Any, Any, Any]:
        return self.pictures, self.numbers, self.joint

    def logits(self, lessons: Lessons) -> Array:
        """Return the heads' answers (G, 2) about lessons."""
        for part in self.layers():
            part.eval()
        with torch.no_grad():
            answers = self(torch.from_numpy(lessons.images), torch.from_numpy(lessons.numbers))
        return np.asarray(answers.numpy(), dtype=np.float64)


def train_network(lessons: Lessons, epochs: int, seed: int) -> Network:
    """Return a network fitted to lessons; the same arguments give the same network.

    Every time that a grasp is shown, it is mirrored by chance along the hand's x and y:
    physics knows neither left nor right.
    """
    torch.manual_seed(seed)
    torch.set_num_threads(1)
    rng = np.random.default_rng(seed)
    network = _untrained(lessons)
    weights = [each for part in network.layers() for each in part.parameters()]
    optimizer = torch.optim.AdamW(weights, lr=RATE, weight_decay=DECAY)
    steps = epochs * -(-len(lessons) // BATCH)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, max_lr=RATE, total_steps=steps)
    wanted = np.column_stack([lessons.lifted, lessons.held]).astype(np.float32)
    loss_of = nn.BCEWithLogitsLoss()
    for _ in range(epochs):
        for part in network.layers():
            part.train()
        for rows in _batches(len(lessons), rng):
            images, numbers = mirrored(lessons.images[rows], lessons.numbers[rows], rng)
            optimizer.zero_grad()
            answers = network(torch.from_numpy(images), torch.from_numpy(numbers))
            loss_of(answers, torch.from_numpy(wanted[rows])).backward()
            optimizer.step()
            schedule.step()
    for part in network.layers():
        part.eval()
    return network


def _untrained(lessons: Lessons) -> Network:
    side = SIZE // 4
    return Network(
        pictures=nn.Sequential(
            nn.Conv2d(CHANNELS, FILTERS[0], 3, stride=2, padding=1),
            nn.ReLU(),
            nn.Conv2d(FILTERS[0], FILTERS[1], 3, stride=2, padding=1),
            nn.ReLU(),
            nn.Flatten(),
            nn.Dropout(DROPPED),
            nn.Linear(FILTERS[1] * side * side, SEEN),
            nn.ReLU(),
        ),
        numbers=nn.Sequential(
            nn.Linear(len(NAMES), KNOWN[0]), nn.ReLU(), nn.Linear(*KNOWN), nn.ReLU()
        ),
        joint=nn.Sequential(
            nn.Dropout(DROPPED),
            nn.Linear(SEEN + KNOWN[-1], JOINT),
            nn.ReLU(),
            nn.Linear(JOINT, 2),
        ),
        mean=_symmetric_mean(lessons.numbers),
        deviation=lessons.numbers.std(axis=0) + np.float32(1e-3),
    )


def _symmetric_mean(numbers: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the mean (M,) over grasps and their mirror images."""
    even = (MIRROR_X > 0) & (MIRROR_Y > 0)
    return np.where(even, numbers.mean(axis=0), 0).astype(np.float32)


def _batches(rows: int, rng: np.random.Generator) -> Iterator[NDArray[np.intp]]:
    order = rng.permutation(rows)
    for first in range(0, rows, BATCH):
        yield order[first : first + BATCH]
