"""One goal of an action under way: it is followed, cancelled, and ends."""

import threading

import rospy
from spherical_actuator_calibration.text_files import printable

from .account import Account
from .task import Cancelled, Task

PERIOD = 0.1  # [s] between two messages of feedback
PATIENCE = 5.0  # [s] in which a client is to subscribe to the feedback


class Followers:
    """Whether the client of a goal still subscribes to the action's feedback: the only sign of its life."""

    def __init__(self, publisher, client):
        self._publisher = publisher
        self._client = client
        self._was_there = False
        self._end = Task.time() + PATIENCE

    def complaint(self):
        """Why the goal is to be cancelled, in a sentence; empty while its client is there."""
        if any(link.endpoint_id == self._client for link in self._publisher.impl.connections):
            self._was_there = True
            return ""
        if self._was_there:
            return f"{self._client} has gone."
        return f"{self._client} does not follow the feedback." if Task.time() > self._end else ""


class Job:
    """Runs the work of one accepted goal, of an action as they are in actions.py, in a thread of its own. The hands of
    its lane are free as soon as it is cancelled, and at its end; the client is answered after that."""

    def __init__(self, handle, server, action, previous):
        self.task = Task()
        self.client = client_of(handle)
        self.name = action.name
        self._account = Account()
        self._handle = handle
        self._action = action
        self._followers = Followers(server.feedback_pub, self.client)
        self._is_answered = threading.Event()
        self._ending = threading.Lock()
        self._thread = threading.Thread(target=self._run, args=(previous,), daemon=True)
        self._beat = threading.Thread(target=self._follow, daemon=True)

    def start(self):
        self._thread.start()
        self._beat.start()

    def is_of(self, handle):
        return self._handle == handle

    def is_running(self):
        """Whether it may still do anything that it is asked for."""
        return not self._is_answered.is_set() and not self.task.is_cancelled()

    def cancel(self, reason):
        """From any thread, and at once, unless it has ended; `reason`: a sentence."""
        with self._ending:
            if not self._is_answered.is_set():
                self.task.cancel(reason)
                self._action.let_go()

    def join(self, seconds=None):
        """Until its work has ended, and all that it has called."""
        self._thread.join(seconds)

    def _follow(self):
        while not self._is_answered.is_set():
            self._account.changed.wait(PERIOD)
            self._account.changed.clear()
            if rospy.is_shutdown():  # links go then, which says nothing of the client
                return
            complaint = "" if self.task.is_cancelled() else self._followers.complaint()
            if complaint:
                rospy.logwarn("%s: %s Its goal is cancelled.", self.name, printable(complaint))
                self.cancel(complaint)
            if not self._is_answered.is_set():
                self._tell()

    def _tell(self):
        try:
            self._handle.publish_feedback(self._action.feedback(self._account))
        except rospy.ROSException:  # its topic was closed at this moment
            if not rospy.is_shutdown():
                raise

    def _run(self, previous):
        if previous is not None:
            previous.join()
        try:
            answer = self._outcome()
        finally:
            # What another goal holds by now is not let go by a late cancel.
            with self._ending:
                self._action.let_go()
                self._is_answered.set()
        answer()
        self.task.wait_for_calls()

    def _outcome(self):
        """What answers the client."""
        try:
            self.task.check()
            is_success, result = self._action.work(self._handle.get_goal(), self.task, self._account)
            answer = self._handle.set_succeeded if is_success else self._handle.set_aborted
            return lambda: answer(result, result.message)
        except Cancelled as reason:
            message = f"Cancelled: {reason} {self._action.end}"
            answer = self._handle.set_canceled
        except (RuntimeError, ValueError) as error:
            message = printable(str(error))
            answer = self._handle.set_aborted
        except Exception as error:  # pylint: disable=broad-except; client and console hear of it
            message = f"The engine failed: {type(error).__name__}: {printable(str(error))}"
            rospy.logerr("%s", message)
            answer = self._handle.set_aborted
        result = self._action.failure(message, self._account)
        return lambda: answer(result, message)


def client_of(handle):
    """Name of the node that a goal comes from."""
    return handle.goal._connection_header["callerid"]  # pylint: disable=protected-access
