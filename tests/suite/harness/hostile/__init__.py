"""Planners that behave as badly as strangers' may, and some that behave well.

The fixture ``hostile`` makes a distribution of them, with metadata like any installed package's.
"""
