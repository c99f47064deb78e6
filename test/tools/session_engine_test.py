#!/usr/bin/python3
"""How the engine of guided sessions takes goals, is cancelled, and is followed, without ROS."""

import io
import threading
import unittest

from spherical_actuator_calibration.msg import CaptureGoal, CurrentPattern, PlannedPose, SessionGoal
from spherical_actuator_calibration.session_guide import goals
from spherical_actuator_calibration.session_guide.account import KEPT, Account
from spherical_actuator_calibration.session_guide.client import Follower
from spherical_actuator_calibration.session_guide.options import OptionError, Options
from spherical_actuator_calibration.session_guide.picture import LineTerminal, LiveTerminal
from spherical_actuator_calibration.session_guide.progress import Pose
from spherical_actuator_calibration.session_guide.task import Cancelled, Task


class CancelledTask(unittest.TestCase):
    def test_ends_every_wait_at_once(self):
        task = Task()
        threading.Timer(0.05, task.cancel, ("Enough.",)).start()
        begin = task.time()
        with self.assertRaisesRegex(Cancelled, "Enough."):
            task.pause(60.0)
        self.assertLess(task.time() - begin, 10.0)
        for wait in (task.check, lambda: task.pause(0.0), lambda: task.answer_of(lambda: 1)):
            self.assertRaises(Cancelled, wait)

    def test_leaves_a_call_alone_and_can_wait_for_it(self):
        task, may_end, ended = Task(), threading.Event(), []

        def call():
            may_end.wait()
            ended.append(True)

        threading.Timer(0.05, task.cancel, ("Enough.",)).start()
        with self.assertRaises(Cancelled):
            task.answer_of(call)
        self.assertEqual(ended, [])
        may_end.set()
        task.wait_for_calls()
        self.assertEqual(ended, [True])

    def test_otherwise_gives_what_the_call_gives(self):
        task = Task()
        self.assertEqual(task.answer_of(lambda: 7), 7)
        with self.assertRaises(ZeroDivisionError):
            task.answer_of(lambda: 1 // 0)


class Goals(unittest.TestCase):
    def test_what_is_left_at_zero_is_the_default(self):
        self.assertEqual(goals.options_of(SessionGoal(seed=1), "/actuator"), Options())

    def test_hold_what_the_command_line_asks_for(self):
        for options in (
            Options(),
            Options(validation_poses=0, settling=0.0, seed=0),
            Options(current=2.0, total_current=3.0),
            Options(poses=5, settling=1.5, patterns="weighing", drive_fixture=True, repeat="/a/session.db"),
        ):
            self.assertEqual(goals.options_of(goals.goal_of(options), "/actuator"), options)

    def test_that_cannot_be_used_are_refused(self):
        for goal in (SessionGoal(poses=2), SessionGoal(current=float("nan")), SessionGoal(settling=float("inf"))):
            name = next(field for field in goal.__slots__ if getattr(goal, field))
            self.assertRaisesRegex(OptionError, f"^{name}: ", goals.options_of, goal, "/actuator")
        no_time = CaptureGoal(duration=float("nan"))
        self.assertRaisesRegex(OptionError, "^duration: nan is outside", goals.options_of_capture, no_time, "/actuator")

    def test_of_a_pose_have_the_signs_of_current_and_pattern(self):
        pattern = CurrentPattern(current=[2.0, 0.0, -2.0])
        goal = CaptureGoal(pose=PlannedPose(coils=[1, 3], patterns=[pattern]), current=-1.5, validation=True)
        self.assertEqual(goals.pose_of_capture(goal), Pose((0.0, 0.0, 0.0), ((-1, 3),), True))
        self.assertEqual(goals.options_of_capture(goal, "/actuator").current, 1.5)
        self.assertEqual(goals.options_of_capture(CaptureGoal(pose=goal.pose), "/actuator").current, 2.0)
        self.assertEqual(goals.checked_pattern((3, -1), 3), (-1, 3))
        for coils in ((), (4,), (1, -1), (0,)):
            self.assertRaises(ValueError, goals.checked_pattern, coils, 3)


class CapturedPatterns(unittest.TestCase):
    @staticmethod
    def goal(*patterns, **fields):
        return CaptureGoal(pose=PlannedPose(patterns=[CurrentPattern(current=list(p)) for p in patterns]), **fields)

    def test_carry_the_current_that_they_state(self):
        weak = self.goal((0.3, 0.0, -0.3), (0.0, 0.3, 0.0))
        goals.require_patterns(weak.pose, 3)
        self.assertEqual(goals.options_of_capture(weak, "/actuator").current, 0.3)
        weak.current = -0.5
        self.assertEqual(goals.options_of_capture(weak, "/actuator").current, 0.5)

    def test_of_several_currents_are_refused(self):
        uneven = self.goal((1.0, 2.0, 0.0))
        self.assertRaisesRegex(OptionError, "from 1 to 2 A", goals.options_of_capture, uneven, "/actuator")
        uneven.current = 1.5
        self.assertEqual(goals.options_of_capture(uneven, "/actuator").current, 1.5)

    def test_that_are_not_of_the_actuator_are_refused(self):
        for currents in ((1.0, 0.0), (0.0, 0.0, 0.0), (1.0, float("nan"), 0.0)):
            pose = self.goal((1.0, 0.0, 0.0), currents).pose
            self.assertRaisesRegex(OptionError, "pattern 2", goals.require_patterns, pose, 3)


class Following(unittest.TestCase):
    def test_tells_each_sentence_once_also_where_feedback_was_lost(self):
        account, screen = Account(), io.StringIO()
        follower = Follower(LineTerminal(screen))
        account.say("One.")
        follower.follow(account.message())
        follower.follow(account.message())
        for number in ("Two.", "Three."):
            account.say(number)
        follower.follow(account.message())
        self.assertEqual(screen.getvalue(), "One.\nTwo.\nThree.\n")

    def test_messages_repeat_the_last_sentences_only(self):
        account = Account()
        for _ in range(KEPT + 5):
            account.say("One.")
        self.assertEqual((account.message().told, len(account.message().sentences)), (KEPT + 5, KEPT))

    def test_a_message_has_the_way_to_the_pose(self):
        account = Account()
        account.lead_to(Pose((0.5, 0.0, -1.0), (), True), 0.05)
        message = account.message((0.4, 0.1, -1.0))
        self.assertEqual([round(way, 9) for way in message.way], [0.1, -0.1, 0.0])
        self.assertTrue(message.held_out)
        self.assertEqual(account.message(None).way, [])
        account.lead_to(None)
        self.assertEqual(account.message((0.4, 0.1, -1.0)).way, [])

    def test_a_file_gets_a_line_for_each_pose(self):
        screen = io.StringIO()
        follower = Follower(LineTerminal(screen))
        account = Account()
        for pose, captures, stage in ((1, 0, "turning"), (1, 2, "capturing"), (2, 2, "turning"), (2, 3, "capturing")):
            account.set(pose=pose, captures=captures, captures_wanted=4, stage=stage)
            follower.follow(account.message())
        account.set(captures=4, stage="estimating")
        follower.follow(account.message())
        self.assertEqual([line.split()[-1] for line in screen.getvalue().splitlines()], ["2/4", "4/4"])


class Drawing(unittest.TestCase):
    def setUp(self):
        self.screen = io.StringIO()
        self.terminal = LiveTerminal(self.screen, force_terminal=True, width=100)
        self.account = Account()
        self.account.lead_to(Pose((0.5, 0.0, -1.0), ()), 0.05)
        self.account.set(stage="turning", pose=2, poses=7, captures=3, captures_wanted=9, joint_names=["joint_1", "joint_2", "[red]"])

    def drawn(self, joints):
        """What a new picture brings."""
        before = len(self.screen.getvalue())
        self.terminal.show(self.account.message(joints))
        return self.screen.getvalue()[before:]

    def test_shows_the_way_of_each_joint(self):
        drawn = self.drawn((0.4, 0.01, -1.0))
        for part in ("pose 2 of 7", "turn", "joint_1", "+5.7\N{DEGREE SIGN}", "###", "there", "[red]", "3/9"):
            self.assertIn(part, drawn)
        self.assertIn("there: clamp the rotor", self.drawn((0.49, 0.01, -1.0)))

    def test_keeps_sentences_above_it_and_goes_at_the_end(self):
        self.drawn((0.4, 0.01, -1.0))
        sentence = "[bold]" + 30 * "long " + "sentence."
        self.terminal.say(sentence)
        self.assertIn(sentence, self.screen.getvalue())
        self.account.set(stage="estimating")
        self.drawn((0.4, 0.01, -1.0))
        self.terminal.say("Two.")
        self.assertTrue(self.screen.getvalue().endswith("Two.\n"))
        self.assertIn("\x1b[?25h", self.screen.getvalue())


if __name__ == "__main__":
    unittest.main()
