"""One table as CSV (full precision), Markdown and LaTeX (booktabs)."""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import dataclass

DIGITS = 3  # significant, in the tables that are read
LATEX = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{",
         "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": r"\textless{}", ">": r"\textgreater{}",
         "|": r"\textbar{}", "×": r"$\times$", "±": r"$\pm$", "–": "--", "—": "---", "²": r"$^2$", "α": r"$\alpha$"}


@dataclass(frozen=True)
class Value:
    """A figure with its 95 % interval; NaN ends: none. A NaN mean: nothing was measured."""

    mean: float
    low: float = math.nan
    high: float = math.nan


Field = str | int | Value


@dataclass(frozen=True)
class Table:
    """`columns` are the CSV's names, with units; `headings` what is read, and empty where the CSV alone has it. In
    LaTeX, rows are grouped by `group`."""

    columns: list[str]
    headings: list[str]
    rows: list[list[Field]]
    group: int = 0  # the column whose change draws a rule
    caption: str = ""


def latex_text(text: str) -> str:
    return "".join(LATEX.get(character, character) for character in text)


def _number(value: float) -> str:
    return f"{value:#.{DIGITS}g}".replace(".e", "e").removesuffix(".")


def _latex_number(value: float) -> str:
    mantissa, _, exponent = _number(value).partition("e")
    return mantissa if not exponent else rf"{mantissa}\times 10^{{{int(exponent)}}}"


def _plain(field: Field) -> str:
    if not isinstance(field, Value):
        return re.sub(r"([\\|*_`<>\[\]])", r"\\\1", field) if isinstance(field, str) else str(field)
    if math.isnan(field.mean):
        return "-"
    interval = "" if math.isnan(field.low) else f" [{_number(field.low)}, {_number(field.high)}]"
    return _number(field.mean) + interval


def _latex(field: Field) -> str:
    if not isinstance(field, Value):
        return latex_text(str(field))
    if math.isnan(field.mean):
        return "--"
    if math.isinf(field.mean):
        return r"$\infty$"
    value = f"${_latex_number(field.mean)}$"
    if math.isnan(field.low):
        return value
    return rf"{value} {{\scriptsize$[{_latex_number(field.low)},\,{_latex_number(field.high)}]$}}"


def csv_text(table: Table) -> str:
    """RFC 4180; each Value as three columns: NAME, NAME_low, NAME_high, empty where unknown."""
    kinds = [any(isinstance(row[i], Value) for row in table.rows) for i in range(len(table.columns))]
    header: list[str] = []
    for name, is_value in zip(table.columns, kinds):
        header += [name, f"{name}_low", f"{name}_high"] if is_value else [name]
    stream = io.StringIO()
    writer = csv.writer(stream)
    writer.writerow(header)
    for row in table.rows:
        fields: list[str] = []
        for field in row:
            ends = (field.mean, field.low, field.high) if isinstance(field, Value) else None
            fields += [str(field)] if ends is None else ["" if math.isnan(x) else repr(float(x)) for x in ends]
        writer.writerow(fields)
    return stream.getvalue()


def _read(table: Table) -> tuple[list[list[Field]], list[bool]]:
    """What is read of the rows, the headings first, and which columns are aligned at the right."""
    read = [i for i, heading in enumerate(table.headings) if heading]
    rights = [all(not isinstance(row[i], str) for row in table.rows) for i in read]
    return [[row[i] for i in read] for row in [table.headings, *table.rows]], rights


def markdown_text(table: Table) -> str:
    fields, rights = _read(table)
    rows = [[_plain(field) for field in row] for row in fields]
    widths = [max(3, *(len(row[i]) for row in rows)) for i in range(len(rights))]
    lines = ["| " + " | ".join(field.rjust(width) if right else field.ljust(width)
                               for field, width, right in zip(row, widths, rights)) + " |" for row in rows]
    rule = "|" + "|".join("-" * (width + 1) + (":" if right else "-") for width, right in zip(widths, rights)) + "|"
    return "\n".join([lines[0], rule, *lines[1:]]) + f"\n\n{table.caption}\n"


def latex_table(table: Table) -> str:
    """For \\input inside a table environment; needs \\usepackage{booktabs}. The group's name stands once."""
    (headings, *rows), rights = _read(table)
    lines = [f"% {table.caption}", "% needs \\usepackage{booktabs}",
             rf"\begin{{tabular}}{{{''.join('r' if right else 'l' for right in rights)}}}", r"\toprule",
             " & ".join(map(_latex, headings)) + r" \\", r"\midrule"]
    previous: Field | None = None
    for row in rows:
        group = row[table.group]
        if previous is not None and group != previous:
            lines.append(r"\midrule")
        fields = ["" if i == table.group and group == previous else _latex(field) for i, field in enumerate(row)]
        lines.append(" & ".join(fields) + r" \\")
        previous = group
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}"]) + "\n"


WRITERS = {"csv": csv_text, "md": markdown_text, "tex": latex_table}
