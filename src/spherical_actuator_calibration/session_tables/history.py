"""What became of a unit: its revisions by date, and how far parameters went from one session to the next."""

import dataclasses
import math
import sqlite3

from ..parameter_drift import Drift, drifts_between
from ..shown_numbers import change_of
from .export import ExportError, Session

ERRORS = """
SELECT revisions.number, revisions.date, revisions.origin, {error_unit}, cycles.samples_used,
  (SELECT error FROM cycle_errors WHERE cycle_errors.cycle = cycles.id ORDER BY iteration LIMIT 1) AS before,
  (SELECT error FROM cycle_errors WHERE cycle_errors.cycle = cycles.id ORDER BY iteration DESC LIMIT 1) AS after
FROM revisions LEFT JOIN cycles ON revisions.cycle = cycles.id ORDER BY revisions.number
"""
# Formats before 10 do not tell it; what they meant does not change any more.
ERROR_UNIT_BEFORE_10 = (
    "CASE cycles.error_measure WHEN 'orientation' THEN 'rad' WHEN 'torque' THEN 'N·m' WHEN 'standardized' THEN '1' END"
)
# What a damaged session gives instead of its rows.
UNREADABLE = (ExportError, OSError, sqlite3.Error, LookupError, TypeError, ValueError, OverflowError)
NUMBER = (int, float, type(None))
KINDS = {  # of what a revision holds
    "number": int,
    "date": str,
    "origin": str,
    "error_unit": (str, type(None)),
    "samples_used": (int, type(None)),
    "before": NUMBER,
    "after": NUMBER,
}


def revisions_of(session):
    """Rows of a Session by their number: number, date, origin, error_unit, samples_used, before, after."""
    error_unit = "cycles.error_unit" if session.has_format(10) else ERROR_UNIT_BEFORE_10
    return session.rows(ERRORS.format(error_unit=f"{error_unit} AS error_unit"))


def identified(session):
    """Name to (value, stddev, unit) as the last successful cycles left them; without those that nothing identified."""
    _, lines = session.parameters()
    found = {row["name"]: (row["value"], row["stddev"], row["unit"]) for row in lines if row["observable"]}
    return {name: told for name, told in found.items() if told[1] is not None and math.isfinite(told[1])}


def line_of(row):
    """A revision in one line."""
    text = f"{row['number']:4d}  {row['date']}  {row['origin']:<12}"
    if row["before"] is None or row["after"] is None:
        return text.rstrip()
    used = "windows" if row["origin"] == "motion" else "samples"  # a motion is estimated from windows
    return f"{text}  {change_of(row['before'], row['after'], row['error_unit'])}, {row['samples_used']} {used}"


@dataclasses.dataclass(frozen=True)
class SessionHistory:
    """What became of a unit in one session."""

    path: str
    revisions: list  # see revisions_of()
    drift: Drift = None  # that went furthest since the session before; None without a common parameter


def sentence_of(drift):
    """A Drift for people."""
    return (
        f"furthest from the session before: {drift.name} by {drift.change:+.3g} {drift.unit}, "
        f"{drift.deviations:.1f} standard deviations of the change"
    )


def unit_of(session):
    """Name and serial number of the unit of a Session. Histories are of units that agree in both: what a session without
    serial number was of, nobody knows."""
    return tuple(session.rows("SELECT name, serial FROM unit")[0])


def histories_of(paths):
    """SessionHistory of each session of one unit that can be read, by date, and a sentence on each that cannot, which names
    it. Raises ExportError where they are of different units."""
    sessions, units, unread = [], {}, []
    for path in paths:
        try:
            unit, revisions, parameters = _read(path)
        except UNREADABLE as error:
            unread.append(why_unread(path, error))
            continue
        units.setdefault(unit, path)
        if len(units) > 1:
            raise ExportError(f"{path}: is of another unit than {next(iter(units.values()))}.")
        sessions.append((path, revisions, parameters))
    sessions.sort(key=lambda told: told[1][-1]["date"] if told[1] else "")
    histories, known = [], {}
    for path, revisions, parameters in sessions:
        furthest = next(iter(drifts_between(known, parameters)), None)
        histories.append(SessionHistory(path, revisions, furthest))
        known = parameters or known
    return histories, unread


def why_unread(path, error):
    """A sentence that names the session, of what UNREADABLE holds."""
    return str(error) if isinstance(error, ExportError) else f"{path}: cannot be read as a session: {error}."


def _read(path):
    """Unit, revisions and identified parameters of a session. Raises what UNREADABLE holds."""
    with Session(path) as session:
        unit, revisions, parameters = unit_of(session), revisions_of(session), identified(session)
    for row in revisions:
        if not all(isinstance(row[name], kinds) for name, kinds in KINDS.items()):
            raise ExportError(f"{path}: a revision in it is not as this package writes them.")
    return unit, revisions, parameters


def lines_of(history):
    """A SessionHistory for people."""
    yield f"{history.path}: revision, date, made by, error before → after"
    yield from map(line_of, history.revisions)
    if history.drift is not None:
        yield "      " + sentence_of(history.drift)
