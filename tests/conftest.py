"""Hypothesis draws the same examples on every machine; of the long tests a sample may be run.

Nobody has patience with a busy machine but those tests that ask for it: the others say nothing of
times, and would wait for nothing.
"""

import os
import subprocess
from zlib import crc32

import hypothesis
import pytest

os.environ["KBGA_BENCH_PATIENCE"] = "0"

hypothesis.settings.register_profile(
    "repeatable", derandomize=True, deadline=None, print_blob=False, database=None
)
hypothesis.settings.load_profile("repeatable")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--one-in",
        type=int,
        default=1,
        metavar="N",
        help="run one in N of the tests that are asked for: others at another commit",
    )


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    share = config.getoption("--one-in")
    if share > 1:
        commit = subprocess.run(
            ["git", "rev-parse", "HEAD"], capture_output=True, text=True, check=False
        ).stdout
        taken = {item for item in items if crc32(f"{commit}{item.nodeid}".encode()) % share == 0}
        config.hook.pytest_deselected(items=[item for item in items if item not in taken])
        items[:] = [item for item in items if item in taken]
