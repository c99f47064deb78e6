#!/usr/bin/python3
"""The engine of guided sessions by its actions alone: a whole session, cancelled, its client killed, a second one
refused, and nothing measured twice; coils excited for a look; plans and files."""

import math
import os
import pathlib
import signal
import subprocess
import sys
import time

import actionlib
import rosgraph
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from calibration_client import NAMESPACE, PACKAGE, wait_for
from emulated_lab import LabCase
from guided_program import GuidedProgram
from spherical_actuator_calibration import msg
from true_parameters import expect_truth

AT_ONCE = 0.3  # [s] in which currents end
STILL = 3.0  # [s] in which a session that goes on excites the next coil
ATTEMPTS = 4  # of which one shows that, on a computer that is busy with something else
DEADLINE = rospy.Duration(300.0)
GOAL = {"poses": 9, "drive_fixture": True, "dwell": 0.2, "settling": 0.15}
SCRIPT = pathlib.Path(__file__).parent / "session_by_action.py"


class SessionEngine(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(seed=5, commands=False)
        cls.start_lab()

    def setUp(self):
        self.feedback = None

    def action(self, name):
        client = actionlib.SimpleActionClient(f"{NAMESPACE}/calibration/{name}", getattr(msg, f"{name.capitalize()}Action"))
        self.assertTrue(client.wait_for_server(DEADLINE), name)
        return client

    def send(self, client, goal):
        self.feedback = None
        client.send_goal(goal, feedback_cb=self.keep)

    def keep(self, feedback):
        self.feedback = feedback

    def result(self, client, state):
        """Of a goal that ends in this state."""
        self.assertTrue(client.wait_for_result(DEADLINE))
        self.assertEqual(client.get_state(), state, client.get_result())
        return client.get_result()

    def wait_for_excitation(self):
        wait_for(lambda: not self.lab.is_without_current(), "an excited coil")

    def time_to_zero(self):
        """[s] until no coil carries current."""
        begin = time.monotonic()
        wait_for(self.lab.is_without_current, "zero currents")
        return time.monotonic() - begin

    def test_a_session_by_actions_alone(self):
        self.assertIn("Not saved: ", self.saved(GoalStatus.ABORTED))
        session = self.action("session")
        taken = [self.cancelled(session)]
        while min(taken) >= AT_ONCE and len(taken) < ATTEMPTS:
            taken.append(self.cancelled(session))
        print("from cancel to zero currents [s]:", ", ".join(f"{seconds:.3f}" for seconds in taken))
        self.assertLess(min(taken), AT_ONCE)
        self.client_is_killed()
        self.engine_is_killed()
        self.send(session, msg.SessionGoal(**GOAL))
        wait_for(lambda: self.feedback and self.feedback.progress.pose, "a pose")
        self.second_is_refused()
        self.check_feedback(self.feedback.progress)
        result = self.result(session, GoalStatus.SUCCEEDED)
        self.assertEqual(result.outcome, msg.SessionResult.COMPLETE)
        self.assertRegex(result.message, r"Saved (\S+\.yaml)")
        expect_truth(self, result.message.split()[1].rstrip(","), self.lab.truth)
        self.check_nothing_is_measured_twice()
        self.check_linearity()
        self.assertIn("Saved ", self.saved(GoalStatus.SUCCEEDED))

    def saved(self, state):
        """What is said when the result is to be saved if it is valid."""
        save = self.action("save")
        self.send(save, msg.SaveGoal(validate=True))
        return self.result(save, state).message

    def cancelled(self, session):
        """[s] from cancelling a session that excites a coil to zero currents."""
        self.send(session, msg.SessionGoal(**GOAL))
        self.wait_for_excitation()
        session.cancel_goal()
        taken = self.time_to_zero()
        result = self.result(session, GoalStatus.PREEMPTED)
        self.assertEqual(result.outcome, msg.SessionResult.INCOMPLETE)
        self.assertIn("Cancelled", result.message)
        self.stays_without_current()
        return taken

    def stays_without_current(self):
        """A session would have excited a coil again."""
        end = time.monotonic() + STILL
        while time.monotonic() < end:
            self.assertTrue(self.lab.is_without_current())
            time.sleep(0.01)

    def client_is_killed(self):
        """Its goal ends, so that the next one is taken."""
        script = subprocess.Popen([sys.executable, SCRIPT], stdout=subprocess.DEVNULL)
        self.wait_for_excitation()
        script.kill()
        script.wait()
        taken = self.time_to_zero()
        print(f"from SIGKILL of the client to zero currents: {taken:.3f} s")
        self.assertLess(taken, 10.0)
        self.stays_without_current()

    def engine_is_killed(self):
        """The program guided_session meets the next one."""
        program = GuidedProgram("--drive-fixture", "--poses", "8", "--dwell", "0.2", "--settling", "0.15")
        program.wait_until_it_says("measured already")
        self.wait_for_excitation()
        self.lab.kill("session_engine")
        program.wait_until_it_says("The engine has been started anew")
        self.wait_for_excitation()
        self.assertEqual(program.signal(signal.SIGINT), 1)
        self.assertTrue(program.says("Interrupted; currents are zero."), program.lines)

    def second_is_refused(self):
        for name, goal in (
            ("session", msg.SessionGoal(**GOAL)),
            ("excite", msg.ExciteGoal(coils=[1], current=1.0)),
            ("plan", msg.PlanGoal(max_poses=3)),
        ):
            second = self.action(name)
            second.send_goal(goal)
            result = self.result(second, GoalStatus.REJECTED)
            self.assertIn("is at it, by the action session: cancel that, or wait for its end.", result.message)
            # A link to an engine that ends later would be taken for one to the next.
            second.action_client.stop()

    def check_feedback(self, progress):
        self.assertEqual(progress.joint_names, ["joint_1", "joint_2", "joint_3"])
        self.assertTrue(1 <= progress.pose <= progress.poses)
        self.assertGreater(progress.captures_wanted, 0)
        wait_for(lambda: len(self.feedback.progress.way) == 3, "the way to the pose")
        wait_for(lambda: self.feedback.progress.carries and self.feedback.progress.coils, "an excited coil")
        wait_for(lambda: self.feedback.progress.joint_stddev > 0.0, "how well the joint is known")

    def check_nothing_is_measured_twice(self):
        answer = self.client.call("list_samples")
        full = max(max(map(abs, sample.current)) for sample in answer.samples)
        patterns = {}
        for sample, place, excited in zip(answer.samples, answer.places, answer.excited):
            # Without that of one coil at other currents.
            is_of_one = 0.4 * full < max(map(abs, sample.current)) < 0.6 * full or min(sample.current) <= -0.5 * full
            if excited.coils and not is_of_one:
                patterns.setdefault(place, []).append(tuple(excited.coils))
        for place, measured in patterns.items():
            self.assertEqual(len(measured), len(set(measured)), place)
            self.assertFalse(set(measured) & {tuple(-coil for coil in pattern) for pattern in measured}, place)

    def check_linearity(self):
        """One coil at three currents in one rest, once, tells that torque is proportional to it."""
        rests = {}
        for sample in self.client.held().values():
            for coil, current in enumerate(sample.current, 1):
                if abs(current) > 0.5:
                    rests.setdefault((sample.dwell, coil), []).append(current)
        (currents,) = [sorted(each) for each in rests.values() if len(each) > 1]
        for current, wanted in zip(currents, (-2.0, 1.0, 2.0)):
            self.assertAlmostEqual(current, wanted, delta=0.1)
        told = self.client.latest("status").torque_linearity
        print(told)
        self.assertRegex(told, r"^Torque is proportional to current: coil \d+ at .* deviates by -?\d\.\d+ ± \d\.\d+ %")

    def test_excitation_is_a_look_at_coils(self):
        excite = self.action("excite")
        self.send(excite, msg.ExciteGoal(coils=[3, -7], current=1.5, duration=30.0))
        wait_for(lambda: self.feedback and self.feedback.progress.carries, "excited coils")
        self.assertAlmostEqual(self.feedback.measured[2], 1.5, delta=0.1)
        self.assertAlmostEqual(self.feedback.measured[6], -1.5, delta=0.1)
        self.strangers_change_nothing()
        self.node_goes_and_comes_back()
        excite.cancel_goal()
        self.time_to_zero()
        self.result(excite, GoalStatus.PREEMPTED)
        self.send(excite, msg.ExciteGoal(coils=[3], current=1.5, duration=0.5))
        self.assertTrue(self.result(excite, GoalStatus.SUCCEEDED).success)
        self.time_to_zero()
        self.send(excite, msg.ExciteGoal(coils=[25], current=1.5))
        self.assertIn("numbers from 1 to 24", self.result(excite, GoalStatus.ABORTED).message)
        self.driver_falls_silent(excite)
        self.engine_ends(excite)

    def driver_falls_silent(self, excite):
        """Nobody knows then what flows: no look at coils succeeds."""
        self.send(excite, msg.ExciteGoal(coils=[3], current=1.5, duration=4.0))
        wait_for(lambda: self.feedback and self.feedback.progress.carries, "an excited coil")
        driver = self.lab.process_of("coil_driver")
        os.kill(driver, signal.SIGSTOP)
        try:
            message = self.result(excite, GoalStatus.ABORTED).message
        finally:
            os.kill(driver, signal.SIGCONT)
        self.assertEqual(message, "Coil 3: No currents are measured: check the coil driver.")
        wait_for(self.lab.is_without_current, "zero currents")

    def strangers_change_nothing(self):
        """Whose commands the driver refuses."""
        publisher = rospy.Publisher(f"{NAMESPACE}/coil_command", msg.CoilCurrents, queue_size=1)
        wait_for(publisher.get_num_connections, "the driver")
        for currents in ([0.0] * 24, [math.nan] * 24, [1.0], []):
            publisher.publish(msg.CoilCurrents(current=currents))
        told = self.feedback.progress
        wait_for(lambda: self.feedback.progress is not told and self.feedback.progress.carries, "excited coils")
        publisher.unregister()

    def is_judged(self, before):
        """Whether another process than before says that coils 3 and 7 carry what they are commanded."""
        try:
            carried = self.client.call("check_coils", coils=[3, -7], current=1.5).carried
            return carried and self.lab.process_of("calibration") != before
        except (rospy.ServiceException, rosgraph.MasterError, OSError):
            return False

    def node_goes_and_comes_back(self):
        """It judges what the coils carry, and is started again: the coils wait for it."""
        before = self.lab.process_of("calibration")
        self.lab.kill("calibration")
        wait_for(lambda: self.is_judged(before), "another node that judges")
        wait_for(lambda: self.feedback.progress.carries, "excited coils")
        answer = self.client.call("check_coils", coils=[3], current=1.5)
        self.assertRegex(answer.message, r"^Coil 7 carries -1\.\d+ A where 0 A are commanded")
        for coils, current in (([25], 1.0), ([3], math.nan), ([3], math.inf), ([3], 0.0)):
            answer = self.client.call("check_coils", coils=coils, current=current)
            self.assertFalse(answer.success or answer.carried)

    def engine_ends(self, excite):
        """In order: its client hears of it, and it is started again."""
        self.send(excite, msg.ExciteGoal(coils=[3], current=1.5, duration=30.0))
        wait_for(lambda: self.feedback and self.feedback.progress.carries, "an excited coil")
        self.lab.kill("session_engine", signal.SIGTERM)
        self.assertIn("the engine ends. The currents are zero", self.result(excite, GoalStatus.PREEMPTED).message)
        self.time_to_zero()
        self.assertTrue(self.action("excite").wait_for_server(DEADLINE))

    def test_poses_one_by_one(self):
        plan = self.action("plan")
        self.send(plan, msg.PlanGoal(max_poses=3))
        planned = self.result(plan, GoalStatus.SUCCEEDED)
        self.assertEqual(len(planned.poses), 3)
        capture = self.action("capture")
        goal = msg.CaptureGoal(pose=planned.poses[0], drive_fixture=True, duration=0.2)
        self.send(capture, goal)
        result = self.result(capture, GoalStatus.SUCCEEDED)
        self.assertEqual(len(result.samples), 1 + len(planned.poses[0].coils))
        held = self.client.call("list_samples")
        self.assertEqual(set(held.places[-len(result.samples) :]), {held.places[-1]})
        excited = [tuple(pattern.coils) for pattern in held.excited[-len(result.samples) :]]
        self.assertEqual(excited, [(), *((coil,) for coil in planned.poses[0].coils)])
        self.send(capture, goal)
        self.assertEqual(len(self.result(capture, GoalStatus.SUCCEEDED).samples), 0)
        self.send(capture, msg.CaptureGoal(here=True, duration=0.2))
        self.assertEqual(len(self.result(capture, GoalStatus.SUCCEEDED).samples), 1)
        self.time_to_zero()


if __name__ == "__main__":
    rospy.init_node("session_engine_test")
    rostest.rosrun(PACKAGE, "session_engine", SessionEngine, sys.argv)
