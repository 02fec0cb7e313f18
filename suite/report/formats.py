"""The formats in which a table is printed: plain text, CSV, Markdown and LaTeX."""

import math
import textwrap
from collections.abc import Callable
from numbers import Integral, Real
from typing import Any

import pandas as pd
from tabulate import tabulate

from suite.report.kinds import TableFormat
from suite.report.table import Kind, Table
from suite.report.words import fixed

HEADER_WIDTH = 7
NOTE_WIDTH = 80
ROUNDING = 1e-9
"""Equal costs have a standard deviation of this order at most, which says nothing."""

ROWS_OF_A_PAGE = 40
"""In LaTeX: a table of more goes on on the next page."""

DIGITS = {Kind.MEASURE: 2, Kind.COUNT: 1, Kind.TIME: 3, Kind.P_VALUE: 4}
"""After the point."""


def render(table: Table, style: TableFormat) -> str:
    """Write a table as text, whole, with a newline at its end.

    Parameters
    ----------
    table : Table
    style : TableFormat
        CSV holds the numbers as they are, without title and note; the others round for reading.
    """
    return _RENDERERS[style](table)


def _csv(table: Table) -> str:
    return table.frame.to_csv(index=False, lineterminator="\n")


def _plain(table: Table) -> str:
    headers = [_broken(str(c)) for c in table.frame.columns]
    height = max(map(len, headers), default=0)
    padded = ([""] * (height - len(header)) + header for header in headers)
    top = [list(line) for line in zip(*padded, strict=True)]
    # As rows: tabulate would make room for two more characters in each heading.
    cells = top + as_texts(table).to_numpy().tolist()
    lines = tabulate(
        cells, tablefmt="plain", disable_numparse=True, colalign=_alignment(table)
    ).splitlines()
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    lines.insert(height, "  ".join("-" * width for width in widths))
    title, note = (textwrap.fill(text, NOTE_WIDTH) for text in (table.title, table.note))
    return "\n".join([title, "", *lines, _below(note)])


def _broken(header: str) -> list[str]:
    """A heading in lines: numbers are narrower than their names."""
    return textwrap.wrap(header, HEADER_WIDTH, break_long_words=False, break_on_hyphens=False)


def _markdown(table: Table) -> str:
    grid = tabulate(
        as_texts(table).to_numpy().tolist(),
        headers=[str(c) for c in table.frame.columns],
        tablefmt="pipe",
        disable_numparse=True,
        colalign=_alignment(table) if len(table.frame) else None,
    )
    return f"### {table.title}\n\n{grid}\n{_below(table.note)}"


def _alignment(table: Table) -> list[str]:
    return ["right" if is_numeric(table.frame[c]) else "left" for c in table.frame.columns]


def _latex(table: Table) -> str:
    columns = "".join("r" if is_numeric(table.frame[c]) else "l" for c in table.frame.columns)
    body = as_texts(table).style.hide(axis="index").format(escape="latex")
    body = body.format_index(_stacked, escape="latex", axis=1)
    goes_on = len(table.frame) > ROWS_OF_A_PAGE
    caption = _escaped(f"{table.title}. {table.note}".strip())
    written = body.to_latex(
        column_format=columns,
        hrules=True,
        caption=caption,
        label=f"tab:{table.name}",
        position_float=None if goes_on else "centering",
        environment="longtable" if goes_on else None,
    )
    written = _small(str(written), caption, table.title) if goes_on else _fitted(str(written))
    # LaTeX's own fonts have another sign in its place.
    return _PACKAGES + "\n" + written.replace("<", "$<$")


_PACKAGES = r"% \usepackage{booktabs,graphicx,longtable}"


def _stacked(header: object) -> str:
    lines = r"\\".join(_broken(str(header)))
    return rf"\shortstack{{{lines}}}"


def _fitted(written: str) -> str:
    """Scaled down to the width of the line, if wider."""
    scale = r"\resizebox{\ifdim\width>\linewidth\linewidth\else\width\fi}{!}{%"
    written = written.replace(r"\begin{tabular}", f"{scale}\n\\begin{{tabular}}")
    return written.replace(r"\end{tabular}", "\\end{tabular}}")


def _small(written: str, caption: str, title: str) -> str:
    """In small letters and narrow columns, as several pages can't be scaled; one note is enough."""
    again = rf"\caption[]{{{_escaped(title)}, continued}}"
    written = written.replace(rf"\caption[]{{{caption}}}", again)
    return f"{{\\scriptsize\\setlength{{\\tabcolsep}}{{3pt}}\n{written}}}\n"


_RENDERERS: dict[TableFormat, Callable[[Table], str]] = {
    TableFormat.TABLE: _plain,
    TableFormat.CSV: _csv,
    TableFormat.MARKDOWN: _markdown,
    TableFormat.LATEX: _latex,
}


def _below(note: str) -> str:
    return f"\n{note}\n" if note else ""


def _escaped(text: str) -> str:
    return text.replace("%", r"\%").replace("_", r"\_").replace("&", r"\&").replace("#", r"\#")


def is_numeric(column: "pd.Series[Any]") -> bool:
    """Whether a column holds numbers, or nothing else that is there."""
    if pd.api.types.is_numeric_dtype(column):
        return True
    # Counts and measures in one column are objects, so that counts stay whole.
    values = [value for value in column if not _is_missing(value)]
    return bool(values) and all(isinstance(value, Real) for value in values)


def _is_missing(value: Any) -> bool:
    return value is None or value is pd.NA or (isinstance(value, float) and math.isnan(value))


def as_texts(table: Table) -> pd.DataFrame:
    """The cells as they are printed for reading; missing ones are empty."""
    columns = {}
    for name in table.frame.columns:
        kind = table.kind(str(name))
        infinite = table.infinite_in.get(str(name), table.infinite)
        columns[name] = [
            infinite if _is_infinite(value) else _as_text(value, kind)
            for value in table.frame[name]
        ]
    return pd.DataFrame(columns)


def _is_infinite(value: Any) -> bool:
    return isinstance(value, float) and math.isinf(value)


def _as_text(value: Any, kind: Kind) -> str:
    if _is_missing(value):
        return ""
    if isinstance(value, bool | str) or not isinstance(value, Real):
        return str(value)
    if isinstance(value, Integral):
        return str(value)
    number = float(value)
    number = number if abs(number) > ROUNDING else 0.0
    if kind in DIGITS:
        return fixed(number, DIGITS[kind])
    if kind is Kind.PRINTED:
        return f"{number:.0f}" if number.is_integer() else f"{number:.2f}"
    if number.is_integer() and abs(number) >= 10:
        return f"{number:.0f}"
    # Three significant digits of what is small: times of ours, in the paper's seconds.
    return f"{number:.2f}" if abs(number) >= 1 or number == 0 else f"{number:#.3g}"
