"""Planners to compare with: OMPL's, a plain GA, the exact solver. Same rights as ``kbga``, no more."""
