"""How far a measurement is, for those who follow it."""

import copy
import threading

from spherical_actuator_calibration.msg import MeasurementProgress
from spherical_actuator_calibration.text_files import printable

from ..narrator import Narrator
from .task import Task

KEPT = 20  # sentences that each message repeats


class Account(Narrator):
    """Gathers what a measurement tells, from any thread; `changed` is set whenever a sentence comes."""

    def __init__(self):
        super().__init__()
        self.changed = threading.Event()
        self._lock = threading.Lock()
        self._message = MeasurementProgress(stage=MeasurementProgress.STARTING, remaining_time=-1.0)
        self._pose = None
        self._begin = Task.time()

    def elapsed(self):
        """[s] since it was opened."""
        return Task.time() - self._begin

    def last(self):
        """The sentence that was told last; empty before the first."""
        with self._lock:
            return self._message.sentences[-1] if self._message.sentences else ""

    def pose(self):
        """The pose that the rotor is to come to; None: none."""
        with self._lock:
            return self._pose

    def _tell(self, sentence):
        with self._lock:
            self._message.told += 1
            self._message.sentences = [*self._message.sentences, printable(sentence)][-KEPT:]
        self.changed.set()

    def set(self, **fields):
        """Fields of the message that are so from now on."""
        with self._lock:
            for name, value in fields.items():
                setattr(self._message, name, value)

    def lead_to(self, pose, tolerance=0.0):
        """The pose that the rotor is to come to, each joint within the tolerance [rad]; None: none."""
        with self._lock:
            self._pose = pose
            self._message.tolerance = tolerance
            self._message.held_out = pose is not None and pose.validation
            self._message.is_at_rest = False

    def count(self, progress):
        """Captures, of a Progress."""
        remaining = progress.remaining_time()
        self.set(
            captures=progress.done,
            captures_wanted=progress.total,
            remaining_time=-1.0 if remaining is None else remaining,
        )

    def message(self, joints=None):
        """A copy that stays as it is, with the way from these joint angles [rad]."""
        with self._lock:
            message = copy.copy(self._message)
            is_led = self._pose is not None and joints is not None
            message.way = self._pose.way_from(joints) if is_led else []
        return message
