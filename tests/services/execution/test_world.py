from __future__ import annotations

import numpy as np
import pybullet
import pytest

from services.execution.body import DENSITY, MASS_RANGE, RigidBody, rigid_body
from services.execution.bullet import Bullet, physics
from services.execution.convex import ConvexPart
from services.execution.world import World
from tests.services.execution.scenes import Mesh, box

HAMMER = (
    box((0.012, 0.012, 0.10), (0.0, 0.0, 0.10)),
    box((0.05, 0.02, 0.02), (0.02, 0.0, 0.18)),
)
"""Parts that do not overlap in the middle of either, with the weight well off both centres."""


def body_of(*meshes: Mesh) -> RigidBody:
    return rigid_body([ConvexPart(*mesh) for mesh in meshes])


def test_centre_mass_and_inertia_of_a_box() -> None:
    half = np.array([0.03, 0.04, 0.05])
    body = body_of(box((0.03, 0.04, 0.05), (0.2, 0.1, 0.3)))
    mass = DENSITY * 8 * half.prod()
    assert body.mass == pytest.approx(mass)
    assert body.world_from_body[:3, 3] == pytest.approx([0.2, 0.1, 0.3])
    squares = half**2
    assert np.sort(body.inertia) == pytest.approx(np.sort(mass / 3 * (squares.sum() - squares)))


def test_the_mass_stays_in_its_range() -> None:
    assert body_of(box((0.01, 0.01, 0.01), (0, 0, 0.01))).mass == MASS_RANGE[0]
    assert body_of(box((0.2, 0.2, 0.2), (0, 0, 0.2))).mass == MASS_RANGE[1]


def test_a_mass_that_is_told_is_taken() -> None:
    parts = [ConvexPart(*box((0.01, 0.02, 0.03), (0, 0, 0.03)))]
    guessed, told = rigid_body(parts), rigid_body(parts, 2.0)
    assert told.mass == 2.0
    assert told.inertia / told.mass == pytest.approx(guessed.inertia / guessed.mass)


def test_the_centre_of_mass_is_where_it_should_be(bullet: Bullet) -> None:
    body = body_of(*HAMMER)
    volumes = np.array([8 * 0.012 * 0.012 * 0.10, 8 * 0.05 * 0.02 * 0.02])
    expected = volumes @ np.array([[0, 0, 0.10], [0.02, 0, 0.18]]) / volumes.sum()
    world = World(bullet, body)
    assert world.world_from_body[:3, 3] == pytest.approx(expected, abs=1e-6)
    mass, _, inertia, offset, *_ = bullet.getDynamicsInfo(world.object, -1)
    assert mass == pytest.approx(body.mass)
    assert inertia == pytest.approx(body.inertia)
    assert offset == pytest.approx((0, 0, 0))
    # The surface is where it was, too: rays from above hit the head, rays beside it the table.
    on_head, beside = bullet.rayTestBatch(
        [[0.06, 0, 1], [-0.06, 0, 1]], [[0.06, 0, 0], [-0.06, 0, -0.01]]
    )
    assert on_head[0] == world.object
    assert on_head[3][2] == pytest.approx(0.20, abs=2e-3)
    assert beside[0] == world.table


def test_a_falling_body_falls_about_its_centre_of_mass(bullet: Bullet) -> None:
    world = World(bullet, body_of(*HAMMER))
    bullet.resetBasePositionAndOrientation(world.object, [0, 0, 2.0], [0, 0, 0, 1])
    bullet.resetBaseVelocity(world.object, [0, 0, 0], [3.0, 0, 0])
    for _ in range(60):
        world.step()
    assert world.world_from_body[:2, 3] == pytest.approx([0, 0], abs=1e-4)


def test_every_part_of_an_object_is_there(bullet: Bullet) -> None:
    """Bullet makes bodies of more than sixteen parts in one way only."""
    turns = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    where = 0.3 * np.column_stack([np.cos(turns), np.sin(turns), np.full(40, 0.1)])
    parts = [ConvexPart(*box((0.01, 0.01, 0.03), tuple(place))) for place in where]
    world = World(bullet, rigid_body(parts))
    above, below = where + np.array([0, 0, 0.5]), where - np.array([0, 0, 0.029])
    rays = bullet.rayTestBatch(above.tolist(), below.tolist())
    assert [ray[0] for ray in rays] == [world.object] * 40
    beside = bullet.rayTestBatch([[0, 0, 0.5]], [[0, 0, 0.01]])
    assert beside[0][0] == -1  # not one hull around all of them


def test_a_standing_object_stays(bullet: Bullet) -> None:
    body = body_of(box((0.02, 0.03, 0.05), (0, 0, 0.05)))
    world = World(bullet, body)
    world.settle()
    moved, turned = world.displacement(body.world_from_body)
    assert not world.propped
    assert moved < 1e-3
    assert turned < 0.01
    assert world.stands_on_something()


def test_a_hovering_object_rests_where_it_was_seen(bullet: Bullet) -> None:
    body = body_of(box((0.02, 0.03, 0.05), (0, 0, 0.08)))
    world = World(bullet, body)
    world.settle()
    assert world.displacement(body.world_from_body)[0] < 1e-3
    assert world.stands_on_something()


def test_an_object_that_would_fall_is_propped_until_released(bullet: Bullet) -> None:
    tall = box((0.004, 0.03, 0.08), (0, 0, 0.08))
    turn = np.array([[0.96, 0, 0.28, 0], [0, 1, 0, 0], [-0.28, 0, 0.96, 0.002], [0, 0, 0, 1.0]])
    body = rigid_body([ConvexPart(*tall).moved(turn)])
    world = World(bullet, body)
    world.settle()
    assert world.propped
    for _ in range(240):
        world.step()
    moved, turned = world.displacement(body.world_from_body)
    assert (moved < 0.01, turned < 0.1) == (True, True)
    world.release()
    for _ in range(240):
        world.step()
    assert world.displacement(body.world_from_body)[1] > 0.5


def test_an_object_that_would_only_tip_is_propped_as_well(bullet: Bullet) -> None:
    base, beam = box((0.03, 0.03, 0.01), (0, 0, 0.01)), box((0.12, 0.01, 0.005), (0.15, 0, 0.015))
    world = World(bullet, rigid_body([ConvexPart(*base), ConvexPart(*beam)]))
    world.settle(propped=False)
    moved, turned = world.displacement(world.body.world_from_body)
    assert (moved < 0.003, turned < 0.06) == (True, True)  # yet the end of the beam is down
    world = World(bullet, rigid_body([ConvexPart(*base), ConvexPart(*beam)]))
    world.settle()
    assert world.propped


def test_the_client_is_closed_after_an_error() -> None:
    clients = []

    def fail() -> None:
        with physics() as inner:
            clients.append(inner.client)
            raise RuntimeError("on purpose")

    with pytest.raises(RuntimeError, match="on purpose"):
        fail()
    assert not pybullet.isConnected(clients[0])
