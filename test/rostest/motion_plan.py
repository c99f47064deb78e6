#!/usr/bin/python3
"""A motion plan on the released rotor of the emulated laboratory: to its end, and under a hand that holds it back."""

import math
import pathlib
import sys

import rospy
import rostest
import yaml
from calibration_client import NAMESPACE, PACKAGE, wait_for
from controller_client import Commands, Controller, description
from emulated_lab import LabCase
from geometry_msgs.msg import Vector3
from spherical_actuator_calibration.msg import ActuatorParameters, MotionStatus
from spherical_actuator_calibration.srv import FollowMotion, Push
from std_srvs.srv import Trigger

MOST_ATTEMPTS = 3
COIL_LIMIT = 1.5  # [A]
FRICTION = 0.05  # [N.m.s] so much that the rotor waits for a computer that is busy with something else
ROUNDING = 1.0 + 1e-6


def plan(duration):
    """Some tilt and spin, and currents in all coils."""

    def sines(frequencies, amplitudes):
        phases = [0.7 * n for n in range(len(frequencies))]
        return {"frequencies": frequencies, "amplitudes": amplitudes, "phases": phases}

    tilt = {"centre": 0.0, **sines([0.31, 0.47], [0.04, 0.04])}
    spin = {"centre": 0.0, **sines([0.05], [0.8])}
    limits = {"tilt": 0.2, "rate": 2.0, "error": 0.35}
    limits.update(coil_current=COIL_LIMIT, total_current=4.0, square_current=4.0)
    content = {
        "actuator": description()["name"],
        "duration": duration,
        "ramp": 1.0,
        "limits": limits,
        "joints": [tilt, tilt, spin],
        "coils": [sines([1.5 + 0.1 * coil], [0.02]) for coil in range(24)],
    }
    return yaml.safe_dump({"motion_plan": content})


class MotionPlan(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.refusal = ""
        cls.make_lab(released=True, commands=False, seed=4)
        cls.make_it_patient()
        cls.commands = Commands()
        cls.lab.start()
        cls.controller = Controller(largest_age=1.0)
        cls.addClassCleanup(cls.controller.close)
        cls.status, cls.begun = None, rospy.Time()
        rospy.Subscriber(f"{NAMESPACE}/orientation_controller/motion_status", MotionStatus, cls.keep)
        rospy.wait_for_message(f"{NAMESPACE}/parameters", ActuatorParameters)

    @classmethod
    def make_it_patient(cls):
        """A rotor that neither falls nor turns by itself."""
        path = pathlib.Path(cls.lab.config) / "lab_emulator.yaml"
        content = yaml.safe_load(path.read_text())
        content["friction"] = {"viscous": FRICTION}
        content["load"]["unbalance"] = [0.0, 0.0, 0.0]
        path.write_text(yaml.safe_dump(content))

    @classmethod
    def keep(cls, message):
        # What is told of the motion before may come late.
        if message.header.stamp >= cls.begun:
            cls.status = message

    def call(self, service, kind, *arguments):
        name = f"{NAMESPACE}/{service}"
        rospy.wait_for_service(name)
        return rospy.ServiceProxy(name, kind)(*arguments)

    def phase(self):
        return self.status.phase if self.status else "none"

    def begin(self, duration):
        """Whether the rotor came into motion: a busy computer may let it fall before."""
        self.lab.fault("release_fixture", False)
        self.lab.move([0.0, 0.0, 0.0])
        self.controller.wait_until_enabled()
        self.lab.fault("release_fixture", True)
        type(self).begun = rospy.Time.now()
        type(self).status = None
        answer = self.call("orientation_controller/follow_motion", FollowMotion, plan(duration))
        if not answer.success:
            self.refusal = answer.message
            return False
        wait_for(lambda: self.phase() in ("motion", "stopped"), "the motion")
        return self.phase() == "motion"

    def try_again(self, attempt):
        for _ in range(MOST_ATTEMPTS):
            if attempt():
                return
        self.fail(f"{MOST_ATTEMPTS} attempts failed: {self.refusal} {self.status}")

    def expect_no_current(self):
        wait_for(self.commands.ended_with_zero, "zero")
        wait_for(self.lab.is_without_current, "coils without current")
        self.lab.fault("release_fixture", False)

    def completes(self):
        if not self.begin(5.0):
            return False
        wait_for(lambda: self.phase() in ("done", "stopped"), "the end")
        return self.phase() == "done"

    def test_a_motion_ends_at_rest_without_current(self):
        self.try_again(self.completes)
        self.assertGreaterEqual(self.status.elapsed, 5.0)
        self.assertLess(self.status.largest_tracking_error, 0.35)
        self.assertLessEqual(self.commands.largest, COIL_LIMIT * ROUNDING)
        self.assertGreater(self.commands.largest, 0.02)
        self.expect_no_current()

    def is_held_back(self):
        if not self.begin(600.0):
            return False
        torque = Vector3(0.5, 0.0, 0.0)
        answer = self.call("lab_emulator/push", Push, torque, 2.0)
        self.assertTrue(answer.success, answer.message)
        wait_for(lambda: self.phase() == "stopped", "the stop")
        return "does not follow" in self.status.message or "workspace" in self.status.message

    def test_a_push_stops_it_without_current(self):
        self.try_again(self.is_held_back)
        self.expect_no_current()

    def ends_before_its_time(self):
        if not self.begin(600.0):
            return False
        self.call("orientation_controller/end_motion", Trigger)
        wait_for(lambda: self.phase() in ("done", "stopped"), "the end")
        return self.phase() == "done"

    def test_ends_before_its_time_when_it_is_wanted(self):
        self.try_again(self.ends_before_its_time)
        self.assertLess(self.status.duration, 60.0)
        self.expect_no_current()

    def test_stops_with_a_sensor_that_stands_still(self):
        self.try_again(lambda: self.begin(600.0))
        self.lab.fault("freeze_sensor", True)
        wait_for(lambda: self.phase() == "stopped", "the stop")
        self.lab.fault("freeze_sensor", False)
        self.expect_no_current()

    def test_refuses_what_is_no_plan_and_says_why(self):
        answer = self.call("orientation_controller/follow_motion", FollowMotion, "motion_plan: {speed: 1}")
        self.assertFalse(answer.success)
        self.assertIn("motion_plan", answer.message)
        answer = self.call("orientation_controller/follow_motion", FollowMotion, plan(5.0))
        self.assertIn("not enabled", answer.message)
        self.lab.fault("release_fixture", False)
        answer = self.call("lab_emulator/push", Push, Vector3(0.1, 0.0, 0.0), 1.0)
        self.assertIn("fixture", answer.message)
        answer = self.call("lab_emulator/push", Push, Vector3(math.nan, 0.0, 0.0), 1.0)
        self.assertIn("finite", answer.message)


if __name__ == "__main__":
    rospy.init_node("motion_plan_test")
    rostest.rosrun(PACKAGE, "motion_plan", MotionPlan, sys.argv)
