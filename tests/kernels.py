"""Compile the kernels of some planners, and of the exact solver, so that the tests find them.

`make kernels`; the solver's name is `exact`.
"""

import sys

from baselines.visibility_graph import tiny_scene
from suite.plugins.discovery import load_planner
from suite.scenes.exact import shortest_path

if __name__ == "__main__":
    for name in sys.argv[1:]:
        if name == "exact":
            shortest_path(tiny_scene(), tiny_scene().query())
        else:
            load_planner(name)().warm_up()
