"""Perception: find the support plane in one depth view, and the object to grasp on it."""
