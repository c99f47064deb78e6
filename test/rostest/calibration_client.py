"""What the tests of the calibration node share: the node's program, and a client of its interface."""

import glob
import os
import signal
import subprocess
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from roslib.packages import find_node
from spherical_actuator_calibration.msg import (
    ActuatorParameters,
    CalibrationReport,
    CalibrationSample,
    CalibrationStatus,
    PlanProgress,
)
from spherical_actuator_calibration.srv import (
    BeginMotion,
    Calibrate,
    Capture,
    CheckCoils,
    DrawValidationPoses,
    ListSamples,
    LoadPlan,
    MissingPatterns,
    PlanPoses,
    RemoveSample,
    Restore,
)
from std_srvs.srv import SetBool, Trigger

PACKAGE = "spherical_actuator_calibration"
NAMESPACE = "/actuator"
NODE = NAMESPACE + "/calibration"
DEADLINE = 180.0  # [s] for what takes a moment; only a failing test waits so long

MOST_WAITING = 0.5  # share of its processor time that a node may wait for it
SILENCE = 30.0  # [s] without anything new, after which what is missing is lost

SERVICES = {
    "begin_motion": BeginMotion,
    "calibrate_coil": Calibrate,
    "calibrate_joint": Calibrate,
    "calibrate_motion": Calibrate,
    "calibrate_poles": Calibrate,
    "capture": Capture,
    "clear_samples": Trigger,
    "draw_validation_poses": DrawValidationPoses,
    "forget_motion": Trigger,
    "check_coils": CheckCoils,
    "list_samples": ListSamples,
    "load_plan": LoadPlan,
    "missing_patterns": MissingPatterns,
    "plan_poses": PlanPoses,
    "refine": Calibrate,
    "remove_sample": RemoveSample,
    "reset": Trigger,
    "restore": Restore,
    "save": Trigger,
    "set_auto_capture": SetBool,
    "validate": Calibrate,
}
STREAMS = ("joint_states", "measured_orientation", "measured_torque", "coil_currents")
LATCHED = {
    "parameters": ActuatorParameters,
    "report": CalibrationReport,
    "status": CalibrationStatus,
    "plan_progress": PlanProgress,
}


def wait_for(condition, what, deadline=DEADLINE):
    """Polls until the condition gives something true, and returns that."""
    end = time.monotonic() + deadline
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"not within {deadline} s: {what}")
        time.sleep(0.005)


def program(name, package=PACKAGE):
    """Path of an executable of a package."""
    paths = find_node(package, name)
    if not paths:
        raise AssertionError(f"{package} has no program {name}")
    return paths[0]


def run_tool(name, bags=(), **options):
    """Runs a tool of the package to its end."""
    command = [program(name)]
    for option, value in options.items():
        command += [f"--{option}", str(value)]
    subprocess.run(command + list(bags), check=True, stdout=subprocess.DEVNULL)


def play(bag, *options):
    """Plays the streams of a recording as soon as the node listens; returns the process.

    It stays until stop_player(): a player that ends by itself takes its last messages with it where the computer is
    too busy to send them at once."""
    command = ["rosbag", "play", bag, "--quiet", "--queue", "100000", "--wait-for-subscribers"]
    # A player that is kept alive does not begin again.
    command += [] if "--loop" in options else ["--keep-alive"]
    topics = [f"{NAMESPACE}/{stream}" for stream in STREAMS]
    return subprocess.Popen(
        command + list(options) + ["--topics"] + topics,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )


def stop_player(player):
    player.terminate()
    player.wait()


class CalibrationNode:
    """The node's program on one calibration directory, started and ended by the test."""

    def __init__(self, directory, environment=None, **private_parameters):
        self.directory = directory
        self._arguments = [f"_directory:={directory}"]
        self._arguments += [f"_{key}:={value}" for key, value in private_parameters.items()]
        self._environment = {**os.environ, "ROS_NAMESPACE": NAMESPACE, **(environment or {})}
        self.process = None

    def start(self):
        # SIGXFSZ stays ignored, as in this process: a limit of the file size then acts as a full disk.
        self.process = subprocess.Popen(
            [program("calibration"), "__name:=calibration"] + self._arguments,
            env=self._environment,
            stderr=subprocess.PIPE,
            text=True,
            restore_signals=False,
        )
        self._stderr = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        return self

    def _read(self):
        for line in self.process.stderr:
            self._stderr.append(line)

    def stderr(self):
        """What an ended node wrote to its standard error."""
        self._reader.join()
        return "".join(self._stderr)

    def alive(self):
        return self.process is not None and self.process.poll() is None

    def kill(self):
        """As a power failure would: nothing is flushed or closed."""
        self.process.kill()
        self.process.wait()

    def stall(self, duration):
        """The process gets no processor time for a while, as on a busy computer."""
        self.process.send_signal(signal.SIGSTOP)
        time.sleep(duration)
        self.process.send_signal(signal.SIGCONT)

    def stop(self):
        """Asks the node to end, and returns its exit status."""
        if self.alive():
            self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=DEADLINE)

    def cpu_seconds(self):
        """Processor time that the node has used."""
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def was_starved(self):
        """Whether it had to wait for the processors, which others had, as on no computer of its own."""
        return self.waiting_seconds() > MOST_WAITING * self.cpu_seconds()

    def waiting_seconds(self):
        """For how long its threads were ready to run, and others had the processors."""
        waited = 0
        for path in glob.glob(f"/proc/{self.process.pid}/task/*/schedstat"):
            with open(path, encoding="ascii") as file:
                waited += int(file.read().split()[1])
        return 1e-9 * waited


