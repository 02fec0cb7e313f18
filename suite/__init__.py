"""The common ground of kbga-bench and the harness above it.

Planners arrive by entry point: nothing in this package imports ``kbga`` or ``baselines``.
"""
