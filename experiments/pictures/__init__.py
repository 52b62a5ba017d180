"""The pictures of the documentation, drawn by `python -m experiments.pictures`."""
