#!/usr/bin/python3
"""What calibrate_by_motion plans, carries out and calibrates, and with which options; the programs it starts are told
only."""

import os
import pathlib
import signal
import tempfile
import time
import unittest
from unittest import mock

from program_module import loaded

LOST = 3  # status of run_motion
SOURCE = pathlib.Path(os.environ["SOURCE"])


class Recording:
    """One bag of each motion."""

    def __init__(self, _ns, folder):
        self._bag = folder / "recordings" / "1.bag"

    def wait_until_up(self):
        """At once."""

    def look(self, say):
        """It goes on."""

    def close(self):
        self.close_as(self._bag.name)
        return [str(self._bag)]

    def close_as(self, name):
        self._bag.parent.mkdir()
        (self._bag.parent / name).touch()


def close_without_end(recording):
    """That of a recorder which was killed."""
    recording.close_as("1.bag.active")
    return []


def wait_for(path):
    deadline = time.monotonic() + 60.0
    while not path.exists() and time.monotonic() < deadline:
        time.sleep(0.01)
    assert path.exists(), path


class CalibrateByMotion(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "new"
        self.is_as_drawn = False
        self.started = []  # programs with their arguments
        self.fails = lambda command: False
        self.is_sound = True
        self.tells_nothing = False  # the recordings, of the parameters
        self.gives_parameters = True  # beside a report
        self.module = loaded("calibrate_by_motion")
        self.recording = self.module.Recording
        for name, fake in (("program", str), ("status_of", self.status_of), ("Recording", Recording)):
            patch = mock.patch.object(self.module, name, fake)
            patch.start()
            self.addCleanup(patch.stop)
        watch = mock.patch.object(self.module, "ProgressWatch")
        watch.start().return_value.end.return_value = True
        self.addCleanup(watch.stop)

    def status_of(self, command, _look=None):
        words = [str(word) for word in command]
        self.started.append(words)
        if words[0] == "calibrate_bag" and not self.tells_nothing:
            if self.gives_parameters:
                pathlib.Path(words[words.index("--output") + 1]).touch()
            report = pathlib.Path(words[words.index("--report") + 1]) / "report.yaml"
            report.parent.mkdir()
            report.write_text(f"calibration_report: {{verdict: {{sound: {str(self.is_sound).lower()}}}}}")
        return int(self.fails(words))

    def run_with(self, *arguments):
        """Its status, and what it says."""
        options = self.module.parse(["--actuator", "A.yaml", "--directory", str(self.folder), *arguments])
        terminal = mock.Mock()
        status = self.module.carried_out(options, self.is_as_drawn, terminal)
        return status, " ".join(call.args[0] for call in terminal.say.call_args_list)

    def loses_first(self, rotors):
        """As many motions lose the rotor, before one does not."""
        self.fails = lambda words: LOST if words[0] == "run_motion" and len(self.of_program("run_motion")) <= rotors else 0

    def of_program(self, name):
        return [words for words in self.started if words[0] == name]

    def test_a_recorder_ends_with_a_program_that_is_killed(self):
        recorder, begun, ended = (pathlib.Path(self.folder.parent) / name for name in ("recorder", "begun", "ended"))
        recorder.write_text(f"#!/bin/bash\ntrap 'touch {ended}; exit' INT\ntouch {begun}\nfor n in {{1..1200}}; do sleep 0.05; done\n")
        recorder.chmod(0o755)
        pid = os.fork()
        if pid == 0:
            with mock.patch.object(self.module, "program", lambda _name: str(recorder)):
                self.recording("/actuator", self.folder)
            signal.pause()
        wait_for(begun)
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
        wait_for(ended)

    def test_plans_moves_and_calibrates_once(self):
        status, _ = self.run_with()
        self.assertEqual(status, 0)
        self.assertEqual([words[0] for words in self.started], ["plan_motion", "run_motion", "calibrate_bag"])
        self.assertIn("--duration=60.0", self.started[0])
        # What is in force may be another one.
        self.assertEqual(self.started[1][self.started[1].index("--parameters") + 1], "A.yaml")

    def test_begins_gently_and_goes_on_by_what_that_tells(self):
        status, _ = self.run_with("--gently", "--plan-option=--joint-rate=1000", "--plan-option=--tilt=0.1")
        self.assertEqual(status, 0)
        gentle = str(self.folder / "gentle" / "calibrated.yaml")
        (first, plan), (slow, fast), (alone, both) = map(self.of_program, ("plan_motion", "run_motion", "calibrate_bag"))
        self.assertEqual(first[first.index("--actuator") + 1], "A.yaml")
        # What the user says counts for both, and stands once.
        self.assertEqual([word for word in first if "--tilt" in word], ["--tilt=0.1"])
        self.assertTrue({"--duration=10.0", "--rate=1.5", "--excitation=0.05", "--joint-rate=1000"} <= set(first))
        self.assertEqual(slow[slow.index("--parameters") + 1], "A.yaml")
        self.assertEqual(plan[plan.index("--actuator") + 1], gentle)
        self.assertTrue({"--duration=60.0", "--joint-rate=1000", "--tilt=0.1"} <= set(plan))
        self.assertNotIn("--rate=1.5", plan)
        self.assertEqual(fast[fast.index("--parameters") + 1], gentle)
        # The result is that of both motions, from the drawing on.
        bags = [str(self.folder / "gentle" / "recordings" / "1.bag"), str(self.folder / "recordings" / "1.bag")]
        self.assertEqual(alone[-1:], bags[:1])
        self.assertEqual(both[-2:], bags)
        self.assertEqual(both[both.index("--actuator") + 1], "A.yaml")
        self.assertEqual(both[both.index("--output") + 1], str(self.folder / "calibrated.yaml"))

    def test_begins_gently_by_a_drawing_where_something_can_hold_the_rotor(self):
        def is_gentle(is_as_drawn, *arguments, is_terminal=False):
            options = self.module.parse(["--actuator", "A.yaml", "--directory", str(self.folder), *arguments])
            with mock.patch.object(self.module.sys, "stdin") as stdin:
                stdin.isatty.return_value = is_terminal
                return self.module.begins_gently(options, is_as_drawn)

        self.assertTrue(is_gentle(True, "--fixture", "lab"))
        self.assertTrue(is_gentle(True, is_terminal=True))
        self.assertFalse(is_gentle(True))
        self.assertFalse(is_gentle(False, "--fixture", "lab", is_terminal=True))
        self.assertTrue(is_gentle(False, "--gently"))
        self.assertFalse(is_gentle(True, "--fixture", "lab", "--no-gently"))
        # What the motion is to be somebody has said.
        self.assertFalse(is_gentle(True, "--fixture", "lab", "--plan", "P.yaml"))

    def test_a_hand_brings_the_rotor_back_between_two_motions(self):
        with mock.patch.object(self.module.sys, "stdin") as stdin:
            stdin.readline.side_effect = lambda: self.started.append(["Enter"])
            status, said = self.run_with("--gently")
        self.assertEqual(status, 0)
        names = [words[0] for words in self.started]
        self.assertEqual(
            names, ["plan_motion", "run_motion", "calibrate_bag", "plan_motion", "Enter", "run_motion", "calibrate_bag"]
        )
        self.assertIn("press Enter", said)

    def test_a_rotor_lost_in_the_gentle_motion_moves_again_so(self):
        self.loses_first(1)
        status, _ = self.run_with("--gently", "--fixture", "lab")
        self.assertEqual(status, 0)
        gentle = self.folder / "gentle"
        bags = [str(path / "recordings" / "1.bag") for path in (gentle, gentle / "again", self.folder)]
        first, again, fast = self.of_program("run_motion")
        self.assertEqual(first[1], again[1])
        self.assertEqual(again[again.index("--parameters") + 1], str(gentle / "again" / "calibrated.yaml"))
        self.assertEqual(fast[fast.index("--parameters") + 1], str(gentle / "calibrated.yaml"))
        self.assertEqual([words[-n:] for n, words in enumerate(self.of_program("calibrate_bag"), 1)], [bags[:1], bags[:2], bags])

    def test_a_motion_that_fails_loses_nothing_that_was_recorded(self):
        self.fails = lambda words: words[0] == "run_motion" and len(self.of_program("run_motion")) == 2
        status, said = self.run_with("--gently")
        self.assertEqual(status, 1)
        self.assertIn("The motion failed.", said)
        self.assertIn("rosrun spherical_actuator_calibration calibrate_bag", said)
        self.assertIn(f"{self.folder}/gentle/recordings/1.bag {self.folder}/recordings/1.bag", said)
        self.assertEqual(len(self.of_program("run_motion")), 2)

    def test_a_lost_rotor_moves_again_by_what_was_told_until_then(self):
        self.loses_first(1)
        status, said = self.run_with("--fixture", "lab")
        self.assertEqual(status, 0)
        (plan,), (first, again), (alone, both) = map(self.of_program, ("plan_motion", "run_motion", "calibrate_bag"))
        told = str(self.folder / "again" / "calibrated.yaml")
        bags = [str(self.folder / "recordings" / "1.bag"), str(self.folder / "again" / "recordings" / "1.bag")]
        self.assertEqual(first[1], again[1])
        self.assertIn(first[1], plan)
        self.assertEqual(alone[alone.index("--output") + 1], told)
        self.assertEqual(alone[-1:], bags[:1])
        self.assertEqual(again[again.index("--parameters") + 1], told)
        self.assertEqual(both[-2:], bags)
        self.assertEqual(both[both.index("--actuator") + 1], "A.yaml")
        self.assertIn("did not follow", said)

    def test_a_rotor_that_is_lost_twice_ends_it(self):
        self.fails = lambda words: LOST if words[0] == "run_motion" else 0
        status, said = self.run_with("--fixture", "lab")
        self.assertEqual(status, 1)
        self.assertIn("--gently", said)
        self.assertEqual(len(self.of_program("run_motion")), 2)
        self.assertIn(f"{self.folder}/again/recordings/1.bag {self.folder}/recordings/1.bag", said)

    def test_a_loss_that_tells_nothing_is_the_end(self):
        self.fails = lambda words: LOST if words[0] == "run_motion" else 0
        self.tells_nothing = True
        status, said = self.run_with("--fixture", "lab")
        self.assertEqual(status, 1)
        self.assertIn("no calibration to go on by", said)
        self.assertEqual(len(self.of_program("run_motion")), 1)
        self.assertIn(f"{self.folder}/recordings/1.bag", said)

    def test_a_lost_rotor_that_nothing_holds_is_left_alone(self):
        self.fails = lambda words: LOST if words[0] == "run_motion" else 0
        status, said = self.run_with()
        self.assertEqual(status, 1)
        self.assertIn("Bring it to rest", said)
        self.assertEqual(len(self.of_program("run_motion")), 1)
        self.assertIn(f"{self.folder}/recordings/1.bag", said)

    def test_a_drawing_does_not_replace_what_is_in_force(self):
        self.is_as_drawn = True
        self.run_with("--no-gently")
        self.assertNotIn("--parameters", self.of_program("run_motion")[0])

    def test_what_contradicts_is_no_success(self):
        self.is_sound = False
        status, said = self.run_with()
        self.assertEqual(status, 1)
        # What it gave before is there already.
        self.assertIn("What was recorded can be calibrated from: rosrun spherical_actuator_calibration calibrate_bag --force", said)

    def test_overwrites_a_report_without_parameters(self):
        self.fails = lambda words: words[0] == "calibrate_bag"
        self.gives_parameters = False
        _, said = self.run_with()
        self.assertIn("calibrate_bag --force", said)

    def test_says_once_that_a_recorder_has_ended(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(self.module, "program", lambda _: "/bin/false"):
            recording = self.recording("/actuator", pathlib.Path(folder))
            said = []
            while not said:
                recording.look(said.append)
            recording.look(said.append)
            self.assertEqual(said, ["The recorder has ended (status 1): what comes now is not recorded. How to go on is told at the end of the motion."])
            self.assertEqual(recording.close(), [])

    def test_tells_how_to_rescue_what_a_killed_recorder_has_left(self):
        for status in (0, 1, LOST):
            with self.subTest(status), tempfile.TemporaryDirectory() as folder:
                self.folder = pathlib.Path(folder) / "new"
                self.fails = lambda words, status=status: status if words[0] == "run_motion" else 0
                with mock.patch.object(Recording, "close", close_without_end):
                    result, said = self.run_with()
                self.assertEqual(result, 1)
                bag = self.folder / "recordings" / "1.bag.active"
                self.assertIn(f"rosbag reindex {bag} && rosrun spherical_actuator_calibration calibrate_bag --actuator", said)
                self.assertTrue(said.endswith(str(bag)))
                self.assertEqual("rosservice call /actuator/calibration/calibrate_motion 0" in said, status != 1)

    def test_an_interrupt_tells_what_was_recorded(self):
        def interrupt(words):
            if words[0] == "calibrate_bag":
                raise KeyboardInterrupt
            return 0

        self.fails = interrupt
        status, said = self.run_with()
        self.assertEqual(status, 1)
        self.assertIn("Interrupted.", said)
        self.assertIn(f"{self.folder}/recordings/1.bag", said)

    def test_an_interrupt_at_the_begin_ends_the_recording(self):
        with mock.patch.object(Recording, "wait_until_up", side_effect=KeyboardInterrupt):
            status, _ = self.run_with()
        self.assertEqual(status, 1)
        self.assertTrue((self.folder / "recordings" / "1.bag").exists())

    def test_files_of_others_are_left_alone(self):
        self.folder.mkdir()
        (self.folder / "recordings").mkdir()
        (self.folder / "recordings" / "1.bag").touch()
        actuator = SOURCE / "config" / "pm_spherical_8x24.yaml"
        options = self.module.parse(["--actuator", str(actuator), "--directory", str(self.folder)])
        with self.assertRaisesRegex(self.module.TextFileError, "is not empty"):
            self.module.require_files(options)
        options = self.module.parse(["--actuator", str(actuator), "--directory", str(self.folder / "new")])
        self.module.require_files(options)

    def test_begins_gently_without_a_plan_only(self):
        with self.assertRaises(SystemExit) as refused, mock.patch("sys.stderr"):
            self.run_with("--gently", "--plan", "P.yaml")
        self.assertEqual(refused.exception.code, 2)


if __name__ == "__main__":
    unittest.main()
