"""Experiment 5 of the thesis: a bottle, flat and upright, is grasped for a task by a whole arm."""
