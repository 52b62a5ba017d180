"""Experiment 4 of the thesis: what a request takes."""
