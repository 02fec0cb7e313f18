"""Kinds of files that the report writes, and parts that a results folder can do without.

Names alone, for the command line offers them before anything heavy is imported.
"""

from enum import StrEnum


class TableFormat(StrEnum):
    """How a table is written."""

    TABLE = "table"
    CSV = "csv"
    MARKDOWN = "markdown"
    LATEX = "latex"

    @property
    def suffix(self) -> str:
        """Of its files."""
        return {"table": ".txt", "csv": ".csv", "markdown": ".md", "latex": ".tex"}[self]


class FigureFormat(StrEnum):
    """Files that figures are written to."""

    PNG = "png"
    PDF = "pdf"
    SVG = "svg"

    @property
    def suffix(self) -> str:
        """Of its files."""
        return f".{self}"


class Part(StrEnum):
    """What a results folder can do without: rows, and pictures that stand in another folder.

    COMPARISONS : pictures of how the planners compare.
    PAPER_PICTURES : those like the paper's.
    SCENE_PICTURES : those of the best paths in a scene, or on a map.
    LONG_TABLES : the rows behind a table, where they are more than 150 kB: made from the runs again
        by `kbga-bench tables`.
    """

    EVENTS = "events"
    TRACES = "traces"
    PATHS = "paths"
    COMPARISONS = "comparisons"
    PAPER_PICTURES = "paper-pictures"
    SCENE_PICTURES = "scene-pictures"
    LONG_TABLES = "long-tables"
