"""Labelled views to train the cuts of the method `parts` on: `python -m experiments.parts OUT`."""
