import importlib.metadata

from suite.harness.provenance import installed_versions, provenance, run_environment


def test_all_that_is_required_is_named_and_what_that_requires():
    versions = installed_versions(["kbga-bench"])
    # numba requires llvmlite, matplotlib pyparsing, and so on: we name neither.
    assert {"kbga-bench", "numpy", "llvmlite", "ompl", "pyparsing"} <= set(versions)
    assert versions["numpy"] == importlib.metadata.version("numpy")


def test_extras_and_what_is_not_installed_are_left_out():
    versions = installed_versions(["kbga-bench", "no-such-distribution"])
    assert {"hypothesis", "pytest", "mypy", "no-such-distribution"} & set(versions) == set()


def test_the_packages_of_plugins_count_with_what_they_require(hostile):
    versions = provenance("m", [("hostile", "1.0")])["versions"]
    assert versions["hostile"] == "1.0"


def test_variables_that_change_numerical_code_are_kept_as_runs_have_them(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "8")
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    monkeypatch.setenv("MY_PASSWORD", "secret")
    environment = run_environment()
    assert environment["OMP_NUM_THREADS"] == "1"
    assert environment["NUMBA_CPU_NAME"] == "generic"
    assert "MY_PASSWORD" not in environment


def test_a_session_tells_machine_system_and_commit():
    session = provenance("m")
    assert 1 <= session["usable_cores"] <= session["cores"]
    assert session["memory_bytes"] > 0
    assert all(session[name] for name in ("host", "os", "cpu", "python", "started_at"))
    assert session["git"] is None or set(session["git"]) == {"commit", "dirty"}
