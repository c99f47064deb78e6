"""The emulated laboratory under test, with ports of its own, and what an operator does in it."""

import contextlib
import os
import pathlib
import signal
import tempfile
import unittest
import xmlrpc.client

import rosgraph
import rospy
import yaml
from calibration_client import DEADLINE, NAMESPACE, CalibrationClient, wait_for
from launch_client import Launch, launch_file
from links import free_port
from spherical_actuator_calibration.msg import CoilCurrents
from spherical_actuator_calibration.rotor_readings import readings_of
from spherical_actuator_calibration.session_guide.progress import distance
from spherical_actuator_calibration.wall_stamp import wall_stamp
from std_srvs.srv import SetBool, Trigger

WATCHDOG_RATE = 20.0  # [Hz] of repeated commands
RESPONSE_TIMEOUT = 10.0  # [s] of the joint sensor, on however busy a computer: the longest that there is
AMPLIFIER_TIMEOUT = 1.0  # [s] the coil driver allows no more
# [Hz] of the force/torque sensor, which is that of the emulation, and of the tracker, in a fixture: with less of this noise
# they tell as much as at the rates of the shipped configuration.
FIXTURE_RATES = {
    "ft_sensor": (200.0, ("force_noise", "torque_noise")),
    "tracker": (120.0, ("orientation_noise", "position_noise")),
}
# [Hz] of both drivers, whose noise is small beside that of what else is measured. All who listen take a third of the
# processor's time.
DRIVER_RATE = 100.0
NEAR_BY_JOINTS, NEAR_BY_TRACKER = 1e-3, 2.5e-3  # [rad] beyond noise and quantisation of readings
PATIENCE = 0.4  # [s] of the comparison of currents, the most that is allowed: threads of the emulator may have to wait


def configuration_with_free_ports(folder, driver_rate=None):
    """A copy of the shipped configuration whose devices listen at free ports, and may take their time."""
    shipped = pathlib.Path(rospy.get_param("~config"))
    copy = pathlib.Path(folder) / "config"
    copy.mkdir()
    for file in shipped.glob("*.yaml"):
        content = yaml.safe_load(file.read_text())
        if isinstance(content.get("link"), dict):
            content["link"].update(port=free_port(), response_timeout=RESPONSE_TIMEOUT)
            content["rate"] = content["rate"] if driver_rate is None else driver_rate
        if "deviation" in content:
            content["link"]["response_timeout"] = AMPLIFIER_TIMEOUT
            content["deviation"]["beats"] = int(PATIENCE * content["rate"])
        (copy / file.name).write_text(yaml.safe_dump(content))
    return str(copy)


