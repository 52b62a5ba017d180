"""Experiment 3 of the thesis: the chosen grasp against labels."""
