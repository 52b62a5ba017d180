"""Grasp proposal: 6-DOF grasps of a parallel gripper that collide with nothing that was seen."""
