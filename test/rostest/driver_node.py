"""What the tests of the driver nodes share: a node under test, and its diagnostics."""

import os
import subprocess

import rospy
from calibration_client import DEADLINE, NAMESPACE, program, wait_for
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

OK = DiagnosticStatus.OK
ERROR = DiagnosticStatus.ERROR
RESPONSE_TIMEOUT = 10.0  # [s] for a device that answers, on however busy a computer: the longest that there is


class Diagnostics:
    """What a node tells of itself."""

    def __init__(self, name):
        self.name = f"{NAMESPACE}/{name}"
        self._status = {}
        self._subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, self._receive)

    def close(self):
        self._subscriber.unregister()

    def _receive(self, message):
        for status in message.status:
            if status.name.startswith(self.name.lstrip("/") + ": "):
                self._status[status.name.split(": ", 1)[1]] = status

    def latest(self, task):
        """The last report; None before the first."""
        return self._status.get(task)

    def level(self, task):
        status = self.latest(task)
        return None if status is None else status.level

    def message(self, task):
        return self._reported(task).message

    def value(self, task, key):
        """Waits for it: the first report, "starting up", has no values."""

        def known():
            values = {item.key: item.value for item in self._reported(task).values}
            return (values[key],) if key in values else None

        return wait_for(known, f"{key} among the diagnostics of {task}")[0]

    def _reported(self, task):
        """The last report, or the first when none has come yet."""
        return wait_for(lambda: self._status.get(task), f"diagnostics of {task}")

    def wait_for_level(self, task, level):
        wait_for(lambda: self.level(task) == level, f"{task} at level {level}")


class DriverNode(Diagnostics):
    """A node's program with private parameters from a map, started and ended by the test."""

    def __init__(self, name, parameters, environment=None):
        super().__init__(name)
        if rospy.has_param(self.name):
            rospy.delete_param(self.name)
        rospy.set_param(self.name, parameters)
        self.process = subprocess.Popen(
            [program(name), f"__name:={name}"],
            env={**os.environ, "ROS_NAMESPACE": NAMESPACE, **(environment or {})},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )

    def end(self, signal_number):
        """Ends the node by a signal and returns what it wrote to its standard error."""
        self.process.send_signal(signal_number)
        return self.wait_for_end()

    def wait_for_end(self):
        """What an ending node wrote to its standard error."""
        return self.process.communicate(timeout=DEADLINE)[1]

    def close(self):
        super().close()
        if self.process.poll() is None:
            self.process.terminate()
        self.wait_for_end()
