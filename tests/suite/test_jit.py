"""Machine code is kept beside the sources that it was made from, and for no others."""

import ast
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from suite.jit import sources

ROOT = Path(__file__).parents[2]
CALLED = "from suite.jit import kernel\n\n@kernel\ndef called(x):\n    return x + {added}\n"
CALLER = (
    "from suite.geometry.called import called\nfrom suite.jit import kernel\n\n"
    "@kernel\ndef caller(x):\n    return called(x)\n\nif __name__ == '__main__':\n"
    "    print(caller(1), sum(caller.stats.cache_hits.values()))\n"
)


def said(code: str, cache: Path, root: Path = ROOT) -> str:
    kept = {key: value for key, value in os.environ.items() if key != "NUMBA_DISABLE_JIT"}
    environment = {**kept, "NUMBA_CACHE_DIR": str(cache), "PYTHONPATH": str(root)}
    command = [sys.executable, *(("-m", code) if code.isidentifier() else ("-c", code))]
    done = subprocess.run(command, env=environment, cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.fixture
def two_files(tmp_path):
    """A kernel that calls one of another file of geometry."""
    geometry = tmp_path / "suite" / "geometry"
    geometry.mkdir(parents=True)
    for name in ("__init__.py", "jit.py", "geometry/__init__.py"):
        shutil.copy(ROOT / "suite" / name, tmp_path / "suite" / name)
    (geometry / "called.py").write_text(CALLED.format(added=1))
    (tmp_path / "caller.py").write_text(CALLER)
    return tmp_path


def test_a_change_in_a_file_reaches_the_machine_code_of_its_callers_in_others(two_files):
    def run() -> str:
        return said("caller", two_files / "cache", two_files)

    assert [run(), run()] == ["2 0", "2 1"]
    (two_files / "suite" / "geometry" / "called.py").write_text(CALLED.format(added=10))
    assert [run(), run()] == ["11 0", "11 1"]


@pytest.mark.parametrize(
    ("after_s", "told"), [(0.0, 1), pytest.param(1e9, 0, marks=pytest.mark.slow)]
)
def test_compiling_that_takes_its_time_is_told_once_and_beside_the_output(two_files, after_s, told):
    """By a process and by those that it starts; not when all is compiled."""
    code = (
        "import subprocess, sys; import suite.jit as jit; jit.TELL_S = float(sys.argv[1])\n"
        "from caller import caller; from suite.geometry.called import called\n"
        "print(caller(1), called(1.5), flush=True)\n"
        "sys.argv[2:] and subprocess.run([sys.executable, '-c', sys.argv[2], '0'])"
    )
    again = code.replace("1.5", "1j")
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(two_files / "c"), "NUMBA_DISABLE_JIT": "0"}
    environment = {**environment, "PYTHONPATH": str(two_files)}
    command = [sys.executable, "-c", code, str(after_s), *([again] if told else [])]

    def run():
        return subprocess.run(
            command, env=environment, cwd=two_files, capture_output=True, text=True, check=True
        )

    cold, warm = run(), run()
    assert cold.stdout.splitlines() == warm.stdout.splitlines() == ["2 2.5", "2 (1+1j)"][: 1 + told]
    assert cold.stderr.count("compiling the kernels") == told
    assert "compiling the kernels" not in warm.stderr


def test_old_machine_code_goes_when_new_is_made_and_not_before(two_files):
    kept = two_files / "cache" / "kbga-bench"
    for number in range(9):
        (kept / str(number)).mkdir(parents=True)
        os.utime(kept / str(number), (number, number))
    said("import caller", two_files / "cache", two_files)
    assert {str(number) for number in range(9)} < {folder.name for folder in kept.iterdir()}
    said("caller", two_files / "cache", two_files)
    assert {folder.name for folder in kept.iterdir()} > {"5", "6", "7", "8"}
    assert len([*kept.iterdir()]) == 5


def names_kernels(file: Path) -> bool:
    imports = [n for n in ast.walk(ast.parse(file.read_bytes())) if isinstance(n, ast.ImportFrom)]
    return any(node.module == "suite.jit" for node in imports)


def compiles_by_itself(file: Path) -> bool:
    return "njit" in file.read_text(encoding="utf-8") and file != ROOT / "suite" / "jit.py"


def test_every_file_with_kernels_is_a_source_of_the_machine_code():
    packages = [ROOT / name for name in ("suite", "kbga", "baselines")]
    files = [file for package in packages for file in package.rglob("*.py")]
    assert {file for file in files if names_kernels(file)} - {*sources()} == set()
    assert [file for file in files if compiles_by_itself(file)] == []


WATCHED_IMPORT = """
import json, sys
opened = []
sys.addaudithook(lambda event, what: opened.append(str(what[0])) if event == "open" else None)
import kbga
imported = [getattr(module, "__file__", None) for module in sys.modules.values()]
print(json.dumps([name for name in opened if name.endswith(".py") and name not in imported]))
"""


def test_importing_kbga_reads_no_file_but_what_it_imports_and_kernels_are_made_from(tmp_path):
    others = {Path(name) for name in json.loads(said(WATCHED_IMPORT, tmp_path))}
    assert {file for file in others if file.is_relative_to(ROOT)} <= {*sources()}
