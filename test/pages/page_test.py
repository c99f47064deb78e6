#!/usr/bin/python3
"""Every block of code of a page works as it stands there: page_test.py PAGE...

The reader has a copy of the package, has built it and has called `source build/devel/setup.bash`; the page begins in the
folder of the package, and goes from block to block in one folder with one laboratory. Environment: SOURCE, BUILD.
"""

import contextlib
import os
import pathlib
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time

import yaml
from page_blocks import ALONE, LISTED, PageError, blocks_of
from page_folder import copy_of_package, environment_of

SOURCE = pathlib.Path(os.environ["SOURCE"])
BUILD = pathlib.Path(os.environ["BUILD"])
TIMEOUT = 600.0  # [s] of a block, on however busy a computer
# A service tells failure in its answer; the command that called it succeeds all the same.
REFUSED = re.compile(r"^success: False", re.MULTILINE)
# Calls of ctest only list what they would run, in a folder of their own: a list, too, replaces the log of a run.
CTEST = """#!/bin/bash
place=$(mktemp -d)
trap 'rm -r "$place"' EXIT
echo "subdirs(\\"$PWD\\")" > "$place/CTestTestfile.cmake"
cd "$place"
/usr/bin/ctest -N "$@" | tee /dev/stderr | grep -q "Total Tests: [1-9]"
"""


class Failure(Exception):
    """A block that does not do what the page says."""


