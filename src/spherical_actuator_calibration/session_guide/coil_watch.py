"""Whether the coils carry what is commanded, as the calibration node judges."""

import math
import threading
import time

import rospy
from spherical_actuator_calibration.srv import CheckCoils

PERIOD = 0.02  # [s] between two questions
SILENT = "The calibration node does not answer, which tells what coils carry: start it again."
LATEST = 1.0  # [s] after which an answer says nothing any more


class CoilWatch:
    """Asks the node again and again, in a thread of its own: nobody else waits for an answer."""

    def __init__(self, ns):
        self._service = f"{ns}/calibration/check_coils"
        self._lock = threading.Lock()
        self._commanded = (0, (), 0.0)  # with a number: the same may be commanded once more
        self._answer = None
        self._asked = None  # what that was commanded then
        self._told = -math.inf  # [s] when it came
        self._trouble = SILENT
        self._ended = None

    def begin(self):
        """Asks from now on."""
        with self._lock:
            self._trouble = SILENT
        self._ended = threading.Event()
        threading.Thread(target=self._run, args=(self._ended,), daemon=True).start()

    def end(self):
        """Asks no more; what was told says nothing from then on."""
        if self._ended is not None:
            self._ended.set()
        with self._lock:
            self._told = -math.inf

    def expect(self, pattern, current):
        """What is commanded from now on: coils counted from 1, negative where the current [A] is."""
        with self._lock:
            number, *before = self._commanded
            if before != [tuple(pattern), current]:
                self._commanded = (number + 1, tuple(pattern), current)

    def carries(self):
        """Whether all coils carry what is commanded now; None while the node does not tell."""
        with self._lock:
            is_of_now = self._is_told() and self._asked == self._commanded
            return bool(self._answer.carried) if is_of_now else None

    def currents(self):
        """The last measured ones [A]; empty while none are told."""
        with self._lock:
            return tuple(self._answer.measured) if self._is_told() else ()

    def trouble(self):
        """Why it is not told whether coils carry what is commanded, in a sentence."""
        with self._lock:
            return self._trouble or SILENT

    def _is_told(self):
        return time.monotonic() - self._told <= LATEST

    def _run(self, ended):
        node = None
        while not ended.wait(PERIOD):
            with self._lock:
                asked = self._commanded
            try:
                node = node or rospy.ServiceProxy(self._service, CheckCoils, persistent=True)
                answer = node(coils=list(asked[1]), current=asked[2])
            except (rospy.ServiceException, rospy.ROSException):  # it is gone, or begins
                node = answer = None
            self._keep(answer, asked, ended)
        if node is not None:
            node.close()

    def _keep(self, answer, asked, ended):
        with self._lock:
            if ended.is_set():
                return
            self._trouble = answer.message if answer else SILENT
            if answer and answer.success:
                self._answer, self._asked, self._told = answer, asked, time.monotonic()
