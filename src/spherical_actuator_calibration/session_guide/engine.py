"""The engine of guided sessions: one course of a measurement for terminal, panel and scripts."""

import threading

import actionlib
import rospy
from spherical_actuator_calibration.rotor_readings import readings_of
from spherical_actuator_calibration.text_files import printable

from .account import Account
from .actions import CaptureAction, ExciteAction, PlanAction, SaveAction, SessionAction
from .calibration import Calibration, Topics
from .job import Job, client_of
from .laboratory import Laboratory
from .revisions import Revisions
from ..terminal import Terminal

ENDING = 1.0  # [s] for goals under way to be answered at the end


class Lane:
    """Actions that do not go together: it takes one goal at a time, and refuses others with a sentence; while an action of
    another lane works, too, which is `heeded`, a lane and the name of an action."""

    def __init__(self, heeded=None):
        self._heeded = heeded
        self._servers = {}
        self._lock = threading.Lock()
        self._job = None

    def serve(self, ns, action):
        """Offers an action, under a name beside the services of the calibration node."""

        def cancelled(handle):
            self._cancel(handle)

        def wanted(handle):
            self._take(handle, action)

        server = actionlib.ActionServer(f"{ns}/calibration/{action.name}", action.type, wanted, cancelled, False)
        self._servers[action.name] = server
        server.start()

    def _take(self, handle, action):
        with self._lock:
            previous = self._job
            job = self.running() or self._heeded_job()
            if job is None:
                self._job = Job(handle, self._servers[action.name], action, previous)
                handle.set_accepted()
                self._job.start()
        if job is not None:
            message = f"{printable(job.client)} is at it, by the action {job.name}: cancel that, or wait for its end."
            rospy.logwarn("%s of %s is refused: %s", action.name, printable(client_of(handle)), message)
            handle.set_rejected(action.failure(message, Account()), message)

    def running(self):
        """The job under way; None where there is none."""
        job = self._job
        return job if job is not None and job.is_running() else None

    def _heeded_job(self):
        if self._heeded is None:
            return None
        lane, name = self._heeded
        job = lane.running()
        return job if job is not None and job.name == name else None

    def _cancel(self, handle):
        with self._lock:
            job = self._job
        if job is not None and job.is_of(handle):
            job.cancel("its client asked for it.")

    def close(self, reason):
        """Cancels what is under way."""
        with self._lock:
            job = self.running()
        if job is not None:
            job.cancel(reason)
            job.join(ENDING)


class Engine:
    """Serves the actions capture, excite, session, plan and save of an actuator, and the service list_revisions."""

    def __init__(self, ns, actuator):
        coils = len(actuator.get("coils", []))
        self._laboratory = Laboratory(ns, coils, readings_of(ns, actuator))
        console = Terminal()
        topics = Topics(ns)
        bench = Calibration(ns, console, topics)
        at_the_bench = Lane()
        # A plan of somebody else would take the place of the one that a session follows.
        planning = Lane(heeded=(at_the_bench, SessionAction.name))
        saving = Lane()
        self._lanes = (at_the_bench, planning, saving)
        actions = (
            (CaptureAction(ns, bench, self._laboratory, coils), at_the_bench),
            (ExciteAction(ns, bench, self._laboratory, coils), at_the_bench),
            (SessionAction(ns, bench, self._laboratory), at_the_bench),
            (PlanAction(Calibration(ns, console, topics)), planning),
            (SaveAction(Calibration(ns, console, topics)), saving),
        )
        for action, lane in actions:
            lane.serve(ns, action)
        self._revisions = Revisions(ns)

    def close(self):
        """Ends what is under way; the currents are zero."""
        for lane in self._lanes:
            lane.close("the engine ends.")
        self._laboratory.release()
