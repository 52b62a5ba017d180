"""Experiment 1 of the thesis: a new task, cutting."""
