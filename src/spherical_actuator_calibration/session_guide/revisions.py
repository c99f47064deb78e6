"""The service that tells what became of the unit, for those who cannot read session databases."""

import math
import pathlib
import threading

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from spherical_actuator_calibration.msg import Revision
from spherical_actuator_calibration.srv import ListRevisions, ListRevisionsResponse
from spherical_actuator_calibration.text_files import printable

from ..session_tables.export import ExportError, Session
from ..session_tables.history import UNREADABLE, histories_of, sentence_of, unit_of, why_unread

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
            others, unread = sessions_beside(present)
            revisions, damaged = revisions_told(present, others)
        except UNREADABLE as error:
            return ListRevisionsResponse(message=printable(f"The session cannot be read: {error}"))
        unread = [printable(sentence) for sentence in (*unread, *damaged)]
        count = sum(revision.restorable for revision in revisions)
        message = f"{count} revision{'' if count == 1 else 's'} of this session."
        if unread:
            message += f" Left out, as they cannot be read: {' '.join(unread)}"
        return ListRevisionsResponse(success=True, message=message, revisions=revisions, unread=unread)


def sessions_beside(present):
    """Paths of session databases of the same unit in folders beside that of `present`, and a sentence on each whose unit
    cannot be read. Raises what UNREADABLE holds where `present` cannot."""
    with Session(present) as session:
        unit = unit_of(session)
    own = present.parent.resolve()
    others = [path for path in own.parent.glob("*/" + DATABASE) if path.parent.resolve() != own]
    found, unread = [], []
    for path in sorted(others, key=_time_of, reverse=True)[:MOST_SESSIONS]:
        try:
            with Session(path) as session:
                if unit_of(session) == unit:
                    found.append(path)
        except UNREADABLE as error:
            unread.append(why_unread(path, error))
    return found, unread


def _time_of(path):
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def revisions_told(present, others):
    """Revision messages of the session `present` and of others of the same unit, and a sentence on each of these that
    cannot be read. Raises ExportError where `present` cannot."""
    histories, unread = histories_of([*others, present])
    if not any(history.path == present for history in histories):
        raise ExportError(unread[-1])
    told = []
    for history in histories:
        revisions = [_revision(row, history.path, history.path == present) for row in history.revisions]
        if history.drift is not None and revisions:
            revisions[-1].drift = sentence_of(history.drift)
        told += revisions
    return told, unread


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
        error_unit=row["error_unit"] if is_told else "",
        samples_used=row["samples_used"] or 0,
    )
