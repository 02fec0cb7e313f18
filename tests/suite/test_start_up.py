"""What the command loads before it answers, and what that costs.

Processor seconds, the least of three, against those of the least command that prints the like.
"""

import os
import subprocess
import sys

import pytest

COMMAND = "import sys; sys.argv[0] = 'kbga-bench'; from suite.cli import main; main()"


def cpu_s(*arguments: str) -> float:
    """Processor time of a process and of its children until it ended well, seconds."""
    child = subprocess.Popen([sys.executable, "-c", *arguments], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode == 0
    return used.ru_utime + used.ru_stime


LEAST = "import typer, rich.markdown, rich.table; typer.run(lambda: None)"


@pytest.fixture(scope="module")
def least_s():
    return min(cpu_s(LEAST, "--help") for _ in range(3))


@pytest.mark.parametrize(
    ("most", "arguments"),
    # Found: 1.0 to 1.3, 1.6 to 1.9, and 1.8 to 2.2; pandas would add 2.5.
    [(1.8, ("--help",)), (2.6, ("run", "--help")), (2.9, ("list", "matrices"))],
)
def test_the_command_answers_soon(least_s, most, arguments):
    assert min(cpu_s(COMMAND, *arguments) for _ in range(3)) < most * least_s


def loaded_by(code: str, *arguments: str) -> set[str]:
    """The heavy libraries that a process has loaded when it ends."""
    heavy = "{'numba', 'shapely', 'numpy', 'scipy', 'pandas', 'matplotlib', 'ompl'}"
    # On standard error: standard output is the command's, to the end.
    tell = f"print('', *{heavy} & {{*sys.modules}}, file=sys.stderr)"
    watch = f"import atexit, sys\natexit.register(lambda: {tell})\n"
    command = [sys.executable, "-c", watch + code, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return set(done.stderr.splitlines()[-1].split())


def test_help_loads_no_library_of_numbers():
    assert loaded_by(COMMAND, "--help") == set()
    assert loaded_by(COMMAND, "run", "--help") == set()


def test_the_list_of_matrices_draws_no_scene_and_imports_no_planner():
    assert loaded_by(COMMAND, "list", "matrices") <= {"numpy"}


def test_the_face_of_the_algorithm_loads_no_table_no_figure_and_no_planner_of_others():
    assert loaded_by("import kbga") <= {"numba", "shapely", "numpy", "scipy"}
