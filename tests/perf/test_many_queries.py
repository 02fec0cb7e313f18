"""A report of a map of many queries stays small enough to be sent."""

import pytest

from suite.report.html.page import write_report
from tests.perf.many_queries import write_many

LARGEST = 3e6
"""Bytes of a page of 1,000 queries x 8 planners."""
QUERY, MARK = 60, 12
"""Bytes that a query may take of it, with its name and length, and each planner's mark of it."""


def size_of(folder, queries, planners):
    folder.mkdir()
    write_report(write_many(folder, queries, planners), folder / "many.html")
    return (folder / "many.html").stat().st_size


def test_a_query_takes_little_of_the_page(tmp_path):
    few, many = (size_of(tmp_path / str(number), number, 3) for number in (20, 140))
    assert many - few < (QUERY + 3 * MARK) * 120


@pytest.mark.slow
def test_a_thousand_queries_of_eight_planners_can_be_sent(tmp_path):
    assert size_of(tmp_path / "all", 1000, 8) < LARGEST
