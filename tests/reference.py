"""The reference of the Python interface, made by pdoc of the docstrings.

python -m tests.reference out/docs

pdoc knows numpy's sections. What our docstrings have besides, fields of a class and tables, is
rewritten for it: it would run their lines together.
"""

import re
import sys
import warnings
from itertools import pairwise
from pathlib import Path

import pdoc
from pdoc import docstrings, render

SECTION = re.compile(r"^[A-Z]\w+(?: [A-Z]\w+)*\n-{3,}$", re.MULTILINE)
FIELD = re.compile(r"^([\w*]+(?:, [\w*]+)*) : (.+(?:\n {4}.+)*)\n?", re.MULTILINE)
RULE = r"=+(?: +=+)+"
TABLE = re.compile(rf"^({RULE})\n(.+\n)\1\n((?:.+\n)+?)\1$", re.MULTILINE)


def prepared(docstring: str) -> str:
    """Fields of a class as a list, and tables, in Markdown."""
    found = SECTION.search(docstring)
    start = len(docstring) if found is None else found.start()
    text = FIELD.sub(_item, docstring[:start]) + docstring[start:]
    return TABLE.sub(_table, text).replace("::\n", ":\n")


def _item(field: re.Match[str]) -> str:
    return f"- **{field[1]}**: {field[2]}\n"


def _table(table: re.Match[str]) -> str:
    starts = [found.start() for found in re.finditer("=+", table[1])]
    spans = [slice(*ends) for ends in pairwise([*starts, None])]
    rows: list[list[str]] = []
    for line in f"{table[2]}{table[3]}".splitlines():
        cells = [line[span].strip().replace("*", r"\*") for span in spans]
        if cells[0] or not rows:
            rows.append(cells)
        else:  # the line before goes on
            pairs = zip(rows[-1], cells, strict=True)
            rows[-1] = [f"{above} {cell}".strip() for above, cell in pairs]
    head, *body = [f"| {' | '.join(row)} |" for row in rows]
    return "\n".join(["", head, "|---" * len(spans) + "|", *body, ""])


def write_reference(folder: Path, *modules: str) -> None:
    """Write a page for each module."""
    numpy_sections = docstrings.numpy
    docstrings.numpy = lambda text: numpy_sections(prepared(text))
    render.configure(docformat="numpy", search=True)
    with warnings.catch_warnings():
        # Types that a module knows while it is checked only.
        warnings.filterwarnings("ignore", message="Error parsing type annotation")
        pdoc.pdoc(*modules, output_directory=folder)


if __name__ == "__main__":
    write_reference(Path(sys.argv[1]), "suite", "kbga", "baselines")
