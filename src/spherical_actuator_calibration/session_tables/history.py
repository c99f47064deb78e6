"""What became of a unit: its revisions by date, and how far parameters went from one session to the next."""

import dataclasses
import math
import sqlite3

from .export import ExportError, Session

ERRORS = """
SELECT revisions.number, revisions.date, revisions.origin, cycles.error_measure, cycles.samples_used,
  (SELECT error FROM cycle_errors WHERE cycle_errors.cycle = cycles.id ORDER BY iteration LIMIT 1) AS before,
  (SELECT error FROM cycle_errors WHERE cycle_errors.cycle = cycles.id ORDER BY iteration DESC LIMIT 1) AS after
FROM revisions LEFT JOIN cycles ON revisions.cycle = cycles.id ORDER BY revisions.number
"""
ERROR_UNITS = {"orientation": "rad", "torque": "N·m", "standardized": "1"}  # of each measure of errors
SHOWN = {"orientation": (1e3, "mrad"), "torque": (1e3, "mN·m"), "standardized": (1.0, "")}  # of each measure of errors
# What a damaged session gives instead of its rows.
UNREADABLE = (ExportError, OSError, sqlite3.Error, LookupError, TypeError, ValueError, OverflowError)
NUMBER = (int, float, type(None))
KINDS = {  # of what a revision holds
    "number": int,
    "date": str,
    "origin": str,
    "error_measure": (str, type(None)),
    "samples_used": (int, type(None)),
    "before": NUMBER,
    "after": NUMBER,
}


@dataclasses.dataclass(frozen=True)
class Drift:
    """What changed between two sessions: the parameter that went furthest for what is known of it."""

    name: str
    change: float  # in the unit of the parameter
    unit: str
    deviations: float  # the change by its standard deviation


def revisions_of(session):
    """Rows of a Session by their number: number, date, origin, error_measure, samples_used, before, after."""
    return session.rows(ERRORS)


def identified(session):
    """Name to (value, stddev, unit) as the last successful cycles left them; without those that nothing identified."""
    _, lines = session.parameters()
    found = {row["name"]: (row["value"], row["stddev"], row["unit"]) for row in lines if row["observable"]}
    return {name: told for name, told in found.items() if told[1] is not None and math.isfinite(told[1])}


def drift_between(before, after):
    """Drift from one session's identified() to the next one's, which shares no sample with it; None without a common
    parameter."""
    drifts = []
    for name in before.keys() & after.keys():
        (old, old_stddev, _), (new, new_stddev, unit) = before[name], after[name]
        change = math.remainder(new - old, math.tau) if unit == "rad" else new - old
        stddev = math.hypot(old_stddev, new_stddev)
        drifts.append(Drift(name, change, unit, abs(change) / stddev if stddev else math.inf))
    return max(drifts, key=lambda drift: (drift.deviations, drift.name), default=None)


def line_of(row):
    """A revision in one line."""
    text = f"{row['number']:4d}  {row['date']}  {row['origin']:<12}"
    if row["before"] is None or row["after"] is None:
        return text.rstrip()
    factor, unit = SHOWN.get(row["error_measure"], (1.0, row["error_measure"]))
    return f"{text}  {factor * row['before']:.4g} → {factor * row['after']:.4g} {unit}".rstrip() + f", {row['samples_used']} samples"


@dataclasses.dataclass(frozen=True)
class SessionHistory:
    """What became of a unit in one session."""

    path: str
    revisions: list  # see revisions_of()
    drift: Drift = None  # since the session before; None without a common parameter


def sentence_of(drift):
    """A Drift for people."""
    return (
        f"furthest from the session before: {drift.name} by {drift.change:+.3g} {drift.unit}, "
        f"{drift.deviations:.1f} standard deviations of the change"
    )


def unit_of(session):
    """Name and serial number of the unit of a Session."""
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
        histories.append(SessionHistory(path, revisions, drift_between(known, parameters)))
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
