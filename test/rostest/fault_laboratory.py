"""Where faults are tried: a master, a driver, its device that misbehaves, and who commands it."""

import contextlib
import dataclasses
import math
import mmap
import os
import pathlib
import struct
import subprocess
import sys
import threading
import time
from typing import Optional

import rospy
import yaml
from calibration_client import NAMESPACE, wait_for
from driver_node import OK, DriverNode
from faulty_device import FaultyAmplifier
from spherical_actuator_calibration.msg import CoilCurrents
from spherical_actuator_calibration.wall_stamp import wall_stamp

FOLDER = pathlib.Path(__file__).resolve().parent
CONFIG = FOLDER.parents[1] / "config"
COILS = 24
COIL = 3
CURRENT = 1.0  # [A]
RATE = 100.0  # [Hz] of commands
DIAGNOSTIC_PERIOD = 0.05  # [s]
PATIENCE = 30.0  # [s] for what takes a moment


def command(age=0.0, current=CURRENT, coils=COILS):
    """A command by the wall clock; `age` [s] may be negative."""
    message = CoilCurrents(current=[0.0] * coils)
    message.current[min(COIL, coils) - 1] = current
    message.header.stamp = wall_stamp() - rospy.Duration.from_sec(age)
    return message


@dataclasses.dataclass
class Outcome:
    """What a fault led to: how long there was current, and until it was told [s]; None: not measured."""

    registers: Optional[float] = None
    watchdog: Optional[float] = None
    told: Optional[float] = None
    defect: str = ""  # what is wrong whatever the times are


class Commander:
    """Publishes what `make` makes, again and again; nothing while it makes None."""

    def __init__(self):
        self._publisher = rospy.Publisher(
            f"{NAMESPACE}/coil_command", CoilCurrents, queue_size=1, tcp_nodelay=True
        )
        self.make = lambda: None
        self.pause = 1.0 / RATE
        self._lock = threading.Lock()
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self):
        while True:
            with self._lock:
                message = self.make()
                if message is not None:
                    self._publisher.publish(message)
            time.sleep(self.pause)

    def change(self, make=lambda: None):
        """Makes something else from now on. Returns when, by the monotonic clock: what was made before is sent."""
        with self._lock:
            self.make = make
            return time.monotonic()

    def close(self):
        self.change()
        self._publisher.unregister()


class ProcessFaults:
    """Faults within the driver's process, by a library that is preloaded: see process_faults.cpp."""

    FIELDS = struct.Struct("qq")

    def __init__(self, folder):
        self._library = folder / "process_faults.so"
        self._file = folder / "process_faults"
        if not self._library.exists():
            compiler = ["c++", "-std=c++17", "-shared", "-fPIC", "-o", self._library]
            subprocess.run([*compiler, FOLDER / "process_faults.cpp", "-ldl"], check=True)
        self._file.write_bytes(bytes(self.FIELDS.size))
        with self._file.open("r+b") as file:
            self._map = mmap.mmap(file.fileno(), self.FIELDS.size)
        self.environment = {"LD_PRELOAD": str(self._library), "FAULTS": str(self._file)}

    def jump(self, seconds):
        """Sets the wall clock of the process. Returns when."""
        self._map[:] = self.FIELDS.pack(seconds, 0)
        return time.monotonic()

    def throw(self):
        self._map[:] = self.FIELDS.pack(0, 1)
        return time.monotonic()


class Laboratory:
    """A coil driver with its shipped configuration, which is commanded, against an amplifier."""

    def __init__(self, folder, preload=False, longest=0.0):
        self._longest = longest  # limit [s] of what is measured
        self.amplifier = FaultyAmplifier()
        self.faults = ProcessFaults(folder) if preload else None
        parameters = yaml.safe_load((CONFIG / "coil_driver.yaml").read_text())
        parameters["link"]["port"] = self.amplifier.port
        parameters["diagnostic_period"] = DIAGNOSTIC_PERIOD
        self.driver = DriverNode("coil_driver", parameters, self.faults.environment if preload else None)
        threading.Thread(target=self._drain, daemon=True).start()
        self.commander = Commander()
        self.commander.change(command)
        wait_for(self.amplifier.is_on, "the commanded current")
        wait_for(lambda: self.driver.level("output") == OK, "a driver that is content")

    def _drain(self):
        """A pipe that nobody reads would stop the driver."""
        with contextlib.suppress(ValueError):
            for _line in self.driver.process.stderr:
                pass

    def close(self):
        self.commander.close()
        if self.driver.process.poll() is None:
            self.driver.process.kill()
        self.driver.process.wait()
        self.driver.close()
        self.amplifier.close()

    def watch(self, seconds):
        """Waits at least for so long, and until what is beyond its limit shows."""
        time.sleep(max(seconds, 1.2 * self._longest))

    def second_commander(self, current, rate):
        """Another one, as soon as the driver has refused it by its name."""
        process = subprocess.Popen([sys.executable, FOLDER / "commander.py", str(current), str(rate)])

        def is_refused():
            return "/second_commander" in self.driver.value("output", "last refusal")

        try:
            wait_for(is_refused, "a refusal of the second commander by its name", PATIENCE)
        except AssertionError:
            process.kill()
            raise
        return process

    def told(self, part, begin, patience):
        """How long after `begin` [s] the driver's output was an error with this text; infinite if it was not."""
        while time.monotonic() < begin + patience:
            status = self.driver.latest("output")
            if status is not None and part in status.message:
                return time.monotonic() - begin
            time.sleep(0.002)
        return math.inf


def outcome(laboratory, begin, **details):
    """How long there was current after `begin`."""
    return Outcome(*laboratory.amplifier.on_until(begin), **details)


def status_of(laboratory):
    """Exit status of the driver, once it has ended."""
    laboratory.driver.process.wait()
    return laboratory.driver.process.returncode


class Master:
    """A master of ROS of its own."""

    def __init__(self, port):
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
        self.process = subprocess.Popen(
            ["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        wait_for(self._answers, "the master")
        description = yaml.safe_load((CONFIG / "pm_spherical_8x24.yaml").read_text())
        rospy.set_param(f"{NAMESPACE}/actuator", description["actuator"])

    @staticmethod
    def _answers():
        with contextlib.suppress(OSError):
            rospy.get_master().getPid()
            return True
        return False

    def close(self):
        self.process.kill()
        self.process.wait()
