"""One picture of an answer: the parts, the part to hold, and the gripper that holds it.

A small orthographic projection of its own: everything is drawn in two
dimensions, farthest first, with no window and no global state.
"""

from services.cli.picture.answer import draw_answer

__all__ = ["draw_answer"]
