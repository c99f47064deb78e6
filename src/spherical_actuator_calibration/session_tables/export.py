"""A session database as CSV files and the description that it belongs to."""

import contextlib
import csv
import io
import math
import os
import pathlib
import sqlite3

from ..text_files import TextFileError, beginning_of, other_kind, write_text
from .columns import JOINTS, QUATERNION, SAMPLE_COLUMNS, TORQUE, heading

APPLICATION = 0x53414353
MAGIC = b"SQLite format 3\0"
FORMATS = range(1, 11)
FILES = ("samples.csv", "parameters.csv", "revisions.csv", "actuator.yaml")
PARAMETER_HEADINGS = (
    "revision", "date", "cycle", "coil", "name", "unit", "nominal", "initial", "value", "stddev", "observable"
)  # fmt: skip
REVISION_HEADINGS = ("revision", "date", "software", "source", "origin", "predecessor", "refined", "in_force")


class ExportError(ValueError):
    """What is wrong with a session, in a sentence that names it."""


def quaternion(rotation):
    """x, y, z, w of a rotation matrix, row by row, with w not negative."""
    r11, r12, r13, r21, r22, r23, r31, r32, r33 = rotation
    # The largest component is safe to divide by.
    squares = (1 + r11 - r22 - r33, 1 - r11 + r22 - r33, 1 - r11 - r22 + r33, 1 + r11 + r22 + r33)
    largest = max(range(4), key=lambda k: squares[k])
    columns = (
        (squares[0], r12 + r21, r13 + r31, r32 - r23),
        (r12 + r21, squares[1], r23 + r32, r13 - r31),
        (r13 + r31, r23 + r32, squares[2], r21 - r12),
        (r32 - r23, r13 - r31, r21 - r12, squares[3]),
    )
    column = columns[largest]
    norm = math.copysign(math.sqrt(sum(value * value for value in column)), column[3])
    return [value / norm for value in column]


