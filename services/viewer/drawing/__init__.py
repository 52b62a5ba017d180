"""An answer as things in a viser scene; pure drawing, nothing is asked here."""

from services.viewer.drawing.answer import Shown, draw_answer
from services.viewer.drawing.camera import Stage
from services.viewer.drawing.gripper import gripper_mesh

__all__ = ["Shown", "Stage", "draw_answer", "gripper_mesh"]
