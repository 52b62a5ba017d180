"""Expectation, maximization, switch: superquadrics from points (Liu et al., CVPR 2022)."""
