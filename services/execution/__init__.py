"""Execution: the Panda arm replays a grasp in PyBullet and says whether the object was lifted."""
