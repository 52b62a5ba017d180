"""Reasoning: from primitives and a task to the part to hold, proved in Prolog."""
