"""Every fault of the table, for real: `make faults`.

python -m tests.perf.faults results/harness [--only PATTERN]
"""

import argparse
import re
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.perf.faults.all_faults import FAULTS
from tests.perf.faults.fault import suffer
from tests.perf.faults.stage import first_rows
from tests.perf.faults.table import Line, line_of, write
from tests.suite.harness.hostile_site import make_site


def lines(only: str) -> list[Line]:
    """What came of each fault whose name matches a pattern."""
    found = []
    with TemporaryDirectory(prefix="faults-") as name:
        site, first = Path(name, "site"), Path(name, "first")
        site.mkdir()
        first.mkdir()
        make_site(site)
        rows = first_rows(first, site)
        for fault in FAULTS:
            if re.search(only, fault.name):
                missing = fault.needs()
                with TemporaryDirectory(prefix="fault-") as folder:
                    outcome = None if missing else suffer(fault, Path(folder), site, rows)
                    line = line_of(fault, outcome, missing, Path(folder))
                found.append(line)
                is_bad = line.verdict.startswith("NOT")
                words = f"\n    {line.words}\n    {line.row}" if is_bad else ""
                sys.stderr.write(f"{line.fault}: {line.verdict}{words}\n")
    return found


def main(arguments: list[str] | None = None) -> int:
    """Try the faults, write the table and print it; 1 if one is not contained."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="", help="those whose names match this pattern")
    given = parser.parse_args(arguments)
    found = lines(given.only)
    sys.stdout.write(write(found, given.folder, [fault.name for fault in FAULTS]))
    return int(any(line.verdict.startswith("NOT") for line in found))


if __name__ == "__main__":
    sys.exit(main())
