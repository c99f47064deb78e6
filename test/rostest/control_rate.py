#!/usr/bin/python3
"""Control of the released rotor of the emulated laboratory at 1 kHz from end to end, and how fresh its readings are.

What a computer that has time must reach is measured, and asked for only where MEASURE_IDLE=1 says that it has time."""

import os
import sys

import rospy
import rostest
from calibration_client import NAMESPACE, PACKAGE, wait_for
from controller_client import Commands, Controller, target
from driver_node import ERROR
from emulated_lab import LabCase
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import ActuatorParameters, CoilCurrents

RATE = 1000.0  # [Hz]
LEAST_RATE = 300.0  # [Hz] on a busy computer; more than the shipped drivers have
SPAN = 5.0  # [s]
MOST_ATTEMPTS = 6
OLD_SHARE = 1e-3  # of the commands, on a computer that has time
FRICTION = 0.01  # [N.m.s] that a rotor falls slowly while the computer is busy with something else


class Count:
    """Messages of a topic."""

    def __init__(self, topic, kind):
        self.count = 0
        rospy.Subscriber(f"{NAMESPACE}/{topic}", kind, self._add, queue_size=10000, tcp_nodelay=True)

    def _add(self, _message):
        self.count += 1


class ControlRate(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(commands=False, seed=4, rate=RATE)
        cls.lab.change_emulator(friction={"viscous": FRICTION})
        cls.commands = Commands()
        cls.joints = Count("joint_states", JointState)
        cls.currents = Count("coil_currents", CoilCurrents)
        cls.lab.start()
        cls.controller = Controller(largest_age=1.0, diagnostic_period=1.0)
        cls.addClassCleanup(cls.controller.close)
        rospy.wait_for_message(f"{NAMESPACE}/parameters", ActuatorParameters)

    def value(self, key):
        return float(self.controller.value("control", key))

    def hold(self):
        """Whether the rotor is held, and not fallen."""
        self.lab.fault("release_fixture", False)
        self.lab.move([0.0, 0.0, 0.0])
        self.controller.wait_until_enabled()
        self.lab.fault("release_fixture", True)
        self.controller.send(target(0.02, 0.01, 0.05))
        rospy.sleep(2.0)
        return self.controller.level("control") != ERROR

    def measure(self):
        """Whether it went on for a while, at such a rate."""
        begin = rospy.get_time()
        before = self.commands.count, self.joints.count, self.currents.count
        commands, old = self.value("commands since start"), self.value("of them on an old reading")
        rospy.sleep(SPAN)
        elapsed = rospy.get_time() - begin
        after = self.commands.count, self.joints.count, self.currents.count
        self.rates = [(b - a) / elapsed for a, b in zip(before, after)]
        commands = self.value("commands since start") - commands
        self.old_share = (self.value("of them on an old reading") - old) / max(commands, 1.0)
        print("MEASURED commands {:.0f}, joint readings {:.0f}, currents {:.0f} Hz".format(*self.rates))
        print(f"MEASURED {100.0 * self.old_share:.3f} % of {commands:.0f} commands on an old reading")
        for key in (
            "jitter of the period [us]",
            "longest period [us]",
            "mean age of the reading [us]",
            "largest age of the reading [us]",
            "mean computation [us]",
        ):
            print(f"MEASURED {key}: {self.value(key):.0f}")
        print(f"MEASURED tracking error {self.value('tracking error [mrad]'):.3f} mrad")
        return self.controller.level("control") != ERROR and min(self.rates) > LEAST_RATE

    def test_the_laboratory_beats_at_1_khz(self):
        reached = any(self.hold() and self.measure() for _ in range(MOST_ATTEMPTS))
        self.assertTrue(reached, f"{MOST_ATTEMPTS} attempts failed")
        self.assertLessEqual(self.rates[0], 1.05 * self.rates[1])
        if os.environ.get("MEASURE_IDLE") == "1":
            self.assertGreater(min(self.rates), 0.95 * RATE)
            self.assertLess(self.old_share, OLD_SHARE)
        self.lab.fault("release_fixture", False)
        self.controller.enable(False)
        wait_for(self.commands.ended_with_zero, "zero")


if __name__ == "__main__":
    rospy.init_node("control_rate_test")
    rostest.rosrun(PACKAGE, "control_rate", ControlRate, sys.argv)
