"""Hypothesis draws the same examples on every machine, and waits for the compiler.

Nobody has patience with a busy machine but those tests that ask for it: the others say nothing of
times, and would wait for nothing.
"""

import os

import hypothesis

os.environ["KBGA_BENCH_PATIENCE"] = "0"

hypothesis.settings.register_profile(
    "repeatable", derandomize=True, deadline=None, print_blob=False, database=None
)
hypothesis.settings.load_profile("repeatable")