class Terminal:
    """A command that goes on by itself; what it says is kept."""

    def __init__(self, command, folder, environment):
        self.command = command
        self.said = []
        self._process = subprocess.Popen(
            ["bash", "-c", command],
            cwd=folder,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        # As it comes: a question does not end its line.
        while chunk := os.read(self._process.stdout.fileno(), 65536):
            self.said.append(chunk.decode("utf-8", errors="replace"))

    def text(self):
        return "".join(self.said)

    def status(self):
        return self._process.poll()

    def stop(self):
        """Ctrl-C."""
        for number in (signal.SIGINT, signal.SIGKILL):
            try:
                os.killpg(self._process.pid, number)
                self._process.wait(timeout=60.0)
            except (ProcessLookupError, subprocess.TimeoutExpired):
                continue
        self._reader.join(timeout=10.0)


class Reader:
    """Goes through the pages, one after the other."""

    def __init__(self, root):
        self.root = root
        self.package = copy_of_package(SOURCE, BUILD, root)
        self.environment = environment_of(self.package, root)
        self.terminals = []
        self.tests = None

    def read(self, page):
        """Runs all blocks of a page; returns what is wrong with them."""
        failures = []
        self.folder = self.package
        try:
            for block in blocks_of((self.package / page).read_text(encoding="utf-8")):
                begin = time.monotonic()
                try:
                    self.run(block)
                except Failure as failure:
                    failures.append(f"{page}:{block.line}: {failure}")
                print(f"{page}:{block.line} {block.how or block.language}: {time.monotonic() - begin:.1f} s", flush=True)
        except PageError as error:
            failures.append(f"{page}: {error}")
        finally:
            self.close_terminals()
        return failures

    def run(self, block):
        if block.elsewhere:
            self.check_elsewhere(block)
        elif block.language == "bash" and block.terminals:
            self.run_in_terminals(block)
        elif block.language == "bash":
            self.run_in_shell(block)
        elif block.language == "yaml":
            self.check_yaml(block)
        elif block.language == "sql":
            self.query(block)
        elif block.language == "python":
            self.run_python(block)
        elif block.language != "text":
            raise Failure(f'a block of "{block.language}" is not known.')

    def run_in_shell(self, block):
        """In one shell that ends with the first command that fails; where it leaves the folder, the next one begins."""
        if block.how == ALONE:
            self.close_terminals()
        place = self.root / "folder"
        environment = dict(self.environment)
        if block.how == LISTED:
            shim = self.root / "shim"
            shim.mkdir(exist_ok=True)
            (shim / "ctest").write_text(CTEST)
            (shim / "ctest").chmod(0o755)
            environment["PATH"] = f"{shim}:{environment['PATH']}"
        script = f"source '{self.package}/build/devel/setup.bash'; export ROS_MASTER_URI={self.environment['ROS_MASTER_URI']}\n"
        script += f"trap 'pwd > {place}' EXIT; set -eo pipefail\n{block.text}"
        outcome = self.finished(["bash", "-c", script], environment)
        if outcome.returncode != block.status or REFUSED.search(outcome.stdout):
            raise Failure(f"it does not succeed ({outcome.returncode}):\n{block.text}{outcome.stdout}")
        self.folder = pathlib.Path(place.read_text().strip())

    def finished(self, command, environment):
        try:
            return subprocess.run(
                command, cwd=self.folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT, text=True, errors="replace", timeout=TIMEOUT, check=False
            )  # fmt: skip
        except subprocess.TimeoutExpired as late:
            raise Failure(f"it has not ended after {TIMEOUT:.0f} s:\n{late.output}") from late

    def run_in_terminals(self, block):
        """The first commands go on; the last one succeeds, or has said what the page waits for."""
        self.close_terminals()
        until = block.terminals["until"]
        self.open_master()
        self.open_screen()
        if until:
            self.open_devices()
        started = [self.open_terminal(command) for command in block.commands()]
        last = started[-1]
        deadline = time.monotonic() + TIMEOUT
        while last is not started[0] and last.status() is None and not (until and until in last.text()):
            if any(other.status() is not None for other in started[:-1]) or time.monotonic() > deadline:
                break
            time.sleep(0.1)
        if last is started[0]:
            self.wait_until_up()
            return
        succeeded = until in last.text() if until else last.status() == 0
        if not succeeded or any(other.status() is not None for other in started[:-1]):
            said = "\n".join(f"$ {one.command}\n{one.text()[-4000:]}" for one in started)
            raise Failure(f"it does not succeed ({last.status()}):\n{said}")
        if until:
            self.close_terminals()

    def open_terminal(self, command):
        """The next command comes once the launch file before it has started, as a reader is no faster."""
        self.wait_until_up()
        prefix = f"source '{self.package}/build/devel/setup.bash'; export ROS_MASTER_URI={self.environment['ROS_MASTER_URI']}; "
        self.terminals.append(Terminal(prefix + command, self.folder, self.environment))
        return self.terminals[-1]

    def wait_until_up(self):
        """Until the services of what was launched are there."""
        launched = [one for one in self.terminals if "roslaunch" in one.command]
        if not launched:
            return
        wanted = "/actuator/calibration/save" if "lab.launch" in launched[-1].command else "/lab_emulator/"
        deadline = time.monotonic() + TIMEOUT
        while wanted not in self.services():
            if time.monotonic() > deadline or launched[-1].status() is not None:
                raise Failure(f"there is no {wanted}:\n" + launched[-1].text()[-4000:])

    def services(self):
        command = ["rosservice", "list"]
        outcome = subprocess.run(command, env=self.environment, capture_output=True, text=True, check=False)
        return outcome.stdout

    def open_master(self):
        """roslaunch finds a master: for its own it waits for ten seconds only, however busy the computer is."""
        port = self.environment["ROS_MASTER_URI"].rsplit(":", 1)[1]
        self.terminals.append(Terminal(f"exec rosmaster --core -p {port}", self.folder, self.environment))
        deadline = time.monotonic() + TIMEOUT
        while subprocess.run(["rosparam", "list"], env=self.environment, capture_output=True, check=False).returncode:
            if time.monotonic() > deadline:
                raise Failure("there is no master:\n" + self.terminals[-1].text())

    def open_screen(self):
        """An empty screen for rviz, with a number that is free."""
        if not shutil.which("Xvfb"):
            raise Failure("there is no Xvfb.")
        number = self.root / "screen"
        command = f"exec Xvfb -displayfd 5 -screen 0 320x240x24 5>'{number}'"
        self.terminals.append(Terminal(command, self.folder, self.environment))
        deadline = time.monotonic() + TIMEOUT
        while not (number.exists() and number.read_text().endswith("\n")):
            if time.monotonic() > deadline or self.terminals[-1].status() is not None:
                raise Failure("Xvfb has no screen:\n" + self.terminals[-1].text())
            time.sleep(0.05)
        self.environment["DISPLAY"] = ":" + number.read_text().strip()

    def open_devices(self):
        """The hardware of the laboratory that the reader has."""
        launch = pathlib.Path(__file__).with_name("devices.launch")
        self.open_terminal(f"roslaunch {launch}")

    def close_terminals(self):
        while self.terminals:
            self.terminals.pop().stop()

    def check_elsewhere(self, block):
        """What it calls is there, and so is the test that does the same."""
        for command in block.commands():
            program = self.package / command.split()[0]
            if "/" in command.split()[0] and not os.access(program, os.X_OK):
                raise Failure(f"there is no program {command.split()[0]}.")
        name = block.elsewhere["test"]
        if name == ".ci/run":
            found = re.findall(r"^(?:exec )?(scripts/\w+)", (self.package / name).read_text(), re.MULTILINE)
            found += re.findall(r"^(scripts/\w+)", (self.package / found[0]).read_text(), re.MULTILINE)
            if not any(program in block.text for program in found):
                raise Failure(f"{name} runs {found}, none of which stands here.")
        elif name not in self.names_of_tests():
            raise Failure(f"there is no test {name}.")

    def names_of_tests(self):
        if self.tests is None:
            with tempfile.TemporaryDirectory() as folder:
                (pathlib.Path(folder) / "CTestTestfile.cmake").write_text(f'subdirs("{BUILD}")')
                command = ["ctest", "-N"]
                listed = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, text=True, check=True).stdout
            names = re.findall(r"^ *Test +#\d+: (\S+)", listed, re.MULTILINE)
            self.tests = {re.sub(r"^_ctest_\w+_rostest_test_rostest_(\w+)\.test$", r"\1", name) for name in names}
            # Also those that a build without the session database leaves out.
            self.tests |= {path.stem for path in (self.package / "test/rostest").glob("*.test")}
        return self.tests

    def check_yaml(self, block):
        """A description is read by a program; any other is at least YAML."""
        content = yaml.safe_load(block.text)
        if "actuator" in content:
            (self.folder / "described.yaml").write_text(block.text)
            program = self.package / "build/devel/lib/spherical_actuator_calibration/generate_urdf"
            command = [str(program), "--actuator", "described.yaml", "--output", "described.urdf"]
            outcome = self.finished(command, self.environment)
            if outcome.returncode != 0:
                raise Failure(outcome.stdout)

    def query(self, block):
        """Statements about the session database that a block before has made."""
        with contextlib.closing(sqlite3.connect(f"file:{self.session_database()}?mode=ro", uri=True)) as connection:
            statements = re.sub(r"^--.*$", "", block.text, flags=re.MULTILINE).split(";")
            try:
                for statement in statements:
                    connection.execute(statement).fetchall()
            except sqlite3.Error as error:
                raise Failure(f"{error}: {statement}") from error

    def session_database(self):
        found = sorted((self.root / "home").rglob("session.db"))
        if not found:
            raise Failure("no session.db was made by a block before.")
        return found[0]

    def run_python(self, block):
        (self.folder / "block.py").write_text(block.text)
        database = self.session_database()
        for file in database.parent.glob("session.db*"):
            shutil.copy(file, self.folder / file.name)
        outcome = self.finished(["/usr/bin/python3", "block.py"], self.environment)
        if outcome.returncode != 0:
            raise Failure(outcome.stdout)


def main():
    failures = []
    root = tempfile.mkdtemp()
    try:
        reader = Reader(pathlib.Path(root))
        for page in sys.argv[1:]:
            failures += reader.read(page)
    finally:
        # What a block started may still be writing there.
        shutil.rmtree(root, ignore_errors=True)
    print("\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
