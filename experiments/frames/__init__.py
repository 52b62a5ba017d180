"""The drawing and the table of docs/frames.md, from the gripper files."""
