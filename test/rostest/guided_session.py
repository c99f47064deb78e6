#!/usr/bin/python3
"""A guided session in the emulated laboratory: interrupted, with every fault, to the true parameters."""

import re
import signal
import subprocess
import sys

import rospy
import rostest
from calibration_client import NAMESPACE, PACKAGE, wait_for
from emulated_lab import LabCase
from guided_program import GuidedProgram
from true_parameters import expect_truth

POSES = 8
OPTIONS = ("--drive-fixture", "--yes", "--poses", str(POSES), "--dwell", "0.2")
OPTIONS += ("--validation-poses", "1", "--settling", "0.15", "--patterns", "weighing")


class GuidedSession(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(seed=5, commands=False)
        cls.start_lab()

    def samples(self):
        """Waits while the node is away."""
        held = []

        def node_answers():
            try:
                held[:] = self.client.held()
                return True
            except rospy.ServiceException:
                return False

        wait_for(node_answers, "an answer of the node")
        return len(held)

    def further_samples(self, count):
        """Until the session has made so many samples more."""
        enough = self.samples() + count
        wait_for(lambda: self.samples() >= enough, f"{count} further samples")

    def test_a_whole_session(self):
        session = GuidedProgram(*OPTIONS)
        self.further_samples(3)
        self.fault_is_told_and_cured(session, "lose_tracker", "measured_orientation")
        self.fault_is_told_and_cured(session, "trip_amplifier", "check the amplifier")
        self.fault_is_told_and_cured(session, "freeze_sensor", "check fixture and joint sensor")
        self.lab.inject_outlier()
        self.interrupted(session)

        session = GuidedProgram(*OPTIONS)
        session.wait_until_it_says("measured already")
        self.further_samples(2)
        self.killed(session)

        session = GuidedProgram(*OPTIONS)
        session.wait_until_it_says("measured already")
        self.further_samples(2)
        self.node_restarted(session)
        self.assertEqual(session.wait(), 0, "\n".join(session.lines))
        self.assertTrue(session.says("they agree with the parameters"), session.lines)
        self.assertTrue(session.says("Torque is proportional to current: coil "), session.lines)
        self.assertTrue(session.says("all 73 parameters are identified"), session.lines)
        self.assertTrue(session.says("Grade: good."), session.lines)
        self.check_result(session)
        self.check_patterns()

    def fault_is_told_and_cured(self, session, fault, part):
        self.lab.fault(fault, True)
        session.wait_until_it_says(part)
        self.lab.fault(fault, False)
        self.further_samples(2)

    def interrupted(self, session):
        self.assertEqual(session.signal(signal.SIGINT), 1)
        self.assertTrue(session.says("Interrupted"), session.lines)
        wait_for(self.lab.is_without_current, "zero currents")

    def killed(self, session):
        session.signal(signal.SIGKILL)
        wait_for(self.lab.is_without_current, "zero currents by the watchdog")

    def node_restarted(self, session):
        """Until the session has met it: between two poses it may ask nothing while the node is away."""
        while not session.says("The calibration node is back"):
            subprocess.run(
                ["rosnode", "kill", f"{NAMESPACE}/calibration"], check=True, stdout=subprocess.DEVNULL
            )
            self.further_samples(2)

    def check_patterns(self):
        """Of the plan: several coils at once, some currents negative; of held-out samples: one coil at most."""
        samples = self.client.held().values()
        planned = [sample.current for sample in samples if sample.has_torque and not sample.validation]
        self.assertTrue(any(min(current) < -1.0 for current in planned))
        self.assertLess(max(sum(map(abs, current)) for current in planned), 8.5)
        for sample in samples:
            excited = sum(abs(current) > 1.0 for current in sample.current)
            self.assertLessEqual(excited, 1 if sample.validation else 4)

    def check_result(self, session):
        saved = next(line for line in session.lines if line.startswith("Saved "))
        expect_truth(self, re.match(r"Saved (\S+\.yaml)", saved).group(1), self.lab.truth)


if __name__ == "__main__":
    rospy.init_node("guided_session_test")
    rostest.rosrun(PACKAGE, "guided_session", GuidedSession, sys.argv)
