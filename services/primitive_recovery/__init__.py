"""Decompose an object's visible points into superquadrics and name their shapes."""
