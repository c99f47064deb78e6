#!/usr/bin/python3
"""A plan of plan_session carried out by hand: a script is the hand that turns the rotor where the terminal says, not
quite, and pushes it away once in the middle of a pose. The laboratory has no engine: the session brings its own."""

import math
import pathlib
import re
import sys
import threading

import rospy
import rostest
from calibration_client import PACKAGE, run_tool, wait_for
from emulated_lab import LabCase
from guided_program import GuidedProgram
from true_parameters import expect_truth

OPTIONS = ("--dwell", "0.2", "--settling", "0.5", "--validation-poses", "1")
WANTED = re.compile(r"Turn the rotor to (?:held-out )?pose \d+ of \d+: joint_1 (\S+)°, joint_2 (\S+)°, joint_3 (\S+)°,")
SHAKE = (0.02, -0.015, 0.02)  # [rad] that a hand misses the pose by
KICK = 0.15  # [rad] by which the rotor leaves it once


class Hand:
    """Turns the rotor of the laboratory to each pose that a session asks for."""

    def __init__(self, lab, session):
        self._lab = lab
        self._session = session
        self._pose = None
        self._read = 0
        self._is_ending = threading.Event()
        self._thread = threading.Thread(target=self._turn, daemon=True)
        self._thread.start()

    def _turn(self):
        while not self._is_ending.wait(0.1):
            for line in self._session.lines[self._read :]:
                self._read += 1
                wanted = WANTED.match(line)
                if wanted:
                    self._pose = [math.radians(float(angle)) + miss for angle, miss in zip(wanted.groups(), SHAKE)]
                    self._lab.move(self._pose)
                elif "has left the pose" in line:
                    self._lab.move(self._pose)

    def kick(self):
        self._lab.move([self._pose[0] + KICK, *self._pose[1:]])

    def end(self):
        self._is_ending.set()
        self._thread.join()


class GuidedByHand(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(seed=7, commands=False, engine=False)
        cls.start_lab()

    def planned(self):
        """A plan from which the session does not need to add poses."""
        path = pathlib.Path(self.folder.name) / "plan.yaml"
        description = pathlib.Path(rospy.get_param("~config")) / "pm_spherical_8x24.yaml"
        run_tool("plan_session", actuator=description, output=path, poses=8, candidates=100)
        return str(path)

    def led(self, *options):
        """Lines of a session that succeeds."""
        session = GuidedProgram(*OPTIONS, *options)
        hand = Hand(self.lab, session)
        try:
            self.kick(hand)
            self.assertEqual(session.wait(), 0, "\n".join(session.lines))
        finally:
            hand.end()
        self.assertTrue(session.says("Grade: good."), session.lines)
        return session.lines

    def kick(self, hand):
        """While a coil of the first pose is excited."""
        wait_for(lambda: len(self.client.held()) >= 2, "two samples")
        hand.kick()

    def test_by_a_plan(self):
        lines = self.led("--plan", self.planned())
        self.assertTrue(any("8 poses of " in line for line in lines), lines)
        self.assertTrue(any("has left the pose" in line for line in lines), lines)
        self.assertTrue(any(re.match(r"\[#+\.*\] \d+/\d+", line) for line in lines), lines)
        saved = next(line for line in lines if line.startswith("Saved "))
        expect_truth(self, re.match(r"Saved (\S+\.yaml)", saved).group(1), self.lab.truth)
        wait_for(self.lab.is_without_current, "zero currents")
        self.expect_torques_without_bias()

    def expect_torques_without_bias(self):
        for sample in self.client.held().values():
            if sample.has_torque and max(map(abs, sample.current)) > 1.0:
                self.assertGreater(sample.torque_shared_stddev, 0.0, f"sample {sample.id}")


if __name__ == "__main__":
    rospy.init_node("guided_by_hand_test")
    rostest.rosrun(PACKAGE, "guided_by_hand", GuidedByHand, sys.argv)
