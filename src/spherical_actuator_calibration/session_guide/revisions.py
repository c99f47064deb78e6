"""The service that tells what became of the unit, for those who cannot read session databases."""

import math
import pathlib
import sqlite3
import threading

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from spherical_actuator_calibration.msg import Revision
from spherical_actuator_calibration.srv import ListRevisions, ListRevisionsResponse
from spherical_actuator_calibration.text_files import printable

from ..session_tables.export import ExportError, Session
from ..session_tables.history import ERROR_UNITS, histories_of, sentence_of, unit_of

DATABASE = "session.db"
DIRECTORY = "directory"  # key of the diagnostics that tell the calibration directory
PATIENCE = 3.0  # [s] for the diagnostics of the calibration node, which come every second
MOST_SESSIONS = 20  # beside the present one, the newest ones


class Revisions:
    """Serves calibration/list_revisions."""

    def __init__(self, ns):
        self._prefix = f"{ns[1:]}/calibration: "
        self._directory = None
        self._is_known = threading.Event()
        self._subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self._keep)
        self._service = rospy.Service(f"{ns}/calibration/list_revisions", ListRevisions, self._list)

    def _keep(self, message):
        for status in message.status:
            if status.name.startswith(self._prefix):
                self._directory = next((pair.value for pair in status.values if pair.key == DIRECTORY), self._directory)
        if self._directory is not None:
            self._is_known.set()

    def _list(self, _request):
        if not self._is_known.wait(PATIENCE):
            return ListRevisionsResponse(message="The calibration node does not tell its directory: is it running?")
        present = pathlib.Path(self._directory) / DATABASE
        try:
            revisions = revisions_told(present, sessions_beside(present))
        except (ExportError, OSError, sqlite3.Error) as error:
            return ListRevisionsResponse(message=printable(f"The session cannot be read: {error}"))
        count = sum(revision.restorable for revision in revisions)
        message = f"{count} revision{'' if count == 1 else 's'} of this session."
        return ListRevisionsResponse(success=True, message=message, revisions=revisions)


def sessions_beside(present):
    """Paths of session databases of the same unit in folders beside that of `present`; what cannot be read is left out.
    Raises ExportError and sqlite3.Error of `present`."""
    with Session(present) as session:
        unit = unit_of(session)
    own = present.parent.resolve()
    others = [path for path in own.parent.glob("*/" + DATABASE) if path.parent.resolve() != own]
    return [path for path in sorted(others, key=_time_of, reverse=True)[:MOST_SESSIONS] if _is_of(path, unit)]


def _time_of(path):
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def _is_of(path, unit):
    try:
        with Session(path) as session:
            return unit_of(session) == unit
    except (ExportError, OSError, sqlite3.Error, LookupError):
        return False


def revisions_told(present, others):
    """Revision messages of the session `present` and of others of the same unit."""
    told = []
    for history in histories_of([*others, present]):
        revisions = [_revision(row, history.path, history.path == present) for row in history.revisions]
        if history.drift is not None and revisions:
            revisions[-1].drift = sentence_of(history.drift)
        told += revisions
    return told


def _revision(row, path, is_present):
    is_told = row["before"] is not None and row["after"] is not None
    return Revision(
        session=str(path),
        restorable=is_present,
        number=row["number"],
        date=row["date"],
        origin=row["origin"],
        error_before=row["before"] if is_told else math.nan,
        error_after=row["after"] if is_told else math.nan,
        error_unit=ERROR_UNITS.get(row["error_measure"], "") if is_told else "",
        samples_used=row["samples_used"] or 0,
    )
