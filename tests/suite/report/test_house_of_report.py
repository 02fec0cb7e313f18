"""The rooms of the report: imports go downstairs only."""

import ast
from pathlib import Path

import pytest

REPORT = Path(__file__).parents[3] / "suite" / "report"
FLOORS = (
    {"words", "kinds", "rows", "table", "formats"},
    {"statistics"},
    {"tables"},
    {"figures"},
    {"paper"},
    {"all_tables"},
    {"export", "html"},
    {"results_folder"},
)
FILES = [path for path in sorted(REPORT.rglob("*.py")) if path != REPORT / "__init__.py"]


def floor(room: str) -> int:
    return next(number for number, rooms in enumerate(FLOORS) if room in rooms)


def rooms_of(path: Path) -> set[str]:
    """Rooms of the report that a file imports from."""
    names = [
        f"{node.module}.{alias.name}".split(".")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    ]
    return {parts[2] for parts in names if parts[:2] == ["suite", "report"]}


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(REPORT)))
def test_a_room_of_the_report_imports_from_itself_and_from_below(path):
    room = path.relative_to(REPORT).with_suffix("").parts[0]
    above = {other for other in rooms_of(path) if floor(other) > floor(room)}
    beside = {o for o in rooms_of(path) - {room} if floor(o) == floor(room) > 0}
    assert above | beside == set()
