"""Grasps tried out in physics, to train the scorer of grasps on: `python -m experiments.trials`."""
