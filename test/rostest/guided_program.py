"""The program guided_session under test."""

import os
import subprocess
import threading

from calibration_client import PACKAGE, wait_for

SESSION_TIMEOUT = 600.0  # [s]


class GuidedProgram:
    """The program guided_session; keeps the lines that it prints."""

    def __init__(self, *options):
        self.lines = []
        self._process = subprocess.Popen(
            ["rosrun", PACKAGE, "guided_session", *options],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self._process.stdout:
            self.lines.append(line.rstrip("\n"))

    def says(self, part):
        return any(part in line for line in self.lines)

    def wait_until_it_says(self, part):
        wait_for(lambda: self.says(part) or self._has_failed(), f"the session to say: {part}")

    def _has_failed(self):
        if self._process.poll() is not None:
            raise AssertionError("the session ended:\n" + "\n".join(self.lines))

    def signal(self, number):
        os.killpg(self._process.pid, number)
        return self.wait()

    def wait(self):
        status = self._process.wait(timeout=SESSION_TIMEOUT)
        self._reader.join()
        return status
