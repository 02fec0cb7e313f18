"""Compile the kernels of some planners, so that the tests find them: `make kernels`."""

import sys

from suite.plugins.discovery import load_planner

if __name__ == "__main__":
    for name in sys.argv[1:]:
        load_planner(name)().warm_up()
