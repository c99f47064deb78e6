#!/usr/bin/python3
"""What the panel of rviz has the engine do beside measuring, by keys on a screen that nobody sees: it excites a coil, whose
current ends with a key and with the panel; it plans, or does not any more; it lists revisions, of which one is restored."""

import os
import signal
import sys
import time

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from calibration_client import NAMESPACE, PACKAGE, wait_for
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import (
    ActuatorParameters,
    CoilCurrents,
    ExciteActionResult,
    PlanActionFeedback,
    PlanActionResult,
)
from viewed_lab import PAUSE, ViewedLabCase, find_button

EXCITE, PLAN, REVISIONS, RESTORE = "F12", "F2", "alt+r", "alt+e"
CURRENT = 2.0  # [A] that the panel has by itself
DURATION = 10.0  # [s] likewise
PATIENCE = 20.0  # [s] in which the engine does what a key asks for; pressed again, it would stop that
DOUBLE_CLICK = 0.6  # [s] after which a second press is one of its own
CLOSE = (500, 71)  # button of the dock that the panel is in, with Qt 5 and with Qt 6


class PanelActions(ViewedLabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(commands=False, seed=5)
        cls.currents = ()
        cls.excitations, cls.planning, cls.plans, cls.parameters, cls.wanted = [], [], [], [], []
        for topic, kind, messages in (
            ("calibration/excite/result", ExciteActionResult, cls.excitations),
            ("calibration/plan/feedback", PlanActionFeedback, cls.planning),
            ("calibration/plan/result", PlanActionResult, cls.plans),
            ("parameters", ActuatorParameters, cls.parameters),
            ("wanted_pose", JointState, cls.wanted),
        ):
            rospy.Subscriber(f"{NAMESPACE}/{topic}", kind, messages.append)
        rospy.Subscriber(f"{NAMESPACE}/coil_currents", CoilCurrents, cls.keep_currents)
        cls.start_lab()
        cls.wait_for_panel()
        wait_for(lambda: cls.currents, "the currents")

    @classmethod
    def keep_currents(cls, message):
        cls.currents = message.current

    def is_excited(self):
        return abs(self.currents[0] - CURRENT) < 0.1 and max(map(abs, self.currents[1:])) < 0.1

    def time_of_excitation(self, end):
        """[s] for which the first coil carries current where `end` is done once it does."""
        self.press(EXCITE, self.is_excited, "the current of the first coil", pause=PATIENCE)
        begin = time.monotonic()
        end()
        wait_for(self.lab.is_without_current, "zero currents")
        return time.monotonic() - begin

    def test_1_excites_a_coil_until_it_is_told_to_stop(self):
        self.assertLess(self.time_of_excitation(lambda: self.key(EXCITE)), 0.5 * DURATION)
        wait_for(lambda: self.excitations, "the result")
        self.assertIn("Cancelled: its client asked for it.", self.excitations[-1].result.message)

    def test_2_excites_no_longer_than_it_says(self):
        self.assertGreater(self.time_of_excitation(lambda: None), 0.8 * DURATION)
        wait_for(lambda: self.excitations[-1].result.success, "the result of all the time")

    def test_3_a_plan_that_nobody_wants_any_more_is_not_taken(self):
        node = self.lab.process_of("calibration")
        os.kill(node, signal.SIGSTOP)
        try:
            self.press(PLAN, lambda: self.planning, "the plan under way", pause=PATIENCE)
            time.sleep(DOUBLE_CLICK)
            self.press(PLAN, lambda: self.plans, "the end of the plan", pause=PATIENCE)
        finally:
            os.kill(node, signal.SIGCONT)
        self.assertEqual(self.plans[-1].status.status, GoalStatus.PREEMPTED)
        self.press(PLAN, lambda: len(self.plans) > 1, "a plan", pause=PATIENCE)
        self.assertTrue(self.plans[-1].result.success)
        wait_for(lambda: self.wanted and self.wanted[-1].position, "the pose to go to")
        for told, planned in zip(self.wanted[-1].position, self.plans[-1].result.poses[0].joint_position):
            self.assertAlmostEqual(told, planned)

    def test_3b_a_double_click_plans(self):
        before = len(self.plans)
        # Again, as the panel may not have taken the end of the last plan yet.
        self.press(f"{PLAN} {PLAN}", lambda: len(self.plans) > before, "a plan", pause=PATIENCE)
        self.assertTrue(self.plans[-1].result.success, self.plans[-1].result.message)

    def test_4_restores_a_revision_of_the_list(self):
        for _ in range(2):
            self.assertTrue(self.client.call("reset").success)
        wait_for(lambda: self.parameters[-1].revision == 2, "revisions")
        wait_for(self.restored, "the revision")
        self.assertEqual((self.parameters[-1].source, self.parameters[-1].revision), ("restored", 3))

    def restored(self):
        """The second one of the list, newest first: revision 1."""
        self.key(REVISIONS)
        time.sleep(PAUSE)  # until they are listed
        for key in ("Home", "Down", RESTORE):
            self.key(key)
        time.sleep(PAUSE)
        return self.parameters[-1].revision > 2

    def test_9_a_closed_panel_excites_nothing(self):
        self.assertLess(self.time_of_excitation(lambda: self.screen.click(*CLOSE)), 0.5 * DURATION)
        wait_for(lambda: not find_button(self.screen.pixels()), "the panel to be closed")


if __name__ == "__main__":
    rospy.init_node("panel_actions_test")
    rostest.rosrun(PACKAGE, "panel_actions", PanelActions, sys.argv)
