#!/usr/bin/python3
"""A rotor without joints in the emulated laboratory: its fixture, and a guided session to the true parameters, whose
recording is calibrated again to the same."""

import glob
import math
import os
import re
import signal
import subprocess
import sys

import rospy
import rostest
import yaml
from calibration_client import NAMESPACE, PACKAGE, program, wait_for
from emulated_lab import LabCase
from geometry_msgs.msg import Quaternion, QuaternionStamped
from guided_program import GuidedProgram
from recorder_links import wait_until_connected, wait_until_received
from spherical_actuator_calibration.msg import ActuatorParameters
from spherical_actuator_calibration.rotor_readings import turns_of
from spherical_actuator_calibration.session_guide.progress import distance
from true_parameters import expect_truth

OPTIONS = ("--drive-fixture", "--yes", "--poses", "6", "--dwell", "0.2", "--settling", "0.15", "--validation-poses", "1")
TOLERANCE = 1e-9  # between live and offline
STREAMS = ("measured_orientation", "measured_torque", "coil_currents", "samples", "calibration_description")


class LevitatedSession(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(seed=5, commands=False, unit="reaction_sphere", record=True)
        cls.start_lab()
        cls.true_turns = None
        rospy.Subscriber(f"{NAMESPACE}/lab_emulator/true_orientation", QuaternionStamped, cls.keep)
        wait_until_connected([f"{NAMESPACE}/{topic}" for topic in STREAMS])

    @classmethod
    def keep(cls, message):
        q = message.quaternion
        cls.true_turns = turns_of(q.x, q.y, q.z, q.w)

    def turned_to(self, turns):
        self.lab.move(turns)
        wait_for(lambda: self.true_turns and distance(self.true_turns, turns) < 1e-12, f"the rotor at {turns}")

    def test_1_the_fixture_turns_it_to_an_orientation(self):
        self.turned_to((0.3, -0.4, 2.9))
        # Not back by nearly a turn: it passes the half turn.
        seen = []
        subscriber = rospy.Subscriber(
            f"{NAMESPACE}/lab_emulator/true_orientation", QuaternionStamped, lambda m: seen.append(m.quaternion)
        )
        self.turned_to((0.3, -0.4, -2.9))
        subscriber.unregister()
        self.assertGreater(min(abs(turns_of(q.x, q.y, q.z, q.w)[2]) for q in seen), 2.8)

    def test_1_targets_that_cannot_be_are_refused(self):
        self.turned_to((0.1, 0.2, 0.3))
        outside = self.lab.readings.target((0.0, 0.7, 0.0))
        elsewhere = self.lab.readings.target((0.2, 0.0, 0.0))
        elsewhere.header.frame_id = "tracker"
        no_rotation = self.lab.readings.target((0.2, 0.0, 0.0))
        no_rotation.quaternion = Quaternion(0.0, 0.0, 0.0, 1.1)
        not_a_number = self.lab.readings.target((math.nan, 0.0, 0.0))
        for target in (outside, elsewhere, no_rotation, not_a_number):
            self.lab.targets.publish(target)
        # What comes after them is followed.
        self.turned_to((0.1, 0.2, 0.31))

    def test_1_nothing_of_joints_is_there(self):
        nodes = subprocess.run(["rosnode", "list"], check=True, stdout=subprocess.PIPE, text=True).stdout.split()
        self.assertIn(f"{NAMESPACE}/coil_driver", nodes)
        self.assertNotIn(f"{NAMESPACE}/joint_sensor", nodes)
        topics = dict(rospy.get_published_topics())
        self.assertNotIn(f"{NAMESPACE}/joint_states", topics)
        services = subprocess.run(["rosservice", "list"], check=True, stdout=subprocess.PIPE, text=True).stdout
        self.assertIn(f"{NAMESPACE}/lab_emulator/trip_amplifier\n", services)
        self.assertNotIn("freeze_sensor", services)
        wait_for(lambda: self.client.diagnostic("measured_orientation"), "diagnostics of the node")
        self.assertEqual(self.client.diagnostic("joint_states"), {})
        parameters = rospy.wait_for_message(f"{NAMESPACE}/parameters", ActuatorParameters)
        self.assertEqual((len(parameters.poles), len(parameters.coils)), (8, 20))
        self.assertTrue(all(joint.axis.x == joint.axis.y == joint.axis.z == 0.0 for joint in parameters.joints))

    def test_1_level_1_is_refused(self):
        answer = self.client.call("calibrate_joint", coil=0)
        self.assertFalse(answer.success)
        self.assertIn("no joints", answer.message)

    def further_samples(self, count):
        enough = len(self.client.held()) + count
        wait_for(lambda: len(self.client.held()) >= enough, f"{count} further samples")

    def test_2_a_whole_session_and_its_recording(self):
        session = GuidedProgram(*OPTIONS)
        self.further_samples(3)
        self.lab.fault("lose_tracker", True)
        session.wait_until_it_says("measured_orientation")
        self.lab.fault("lose_tracker", False)
        self.further_samples(2)
        self.assertEqual(session.signal(signal.SIGINT), 1)
        wait_for(self.lab.is_without_current, "zero currents")

        session = GuidedProgram(*OPTIONS)
        session.wait_until_it_says("measured already")
        self.assertEqual(session.wait(), 0, "\n".join(session.lines))
        self.assertTrue(session.says("they agree with the parameters"), session.lines)
        self.assertTrue(session.says("Torque is proportional to current: coil "), session.lines)
        self.assertTrue(session.says("all 56 parameters are identified"), session.lines)
        saved = next(line for line in session.lines if line.startswith("Saved "))
        live = re.match(r"Saved (\S+\.yaml)", saved).group(1)
        expect_truth(self, live, self.lab.truth)
        self.check_status()
        wait_until_received([f"{NAMESPACE}/{topic}" for topic in STREAMS])
        self.lab.stop()
        for source in ("streams", "samples"):
            self.check_recording(live, source)

    def check_status(self):
        status = self.client.latest("status")
        self.assertTrue(status.complete)
        self.assertNotIn("joint", status.next_step)
        self.assertEqual(status.joint.wanted, 0)

    def check_recording(self, live, source):
        """The recording tells everything that live went by."""
        (bag,) = glob.glob(os.path.join(self.lab.directory, "recordings", "*.bag"))
        output = os.path.join(self.folder.name, f"{source}.yaml")
        command = [program("calibrate_bag"), "--from", source, "--cycles", "refine", "--output", output, bag]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        found, expected = (self.angles(path) for path in (output, live))
        self.assertEqual(len(found), 56)
        self.assertLess(max(abs(one - other) for one, other in zip(found, expected)), TOLERANCE)

    @staticmethod
    def angles(path):
        with open(path, encoding="utf-8") as file:
            actuator = yaml.safe_load(file)["actuator"]
        return [axis[key] for axis in actuator["poles"] + actuator["coils"] for key in ("polar", "azimuth")]


if __name__ == "__main__":
    rospy.init_node("levitated_session_test")
    rostest.rosrun(PACKAGE, "levitated_session", LevitatedSession, sys.argv)
