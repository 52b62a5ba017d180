"""Matching: points to primitives, and the best grasps whose nearest point lies in the region."""