class CalibrationClient:
    """Calls the services of the node, and keeps the last message of each of its topics."""

    def __init__(self):
        self.samples = []
        self._latest = {}
        self._diagnostics = {}
        self._subscribers = [
            rospy.Subscriber(f"{NAMESPACE}/{topic}", message, self._keep, topic)
            for topic, message in LATCHED.items()
        ]
        self._subscribers += [
            rospy.Subscriber(f"{NAMESPACE}/samples", CalibrationSample, self.samples.append),
            rospy.Subscriber("/diagnostics", DiagnosticArray, self._keep_diagnostics),
        ]

    def _keep(self, message, topic):
        self._latest[topic] = message

    def _keep_diagnostics(self, message):
        for status in message.status:
            self._diagnostics[status.name] = status

    def forget(self):
        """What comes from now on is of a node that is started after this; those before have ended."""
        # What an ended node sent may still wait to be received, and would be taken for the next one's.
        wait_for(self._has_received_all, "the end of all connections")
        self._latest.clear()
        self._diagnostics.clear()
        del self.samples[:]

    def _has_received_all(self):
        # A connection that was cut while it was made stays among them, done.
        return all(link.done for subscriber in self._subscribers for link in subscriber.impl.connections)

    def latest(self, topic):
        return self._latest.get(topic)

    def diagnostic(self, task):
        """Values of the node's diagnostic task, by key; empty before the first."""
        status = self._diagnostics.get(f"{NODE[1:]}: {task}")
        return {value.key: value.value for value in status.values} if status else {}

    def received(self, stream):
        """Messages of a stream that the node has accepted, and refused."""
        values = self.diagnostic(stream)
        return int(values.get("accepted", 0)), int(values.get("refused", 0))

    def call(self, service, **fields):
        proxy = rospy.ServiceProxy(f"{NODE}/{service}", SERVICES[service])
        return proxy(**fields)

    def wait_until_up(self, node):
        """Until a node that was just started has published everything and answers."""

        def is_up():
            if not node.alive():
                raise AssertionError("the node ended: " + node.stderr())
            return self.latest("status") and self.latest("parameters")

        wait_for(is_up, "status and parameters of the node")
        # Of all services the last to be advertised.
        rospy.wait_for_service(f"{NODE}/save", DEADLINE)

    def start(self, node):
        self.forget()
        node.start()
        self.wait_until_up(node)

    def held(self):
        """Samples in use by id."""
        return {sample.id: sample for sample in self.call("list_samples").samples}

    def revision(self):
        return self.latest("parameters").revision


class Reception:
    """What comes of a recording to the node; `counts`: its messages by stream."""

    def __init__(self, client, counts):
        self._client = client
        self._counts = counts
        self._last = (0, time.monotonic())

    def is_going_on(self):
        """Whether messages are still to come: not all were received, and some were a moment ago."""
        received = sum(sum(self._client.received(stream)) for stream in self._counts)
        now = time.monotonic()
        if received != self._last[0]:
            self._last = (received, now)
        return received < sum(self._counts.values()) and now - self._last[1] < SILENCE


def values_of(parameters):
    """All numbers of an ActuatorParameters message, in a fixed order."""
    numbers = []
    for joint in parameters.joints:
        numbers += [joint.axis.x, joint.axis.y, joint.axis.z, joint.offset]
    for pole in parameters.poles:
        numbers += [pole.polar, pole.azimuth, float(pole.polarity), pole.gain]
    for coil in parameters.coils:
        numbers += [coil.polar, coil.azimuth, coil.gain]
    return numbers
