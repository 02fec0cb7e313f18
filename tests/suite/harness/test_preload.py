from suite.harness.fork_server import Warmth
from suite.harness.isolate import run_isolated
from suite.harness.matrix import Limits
from suite.harness.single import cell_for


def test_a_run_finds_the_whole_suite_loaded(hostile, wall_file):
    # Each import that is left to the runs costs every one of them; all together cost 30 ms once.
    cell = cell_for(str(wall_file), "counts-late-imports", seed=0)
    record = run_isolated(cell, Limits(), Warmth())
    assert record.details == {"late": 0.0}
