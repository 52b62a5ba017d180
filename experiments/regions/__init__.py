"""Experiment 2 of the thesis: regions against labels."""
