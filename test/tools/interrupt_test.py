#!/usr/bin/python3
"""What a program does that is told to end more than once: it takes the currents to zero first."""

import os
import signal
import subprocess
import sys
import unittest

PROGRAM = """
import time
from spherical_actuator_calibration import interrupt

interrupt.PATIENCE = {patience}
interrupt.end_by_exception()
try:
    print("works", flush=True)
    time.sleep(60.0)
except KeyboardInterrupt:
    print("ends", flush=True)
    time.sleep({ending})
    print("ended")
"""

WAITS = """
import sys
from spherical_actuator_calibration.interrupt import registered

print("waits", flush=True)
sys.exit(0 if registered("a_program", anonymous=True) else 7)
"""
NOWHERE = "http://127.0.0.1:1"  # where no master listens


class InterruptTest(unittest.TestCase):
    def interrupted_twice(self, second, **values):
        """Of a program that is told to end, and by the signal `second` again while it does so: status and what it
        printed after that."""
        command = [sys.executable, "-c", PROGRAM.format(**values)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as program:
            self.assertEqual(program.stdout.readline(), "works\n")
            program.send_signal(signal.SIGINT)
            self.assertEqual(program.stdout.readline(), "ends\n")
            program.send_signal(second)
            rest, errors = program.communicate(timeout=60.0)
            return program.returncode, rest, errors

    def test_a_second_signal_does_not_keep_it_from_ending(self):
        for second in (signal.SIGINT, signal.SIGTERM):
            self.assertEqual(self.interrupted_twice(second, patience=50.0, ending=0.5), (0, "ended\n", ""))

    def test_what_does_not_end_is_ended_by_a_later_one(self):
        status, rest, errors = self.interrupted_twice(signal.SIGINT, patience=0.0, ending=50.0)
        self.assertNotEqual(status, 0)
        self.assertEqual(rest, "")
        self.assertIn("KeyboardInterrupt", errors)

    def test_one_that_waits_for_a_master_ends_with_a_sentence(self):
        for number in 5 * (signal.SIGINT, signal.SIGTERM):
            environment = {**os.environ, "ROS_MASTER_URI": NOWHERE}
            command = [sys.executable, "-c", WAITS]
            program = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment)
            self.addCleanup(program.wait)
            self.addCleanup(program.kill)
            said = [program.stdout.readline(), program.stdout.readline()]
            program.send_signal(number)
            said += program.communicate(timeout=60.0)[0].splitlines()
            waits = f"a_program: no ROS master answers at {NOWHERE}; waiting for one.\n"
            self.assertEqual(said, ["waits\n", waits, "a_program: interrupted before it began."])
            self.assertEqual(program.returncode, 7)


if __name__ == "__main__":
    unittest.main()
