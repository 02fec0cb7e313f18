"""What every command line has: a version, help by -h, completion, and a module that is run."""

import os
import subprocess
import sys
from importlib.metadata import version

import pytest

from suite.cli import COMMANDS, main


def said(*arguments, **environment):
    done = subprocess.run(
        [sys.executable, *arguments],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, **environment},
    )
    return done.stdout


@pytest.mark.parametrize("module", ["suite", "kbga"])
def test_each_module_that_can_be_run_is_the_command(module):
    assert said("-m", module, "--version") == f"kbga-bench {version('kbga-bench')}\n"
    assert "Usage: kbga-bench " in said("-m", module, "-h")


def test_every_command_has_its_help_by_one_letter(monkeypatch, capsys):
    for name in COMMANDS:
        texts = []
        for option in ("-h", "--help"):
            monkeypatch.setattr(sys, "argv", ["kbga-bench", name, option])
            with pytest.raises(SystemExit) as ended:
                main()
            assert ended.value.code == 0
            texts.append(capsys.readouterr().out)
        assert f"Usage: kbga-bench {name} " in texts[0]
        assert texts[0] == texts[1]


def test_the_shell_completes_names_of_commands_and_their_options():
    script = said("-m", "suite", _KBGA_BENCH_COMPLETE="source_bash")
    assert "_KBGA_BENCH_COMPLETE=complete_bash" in script
    assert script.rstrip().endswith("kbga-bench")

    def completed(line):
        words = {"COMP_WORDS": line, "COMP_CWORD": str(len(line.split()) - 1)}
        return said("-m", "suite", _KBGA_BENCH_COMPLETE="complete_bash", **words).split()

    assert completed("kbga-bench st") == ["status"]
    assert completed("kbga-bench run --only") == ["--only-failed"]
    assert completed("kbga-bench list plan") == ["planners"]
