"""Rigid motions, planes and point sets, in NumPy and SciPy alone."""