class EmulatedLab:
    """emulated_lab.launch on the master of the test; `folder` keeps its files. Without `commands` it is
    somebody else who moves and excites. `unit`: name of a shipped description, with its URDF. A rotor that is to be
    `released` needs the emulation and the drivers at their full rates."""

    def __init__(self, folder, commands=True, environment=None, unit="pm_spherical_8x24", released=False, **arguments):
        self.folder = folder
        self.truth = os.path.join(folder, "truth.yaml")
        self.directory = os.path.join(folder, "calibration")
        self.config = configuration_with_free_ports(folder, None if released else DRIVER_RATE)
        if not released:
            self._slow_down()
        shipped = pathlib.Path(rospy.get_param("~config"))
        self.actuator = yaml.safe_load((shipped / f"{unit}.yaml").read_text())["actuator"]
        self.coils = len(self.actuator["coils"])
        self._arguments = {
            "actuator": str(shipped / f"{unit}.yaml"),
            "urdf": str(shipped.parent / "urdf" / f"{unit}.urdf"),
            "joint_sensor": bool(self.actuator["joints"]),
            "config": self.config,
            "directory": self.directory,
            "truth": self.truth,
            **arguments,
        }
        self._environment = environment
        self._launch = None
        self._currents = None
        self._timer = None
        self._command = CoilCurrents(current=[0.0] * self.coils)
        self._commands = rospy.Publisher(f"{NAMESPACE}/coil_command", CoilCurrents, queue_size=1)
        if commands:
            self._timer = rospy.Timer(rospy.Duration(1.0 / WATCHDOG_RATE), self._repeat)
        self._listen()
        fixture = f"{NAMESPACE}/{self.readings.fixture}"
        self.targets = rospy.Publisher(fixture, self.readings.target_type, queue_size=1)

    def _listen(self):
        self.readings = readings_of(NAMESPACE, self.actuator).listen()
        self._subscriber = rospy.Subscriber(f"{NAMESPACE}/coil_currents", CoilCurrents, self._keep_currents)

    @contextlib.contextmanager
    def left_alone(self):
        """Nobody listens meanwhile, which takes much of a small computer's time at 1 kHz."""
        self.readings.close()
        self._subscriber.unregister()
        self._currents = None
        yield
        self._listen()
        self._wait_for_readings()

    def change_emulator(self, **sections):
        """Sections of the emulator's configuration, before the start."""
        path = pathlib.Path(self.config) / "lab_emulator.yaml"
        path.write_text(yaml.safe_dump({**yaml.safe_load(path.read_text()), **sections}))

    def _slow_down(self):
        shipped = yaml.safe_load((pathlib.Path(self.config) / "lab_emulator.yaml").read_text())
        slower = {}
        for name, (rate, noises) in FIXTURE_RATES.items():
            sensor = shipped[name]
            share = (rate / sensor["rate"]) ** 0.5
            slower[name] = {**sensor, **{key: share * sensor[key] for key in noises}, "rate": rate}
        self.change_emulator(**slower)

    def use_coil_driver(self, name):
        """Another of the shipped configurations, before the start."""
        self._arguments["coil_driver"] = os.path.join(self.config, name)

    def start(self):
        self._launch = Launch(
            launch_file("emulated_lab.launch"), environment=self._environment, **self._arguments
        )
        self._wait_for_readings()
        wait_for(lambda: self.targets.get_num_connections() > 0, "the fixture")
        wait_for(lambda: self._commands.get_num_connections() > 0, "the coil driver")
        # Of its services the last to be advertised.
        rospy.wait_for_service(f"{NAMESPACE}/lab_emulator/inject_outlier", DEADLINE)

    def stop(self):
        if self._timer:
            self._timer.shutdown()
        if self._launch:
            self._launch.stop()

    @classmethod
    def kill(cls, node, number=signal.SIGKILL):
        """Sends a signal to a node; by SIGKILL it does not hear of it."""
        os.kill(cls.process_of(node), number)

    @staticmethod
    def process_of(node):
        """Its process id, which a node that is stopped does not tell."""
        name = f"{NAMESPACE}/{node}"
        address = rosgraph.Master(rospy.get_name()).lookupNode(name)
        _, _, process = xmlrpc.client.ServerProxy(address).getPid(rospy.get_name())
        return process

    def _wait_for_readings(self):
        wait_for(lambda: self.readings.fresh() is not None, self.readings.quantity)

    def _keep_currents(self, message):
        self._currents = message.current

    def is_without_current(self):
        return self._currents is not None and max(map(abs, self._currents)) < 0.02

    def _repeat(self, _event):
        self._command.header.stamp = wall_stamp()
        self._commands.publish(self._command)

    def excite(self, coil, current):
        """Only this coil, counted from 1."""
        self._command = CoilCurrents(current=[0.0] * self.coils)
        if coil:
            self._command.current[coil - 1] = current

    def is_at(self, target):
        """A reading [rad]; by noise and quantisation it is never at another one exactly."""
        reading = self.readings.fresh()
        return reading is not None and distance(reading, target) < (NEAR_BY_JOINTS if self.actuator["joints"] else NEAR_BY_TRACKER)

    def move(self, target):
        """Returns when the fixture is seen at the target."""
        self.targets.publish(self.readings.target(target))
        wait_for(lambda: self.is_at(target), f"the fixture at {target}")

    def fault(self, name, active):
        answer = rospy.ServiceProxy(f"{NAMESPACE}/lab_emulator/{name}", SetBool)(active)
        assert answer.success, answer.message

    def inject_outlier(self):
        answer = rospy.ServiceProxy(f"{NAMESPACE}/lab_emulator/inject_outlier", Trigger)()
        assert answer.success, answer.message


class LabCase(unittest.TestCase):
    """Tests in one laboratory, which ends with them; `folder` keeps its files."""

    @classmethod
    def make_lab(cls, **arguments):
        """Not yet started. `arguments`: of EmulatedLab."""
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.client = CalibrationClient()
        cls.lab = EmulatedLab(cls.folder.name, **arguments)
        cls.addClassCleanup(cls.lab.stop)

    @classmethod
    def start_lab(cls):
        """Until its calibration node answers."""
        cls.lab.start()
        rospy.wait_for_service(f"{NAMESPACE}/calibration/save")
