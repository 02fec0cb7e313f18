"""Every fault of the table, for real: `make faults`.

python -m tests.perf.faults results/harness [--only WORDS]
"""

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.perf.faults.all_faults import FAULTS
from tests.perf.faults.fault import suffer
from tests.perf.faults.stage import first_rows
from tests.perf.faults.table import Line, line_of, write
from tests.suite.harness.hostile_site import make_site


def lines(only: str) -> list[Line]:
    """What came of each fault whose name has these words."""
    found = []
    with TemporaryDirectory(prefix="faults-") as name:
        site, first = Path(name, "site"), Path(name, "first")
        site.mkdir()
        first.mkdir()
        make_site(site)
        rows = first_rows(first, site)
        for fault in FAULTS:
            if only in fault.name:
                missing = fault.needs()
                with TemporaryDirectory(prefix="fault-") as folder:
                    outcome = None if missing else suffer(fault, Path(folder), site, rows)
                    found.append(line_of(fault, outcome, missing, Path(folder)))
                sys.stderr.write(f"{found[-1].fault}: {found[-1].verdict}\n")
    return found


def main(arguments: list[str] | None = None) -> int:
    """Try the faults, write the table and print it; 1 if one is not contained."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="", help="those whose names have these words")
    given = parser.parse_args(arguments)
    found = lines(given.only)
    sys.stdout.write(write(found, given.folder))
    return int(any(line.verdict.startswith("NOT") for line in found))


if __name__ == "__main__":
    sys.exit(main())
