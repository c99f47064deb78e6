"""What became of a unit: its revisions by date, and how far parameters went from one session to the next."""

import dataclasses
import math

from .export import ExportError, Session

ERRORS = """
SELECT revisions.number, revisions.date, revisions.origin, cycles.error_measure, cycles.samples_used,
  (SELECT error FROM cycle_errors WHERE cycle_errors.cycle = cycles.id ORDER BY iteration LIMIT 1) AS before,
  (SELECT error FROM cycle_errors WHERE cycle_errors.cycle = cycles.id ORDER BY iteration DESC LIMIT 1) AS after
FROM revisions LEFT JOIN cycles ON revisions.cycle = cycles.id ORDER BY revisions.number
"""
ERROR_UNITS = {"orientation": "rad", "torque": "N·m", "standardized": "1"}  # of each measure of errors
SHOWN = {"orientation": (1e3, "mrad"), "torque": (1e3, "mN·m"), "standardized": (1.0, "")}  # of each measure of errors


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
    """SessionHistory of each session of one unit, by date. Raises ExportError and sqlite3.Error."""
    """Lines for people: revisions of each session, and the drift from each to the next one by date. Raises ExportError
    and sqlite3.Error."""
    sessions, units = [], {}
    for path in paths:
        with Session(path) as session:
            unit = unit_of(session)
            sessions.append((path, revisions_of(session), identified(session)))
        units.setdefault(unit, path)
        if len(units) > 1:
            raise ExportError(f"{path}: is of another unit than {next(iter(units.values()))}.")
    sessions.sort(key=lambda told: told[1][-1]["date"] if told[1] else "")
    known = {}
    for path, revisions, parameters in sessions:
        yield SessionHistory(path, revisions, drift_between(known, parameters))
        known = parameters or known


def history_of(paths):
    """Lines for people: revisions of each session, and the drift from each to the next one by date. Raises as
    histories_of()."""
    for told in histories_of(paths):
        yield f"{told.path}: revision, date, made by, error before → after"
        yield from map(line_of, told.revisions)
        if told.drift is not None:
            yield "      " + sentence_of(told.drift)