class Session:
    """A session database that is read only, also while a node works with it."""

    def __init__(self, path):
        self.path = path
        self._require_files()
        self._database = sqlite3.connect(":memory:")
        try:
            self._copy()
            self._begin()
        except BaseException:
            self._database.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._database.close()

    def _require_files(self):
        """SQLite would open what stands at these names, and wait for ever for who writes into a FIFO."""
        kind = other_kind(self.path)
        if kind is not None:
            raise ExportError(f"{self.path}: is {kind}, not a file.")
        if not os.path.isfile(self.path):
            raise ExportError(f"{self.path}: there is no such file.")
        try:
            is_database = beginning_of(self.path, len(MAGIC)) == MAGIC
        except TextFileError as error:
            raise ExportError(str(error)) from error
        if not is_database:
            raise ExportError(f"{self.path}: cannot be read as a session: file is not a database.")
        for ending in ("-journal", "-wal", "-shm"):
            beside = os.path.realpath(self.path) + ending
            kind = other_kind(beside, follow=False)
            if kind is not None:
                raise ExportError(f"{self.path}: cannot be read while {beside} is {kind}, not a file; remove it.")

    def _copy(self):
        """One state of the session; the node, which waits while somebody reads, waits for no more than this."""
        uri = pathlib.Path(self.path).absolute().as_uri() + "?mode=ro"
        with contextlib.closing(sqlite3.connect(uri, uri=True)) as file:
            try:
                file.execute("PRAGMA user_version").fetchone()
            except sqlite3.OperationalError as error:
                if "readonly" not in str(error):
                    raise
                raise ExportError(
                    f"{self.path}: its node was ended while it stored something; start it once, which puts the file in "
                    "order, then export."
                ) from error
            file.backup(self._database)

    def _begin(self):
        self._database.row_factory = sqlite3.Row
        if self._pragma("application_id") != APPLICATION:
            raise ExportError(f"{self.path}: this is not a session database.")
        if self._pragma("user_version") not in FORMATS:
            raise ExportError(
                f"{self.path}: a newer version of this package made this session database; update the package."
            )

        self._require_tables()

    def _require_tables(self):
        """A view can be without end, and a column that is calculated of any size."""
        foreign = self.rows("SELECT type, name FROM sqlite_schema WHERE type NOT IN ('table', 'index') OR rootpage = 0")
        foreign = foreign or self.rows(
            "SELECT 'column', p.name FROM sqlite_schema AS s, pragma_table_xinfo(s.name) AS p "
            "WHERE s.type = 'table' AND p.hidden <> 0"
        )
        if foreign:
            kind, name = foreign[0]
            raise ExportError(
                f'{self.path}: holds the {kind} "{name}", which this package does not make; export a copy that '
                "nobody has changed."
            )

    def has_format(self, number):
        """Whether the session is of this format or a later one."""
        return self._pragma("user_version") >= number

    def _pragma(self, name):
        return self._database.execute(f"PRAGMA {name}").fetchone()[0]

    def rows(self, query):
        return self._database.execute(query).fetchall()

    def description(self):
        """Text of the description at the start."""
        return self.rows("SELECT description FROM unit")[0][0]

    def samples(self):
        """Headings and lines; what a sample does not have is empty."""
        currents = {}
        for row in self.rows("SELECT sample, current FROM sample_currents ORDER BY sample, coil"):
            currents.setdefault(row["sample"], []).append(row["current"])
        coils = max(map(len, currents.values()), default=0)
        headings = [heading(name, unit) for name, unit in SAMPLE_COLUMNS]
        headings += [heading(f"current_{coil}", "A") for coil in range(1, coils + 1)]
        lines = []
        for row in self.rows("SELECT * FROM samples ORDER BY id"):
            values = self._sample_values(row)
            cells = [values.get(name) for name, _ in SAMPLE_COLUMNS]
            lines.append(cells + currents.get(row["id"], []))
        return headings, lines

    @staticmethod
    def _sample_values(row):
        keys = row.keys()
        values = {key: row[key] for key in keys}
        if row["has_orientation"]:
            matrix = [row[f"r{i}{j}"] for i in (1, 2, 3) for j in (1, 2, 3)]
            values.update(zip(QUATERNION, quaternion(matrix)))
        else:
            values["orientation_stddev"] = None
        if not row["has_torque"]:
            values.update({name: None for name in (*TORQUE, "torque_stddev", "torque_shared_stddev")})
        # Of format 1 and 2.
        for name in (*(f"{joint}_shared_stddev" for joint in JOINTS), "dwell"):
            values.setdefault(name, 0)
        return values

    def parameters(self):
        """What each successful cycle identified, with the revision that it made."""
        unit = "unit" if self.has_format(4) else "'' AS unit"
        lines = self.rows(
            f"SELECT number, revisions.date, cycles.cycle, coil, name, {unit}, nominal, initial, value, stddev, observable "
            "FROM revisions JOIN cycles ON revisions.cycle = cycles.id "
            "JOIN cycle_estimates ON cycle_estimates.cycle = cycles.id ORDER BY number, position"
        )
        return PARAMETER_HEADINGS, lines

    def revisions(self):
        newest = self.rows("SELECT max(number) FROM revisions")[0][0]
        lines = [
            [*row, int(row["number"] == newest)]
            for row in self.rows(
                "SELECT number, date, software, source, origin, predecessor, refined FROM revisions ORDER BY number"
            )
        ]
        return REVISION_HEADINGS, lines


def text_of(table):
    """CSV text; numbers have the digits that give them back to the last bit."""
    headings, lines = table
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(headings)
    for line in lines:
        writer.writerow([repr(cell) if isinstance(cell, float) else cell for cell in line])
    return text.getvalue()


def export(path, folder, force):
    """Writes the files of FILES, and returns how many samples there are."""
    for name in FILES:
        target = os.path.join(folder, name)
        if os.path.exists(target) and not force:
            raise ExportError(f"{target}: the file exists already; choose another folder or give --force.")
    with Session(path) as session:
        samples = session.samples()
        texts = (text_of(samples), text_of(session.parameters()), text_of(session.revisions()), session.description())
    os.makedirs(folder, exist_ok=True)
    for name, text in zip(FILES, texts):
        write_text(os.path.join(folder, name), text)
    return len(samples[1])
