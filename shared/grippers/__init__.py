"""The grippers that are known: one TOML file each, here and in the user's folder."""

from shared.grippers.library import GripperSettings, choose_gripper, load_grippers

__all__ = ["GripperSettings", "choose_gripper", "load_grippers"]
