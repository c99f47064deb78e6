"""CSV files of foreign origin, read with errors that name file, line and column."""

import csv
import io
import json
import math
import re

from spherical_actuator_calibration.text_files import excerpt, read_bytes

from .columns import UNITS

LARGEST = 1 << 30  # [bytes] of a file
LONGEST_TEXT = 1 << 16  # [characters] of a cell


SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs"}
DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+([eE][+-]?\d+)?")


class TableError(ValueError):
    """What is wrong with a file, in a sentence that names it."""


def named(heading):
    """Name and unit of a heading such as "joint_1 [deg]"; the unit is empty where there is none."""
    text = heading.strip()
    if text.endswith("]") and "[" in text:
        name, _, unit = text[:-1].rpartition("[")
        return name.strip(), unit.strip()
    return text, ""


def parsed(text, kind):
    """A number as programs write it: Python reads 1_000 and digits of other scripts, too. Raises what `kind` does, and
    ValueError."""
    if "_" in text or not text.isascii():
        raise ValueError(text)
    return kind(text)


def _are_numbers(cells, decimal):
    try:
        return bool([parsed(cell.strip().replace(decimal, "."), float) for cell in cells if cell.strip()])
    except ValueError:
        return False


class Row:
    """One line of numbers."""

    def __init__(self, table, line, cells):
        self.table = table
        self.line = line
        self._cells = cells

    def fail(self, sentence, column=None):
        """Raises TableError: file, line, column if any, sentence."""
        place = f"{self.table.path}:{self.line}: "
        if column is not None:
            place += f"column {column + 1} ({self.table.titles[column]}): "
        raise TableError(place + sentence)

    def text(self, column):
        """A cell without blanks around it; empty where the line is shorter."""
        return self._cells[column].strip() if column < len(self._cells) else ""

    def is_empty(self, column):
        return not self.text(column)

    def figure(self, column):
        """The text of a number, with a point where the table has decimal commas."""
        text = self.text(column)
        is_by_comma = self.table.decimal == "," and text.count(",") == 1 and "." not in text
        return text.replace(",", ".") if is_by_comma else text

    def number(self, column, factor=1.0):
        """A finite number."""
        text = self.text(column)
        try:
            value = parsed(self.figure(column), float) * factor
        except ValueError:
            self.fail(f'"{excerpt(text, 40)}" is not a number{self._about_commas(text)}.', column)
        if not math.isfinite(value):
            self.fail(f'"{excerpt(text, 40)}" is not a finite number.', column)
        return value

    def _about_commas(self, text):
        is_by_comma = self.table.decimal == "." and DECIMAL_COMMA.fullmatch(text)
        if not is_by_comma:
            return ""
        return "; for decimal commas " + (
            'give the stream the key decimal: ","'
            if self.table.is_of_stream
            else "let semicolons separate the columns, or write points"
        )

    def integer(self, column, smallest=0, largest=(1 << 63) - 1):
        """A whole number."""
        text = self.text(column)
        try:
            value = parsed(text, int)
        except ValueError:
            self.fail(f'"{excerpt(text, 40)}" is not a whole number.', column)
        if not smallest <= value <= largest:
            self.fail(f"{excerpt(value, 40)} is outside [{smallest}, {largest}].", column)
        return value


class Table:
    """A CSV file with a line of headings. `headings`: which line that is, from 1, or the first after it that is neither
    empty nor begins with #; what is before it is left out. Where numbers stand there, the line with # before them.
    `separator` None: by commas, or as spreadsheets save it where commas are decimal, by semicolons. `decimal`: the mark
    in numbers."""

    def __init__(self, path, headings=1, separator=",", decimal="."):
        self.path = path
        self.is_of_stream = separator is not None
        text = read_bytes(path, LARGEST).decode("utf-8-sig", errors="replace")
        if separator is None:
            separator, decimal = self._dialect(text)
        self.decimal = decimal
        self._lines = self._filled(self._read(text, headings, separator))
        self._first, self.titles = next(self._lines, (0, None))
        if not self.titles:
            raise TableError(f"{path}: there is no line {headings} with headings.")
        self.titles = [title.strip() or f"column {number}" for number, title in enumerate(self.titles, 1)]
        self._require_separated(separator)

    @staticmethod
    def _dialect(text):
        """Separator and decimal mark, by the first line that is no remark."""
        for line in text.splitlines():
            if line.strip() and not line.startswith("#"):
                return (";", ",") if ";" in line else (",", ".")
        return ",", "."

    def _read(self, text, headings, separator):
        csv.field_size_limit(LONGEST_TEXT)
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator)
        while True:
            try:
                cells = next(reader)
            except StopIteration:
                return
            except csv.Error as error:
                raise TableError(f"{self.path}:{reader.line_num}: {error}.") from error
            if reader.line_num >= headings:
                yield reader.line_num, cells

    def _filled(self, lines):
        """The headings, then the lines after them; empty ones, and those that begin with #, are left out."""
        remark, has_headings = None, False
        for line, cells in lines:
            is_for_spreadsheets = not has_headings and cells and cells[0].lower().startswith("sep=")
            if is_for_spreadsheets or not any(cell.strip() for cell in cells):
                continue
            if cells[0].startswith("#"):
                remark = line, [cells[0].lstrip("# "), *cells[1:]]
                continue
            if not has_headings and remark and len(remark[1]) == len(cells) and _are_numbers(cells, self.decimal):
                yield remark
            has_headings = True
            yield line, cells

    def _require_separated(self, separator):
        for other, name in SEPARATORS.items():
            if len(self.titles) == 1 and other != separator and other in self.titles[0]:
                self.fail(
                    f"{name} separate the headings: write commas in their place, or give streams the key "
                    f"separator: {json.dumps(other)}."
                )

    def rows(self):
        """The lines after the headings."""
        for line, cells in self._lines:
            row = Row(self, line, cells)
            if len(cells) > len(self.titles):
                row.fail(f"{len(cells)} cells, but {len(self.titles)} headings.")
            yield row

    def fail(self, sentence):
        """Raises TableError: file, line of the headings, sentence."""
        raise TableError(f"{self.path}:{self._first}: {sentence}")

    def column(self, which):
        """Index of a column by its number, from 1, or by its heading, which must be the only one."""
        if isinstance(which, int):
            if not 1 <= which <= len(self.titles):
                self.fail(f"there is no column {which}: it has {len(self.titles)}.")
            return which - 1
        found = [index for index, title in enumerate(self.titles) if which in (title, named(title)[0])]
        if len(found) != 1:
            several = f"{len(found)} columns are called so; name one by its number" if found else "there is no such column"
            self.fail(f'"{which}": {several}.')
        return found[0]

    def factor(self, column, unit):
        """From the unit of a heading, `unit` where it names none, to that unit of UNITS."""
        told = named(self.titles[column])[1] or unit
        if told not in UNITS[unit]:
            known = ", ".join(UNITS[unit])
            self.fail(f"column {column + 1} ({self.titles[column]}): the unit must be one of {known}.")
        return UNITS[unit][told]
