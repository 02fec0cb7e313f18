"""Planners to compare with: OMPL's, a plain GA, the exact solver; same rights as ``kbga``."""
