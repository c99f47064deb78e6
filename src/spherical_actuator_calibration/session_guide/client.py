"""A guided session as a terminal follows it."""

import contextlib
import subprocess
import threading

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from spherical_actuator_calibration.msg import SessionAction, SessionResult
from spherical_actuator_calibration.programs import program

from .picture import MEASURING, line_of
from .task import Task

LOOK = 0.1  # [s] between two looks
STARTING = 3.0  # [s] for an engine that is being started with the laboratory
PATIENCE = 30.0  # [s] for an engine that must be there, on however busy a computer
SILENCE = 10.0  # [s] without feedback, after which the engine has gone
ENDING = 10.0  # [s] for the answer to a cancelled goal


class UnusableError(Exception):
    """What is asked for cannot be used; the text says why."""


class Follower:
    """Shows a terminal what the feedback of a goal tells: each sentence once, and how far it is."""

    def __init__(self, terminal):
        self._terminal = terminal
        self._lock = threading.Lock()
        self._told = 0
        self._captures = 0
        self._pose = 0
        self.time = Task.time()  # [s] of the last feedback

    def follow(self, told):
        """A MeasurementProgress, of feedback or result; from any thread."""
        with self._lock:
            self.time = Task.time()
            if told.captures != self._captures and (told.pose != self._pose or told.stage not in MEASURING):
                self._terminal.milestone(line_of(told))
                self._captures = told.captures
            self._pose = told.pose
            for sentence in told.sentences[len(told.sentences) - max(0, told.told - self._told) :]:
                self._terminal.say(sentence)
            self._told = max(self._told, told.told)
            self._terminal.show(told)


class GoalClient(actionlib.SimpleActionClient):
    """Of an engine that may accept a goal before the goal has a handle here, on a busy computer: actionlib prints an
    error then, and forgets that it was accepted."""

    def __init__(self, name, action):
        self._sending = threading.Lock()
        super().__init__(name, action)

    def send_goal(self, *goal, **callbacks):
        with self._sending:
            super().send_goal(*goal, **callbacks)

    def _handle_transition(self, gh):
        with self._sending:  # until there is a handle
            pass
        super()._handle_transition(gh)


class SessionClient:
    """Has an engine lead a session; ends with its outcome."""

    def __init__(self, ns, terminal):
        self._ns = ns
        self._action = f"{ns}/calibration/session"
        self._terminal = terminal
        self._client = GoalClient(self._action, SessionAction)

    def is_served(self):
        """Whether an engine is there, or comes while the laboratory starts."""
        end = Task.time() + STARTING
        while not any(name == f"{self._action}/status" for name, _ in rospy.get_published_topics(self._ns)):
            if Task.time() > end:
                return False
            rospy.rostime.wallsleep(LOOK)
        # The master also tells of one that was killed.
        return self._client.wait_for_server(rospy.Duration(PATIENCE))

    def run(self, goal):
        """Whether the session is complete. Raises UnusableError, RuntimeError when the engine has gone, and
        KeyboardInterrupt after the goal was cancelled and its end was heard of."""
        while True:
            if not self._client.wait_for_server(rospy.Duration(PATIENCE)):
                raise RuntimeError(f"The engine does not answer ({self._action}): start it by lab.launch.")
            result = self._follow(goal)
            if result is not None:
                return result.outcome == SessionResult.COMPLETE
            self._terminal.say("The engine has been started anew; the session goes on.")

    def _follow(self, goal):
        """Result; None when the engine does not know the goal any more."""
        follower = Follower(self._terminal)
        self._client.send_goal(goal, feedback_cb=lambda feedback: follower.follow(feedback.progress))
        try:
            while not self._client.wait_for_result(rospy.Duration(LOOK)):
                if Task.time() - follower.time > SILENCE:
                    raise RuntimeError("The engine is silent: the coil driver has ended the currents. Start again.")
        except KeyboardInterrupt:
            self._cancel(follower)
            raise
        if self._client.get_state() == GoalStatus.LOST:
            return None
        return self._conclude(follower)

    def _conclude(self, follower):
        result = self._client.get_result()
        follower.follow(result.progress)
        if result.outcome == SessionResult.UNUSABLE:
            raise UnusableError(result.message)
        if result.message not in result.progress.sentences[-1:]:
            self._terminal.say(result.message)
        return result

    def _cancel(self, follower):
        self._client.cancel_goal()
        if not self._client.wait_for_result(rospy.Duration(ENDING)):
            raise RuntimeError("Interrupted, but the engine does not answer: look after the currents.")
        follower.follow(self._client.get_result().progress)


@contextlib.contextmanager
def engine_of(ns, client):
    """An engine, as long as the context lasts: that of the laboratory, or one of its own."""
    if client.is_served():
        yield
        return
    # In a session of its own: Ctrl-C is for us, who cancel the goal. Its input ends with us, however we end.
    process = subprocess.Popen(
        [program("session_engine"), "--until-eof", f"__ns:={ns}"], stdin=subprocess.PIPE, start_new_session=True
    )
    try:
        yield
    finally:
        process.terminate()
        process.wait()
