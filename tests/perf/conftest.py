"""What the JSON of a benchmark says about the machine and the versions."""

from suite.harness.provenance import provenance


def pytest_benchmark_update_machine_info(config, machine_info):
    machine_info["provenance"] = provenance("performance")
