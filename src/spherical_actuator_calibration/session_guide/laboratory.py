"""The laboratory as a session sees it: where the rotor is, currents, and what moves and excites the rotor."""

import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from spherical_actuator_calibration.msg import CoilCurrents
from spherical_actuator_calibration.wall_stamp import wall_stamp

from .coil_watch import CoilWatch
from .task import LOOK

COMMAND_RATE = 20.0  # [Hz]; above the coil driver's watchdog
FIRST = 1.0  # [s] for the first reading and currents


class Laboratory:
    """While it is held it commands coils and fixture, and asks the calibration node what the coils carry; else nobody here
    listens or asks. `readings`: of rotor_readings, not listening."""

    def __init__(self, ns, coils, readings):
        self._ns = ns
        self._coils = coils
        self.readings = readings
        self._is_listening = False
        self._watch = CoilWatch(ns)
        self._driver = f"{ns[1:]}/coil_driver: output"
        self._driver_status = None
        self._command = [0.0] * coils
        self._is_held = False
        self._lock = threading.Lock()
        self._commands = rospy.Publisher(ns + "/coil_command", CoilCurrents, queue_size=1)
        self._targets = rospy.Publisher(f"{ns}/{readings.fixture}", readings.target_type, queue_size=1, latch=True)
        self._subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self._keep_diagnostics)
        self._timer = rospy.Timer(rospy.Duration(1.0 / COMMAND_RATE), self._repeat)

    def _keep_diagnostics(self, message):
        for status in message.status:
            if status.name == self._driver:
                self._driver_status = status

    def _repeat(self, _event):
        # Under the lock, so that commands go out in the order of their stamps.
        with self._lock:
            if self._is_held:
                self._publish()

    def _publish(self):
        message = CoilCurrents(current=list(self._command))
        message.header.stamp = wall_stamp()
        self._commands.publish(message)

    def hold(self):
        """From now on currents are commanded, zero at first; others may not command then. Returns when readings and
        currents come, or do not for FIRST."""
        with self._lock:
            listens, self._is_listening = self._is_listening, True
        if not listens:
            self._listen()
        with self._lock:
            self._command = [0.0] * self._coils
            self._watch.expect((), 0.0)
            self._is_held = True

    def _listen(self):
        self.readings.listen()
        self._watch.begin()
        with self._lock:
            was_released = not self._is_listening
        if was_released:  # meanwhile
            self._watch.end()
            self.readings.close()
        end = time.monotonic() + FIRST
        while time.monotonic() < end and not (self.readings.fresh() and self.currents()):
            time.sleep(LOOK)

    def _stop_listening(self):
        with self._lock:
            was_listening, self._is_listening = self._is_listening, False
        if was_listening:
            self._watch.end()
            self.readings.close()

    def excite(self, pattern, current):
        """Only the coils of a pattern: numbers from 1, negative where the current is; empty: none. Without effect
        unless the laboratory is held."""
        with self._lock:
            self._command = [0.0] * self._coils
            self._watch.expect(pattern if self._is_held else (), current)
            for coil in pattern if self._is_held else ():
                self._command[abs(coil) - 1] = current if coil > 0 else -current
            if self._is_held:
                self._publish()  # captures need not wait for the timer

    def currents(self):
        """The last measured ones [A]; empty before the first, and while it is not held."""
        return self._watch.currents()

    def carries(self):
        """Whether all coils carry what is commanded now; None while the calibration node does not tell."""
        return self._watch.carries()

    def trouble(self):
        """Why it does not, in a sentence."""
        return self._watch.trouble()

    def driver_complaint(self):
        """What the coil driver says is wrong; empty when it says nothing."""
        status = self._driver_status
        return status.message if status is not None and status.level != DiagnosticStatus.OK else ""

    def drive_to(self, joints):
        """By the fixture, to a reading of the rotor [rad]."""
        self._targets.publish(self.readings.target(joints))

    def release(self):
        """All currents to zero at once, told several times, as a last message may be lost; nothing is commanded any
        more."""
        with self._lock:
            was_held = self._is_held
            self._is_held = False
            self._command = [0.0] * self._coils
        for _ in range(3 if was_held else 0):
            with self._lock:
                if not self._is_held:
                    self._publish()
            rospy.rostime.wallsleep(0.02)
        self._stop_listening()
