"""Links and joints in the gripper files, against the robot descriptions that they are from."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pybullet_data
import pytest
from numpy import cos, pi, sin
from scipy.spatial.transform import Rotation

from shared.errors import InvalidInput
from shared.geometry.se3 import inverse, pose_matrix
from shared.grippers import load_grippers
from shared.grippers.kinematics import advance, choose_link, joint_positions, tcp_from_link
from shared.schemas.gripper import ParallelGripper
from tests.shared.test_grippers import GOOD

GRIPPERS = load_grippers()
HANDS = [each for each in GRIPPERS.values() if isinstance(each, ParallelGripper)]
Linkage = Callable[[float], tuple[float, float]]


def knuckle_2f85(angle: float) -> tuple[float, float]:
    """Where a finger tip joint is: across and along, by robotiq_2f_85_macro.urdf.xacro."""
    x, z = 0.03152616 + 0.00563134, -0.00376347 + 0.04718515
    return (
        0.03060114 + x * cos(angle) - z * sin(angle),
        0.05490452 + x * sin(angle) + z * cos(angle),
    )


def knuckle_2f140(angle: float) -> tuple[float, float]:
    """Where the middle of a pad is, by robotiq_2f_140.xacro."""
    y, z = 0.01821998610742 + 0.0817554015893473, 0.0260018192872234 - 0.0282203446692936
    turn = pi / 2 + 0.725 - angle
    across = 0.030601 - (y * cos(turn) - z * sin(turn)) - 0.0272203446692936
    return across, 0.054905 + y * sin(turn) + z * cos(turn) + 0.0457554015893473


def finger_rg6(angle: float) -> tuple[float, float]:
    """Where the middle of a finger tip is, by onrobot_rg6_macro.xacro."""
    x, y = 0.0798896739, -0.0042
    return (
        0.02385 + x * sin(angle) + y * cos(angle) - 0.0196,
        0.0503 + 0.085 + x * cos(angle) - y * sin(angle) + 0.0479,
    )


LINKAGES: dict[str, tuple[Linkage, float, float]] = {
    "robotiq_2f85": (knuckle_2f85, 0.0, 0.8),
    "robotiq_2f140": (knuckle_2f140, 0.0, 0.7),
    "onrobot_rg6": (finger_rg6, 1.1928, 0.0),
}
"""By gripper: its linkage, and the angles where it is open and closed."""


@pytest.mark.parametrize("name", LINKAGES)
def test_strokes_are_the_linkage(name: str) -> None:
    linkage, opened, closed = LINKAGES[name]
    gripper = GRIPPERS[name]
    assert isinstance(gripper, ParallelGripper)
    assert gripper.urdf is not None
    across_open, along_open = linkage(opened)
    across_closed, _ = linkage(closed)
    scale = gripper.max_opening / (across_open - across_closed)
    for angle in np.linspace(opened, closed, 40):
        across, along = linkage(angle)
        opening = (across - across_closed) * scale
        assert advance(gripper.urdf, opening) == pytest.approx(along - along_open, abs=1.5e-3)
        assert joint_positions(gripper.urdf, opening) == pytest.approx([angle], abs=0.02)


@pytest.mark.parametrize("hand", HANDS, ids=lambda hand: hand.name)
def test_the_pads_advance_along_the_approach(hand: ParallelGripper) -> None:
    """A link stays behind the tool centre point, farther the more the hand is closed."""
    assert hand.urdf is not None
    link = hand.urdf.links[0]
    opened = tcp_from_link(hand, link, hand.max_opening)
    closed = tcp_from_link(hand, link, 0.0)
    np.testing.assert_allclose(opened[:3, :3], closed[:3, :3])
    moved = closed[:3, 3] - opened[:3, 3]
    np.testing.assert_allclose(moved, [0, 0, -advance(hand.urdf, 0.0)], atol=1e-12)
    assert opened[2, 3] < 0


@pytest.mark.parametrize("gripper", GRIPPERS.values(), ids=lambda gripper: gripper.name)
def test_a_link_that_is_written_as_urdf_does(gripper: ParallelGripper) -> None:
    assert gripper.urdf is not None
    for link in gripper.urdf.links:
        rotation = Rotation.from_euler("xyz", link.rpy).as_matrix()  # lower case: fixed axes
        link_from_tcp = pose_matrix(link.xyz, rotation)
        widest = gripper.max_opening if isinstance(gripper, ParallelGripper) else 0.0
        np.testing.assert_allclose(
            tcp_from_link(gripper, link, widest), inverse(link_from_tcp), atol=1e-12
        )


def test_the_pandas_links_are_those_of_its_description() -> None:
    model = Path(pybullet_data.getDataPath(), "franka_panda", "panda.urdf")
    for joint in ElementTree.parse(model).iterfind("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        assert parent is not None
        assert child is not None
        if (parent.get("link"), child.get("link")) == ("panda_link8", "panda_hand"):
            origin = joint.find("origin")
            break
    assert origin is not None
    xyz, rpy = ([float(n) for n in origin.get(name, "").split()] for name in ("xyz", "rpy"))
    link8_from_hand = pose_matrix(xyz, Rotation.from_euler("xyz", rpy).as_matrix())
    panda = GRIPPERS["panda"]
    tcp_from_link8, tcp_from_hand = (
        tcp_from_link(panda, choose_link(panda, name), 0.04)
        for name in ("panda_link8", "panda_hand")
    )
    np.testing.assert_allclose(tcp_from_link8 @ link8_from_hand, tcp_from_hand, atol=1e-9)


def test_the_two_links_of_tiago_agree() -> None:
    """gripper_grasping_frame is 130 mm along -z of gripper_link, rpy -90, 90, 0 degrees."""
    tiago = GRIPPERS["tiago"]
    turn = Rotation.from_euler("xyz", [-90, 90, 0], degrees=True).as_matrix()
    link_from_frame = pose_matrix([0, 0, -0.13], turn)
    tcp_from_grip, tcp_from_frame = (
        tcp_from_link(tiago, choose_link(tiago, name), 0.09)
        for name in ("gripper_link", "gripper_grasping_frame")
    )
    np.testing.assert_allclose(tcp_from_grip @ link_from_frame, tcp_from_frame, atol=1e-9)


def test_links_by_name() -> None:
    panda = GRIPPERS["panda"]
    assert choose_link(panda, None).name == "panda_link8"
    assert choose_link(panda, "tcp").name == "tcp"
    np.testing.assert_array_equal(tcp_from_link(panda, choose_link(panda, "tcp"), 0.0), np.eye(4))
    with pytest.raises(InvalidInput, match="panda_link8, panda_hand") as caught:
        choose_link(panda, "panda_link7")
    assert caught.value.details["allowed"][0] == "tcp"
    bare = panda.model_copy(update={"urdf": None})
    assert choose_link(bare, "tcp").name == "tcp"
    with pytest.raises(InvalidInput, match="pose_of=tcp"):
        choose_link(bare, None)


def strokes(*rows: str) -> str:
    """Return a table with one joint and strokes of opening and positions."""
    pairs = [row[1:-1].split(", ", 1) for row in rows]
    written = ", ".join(f"{{ opening = {at}, positions = {where} }}" for at, where in pairs)
    return f'joints = ["j"]\nlinks = [{{ name = "a", xyz = [0, 0, 0] }}]\nstrokes = [{written}]'


@pytest.mark.parametrize(
    ("urdf", "said"),
    [
        ("links = []", "links"),
        ('links = [{ name = "tcp", xyz = [0, 0, 0] }]', "none is 'tcp'"),
        ('links = [{ name = "a", xyz = [0, 0, 0] }, { name = "a", xyz = [0, 0, 0] }]', "differ"),
        ('joints = ["j"]\nlinks = [{ name = "a", xyz = [0, 0, 0] }]', "joints need strokes"),
        (strokes("[0.0, []]"), "needs 1 positions"),
        (strokes("[0.05, [1]]", "[0, [0]]"), "closed to open"),
        (strokes("[0, [1]]", "[0.04, [0]]"), "max_opening is 0.05"),
        (strokes("[0, [1]]"), "begin at the opening 0 and end at the widest"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, urdf: str, said: str) -> None:
    text = GOOD.format(name="mine", length=0.05) + f"[urdf]\n{urdf}\n"
    (tmp_path / "mine.toml").write_text(text)
    with pytest.raises(ValueError, match=said):
        load_grippers(tmp_path)
