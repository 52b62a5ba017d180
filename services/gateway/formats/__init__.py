"""The answer to POST /grasp as other tools write grasps."""

from services.gateway.formats.render import Rendered, render, require_fitting

__all__ = ["Rendered", "render", "require_fitting"]
