"""Hypothesis draws the same examples on every machine, and waits for the compiler."""

import hypothesis

hypothesis.settings.register_profile(
    "repeatable", derandomize=True, deadline=None, print_blob=False, database=None
)
hypothesis.settings.load_profile("repeatable")
