"""Regions under disturbances, and in another frame."""
