"""What the tests of the orientation controller share: the node, what it is told, and what it commands."""

import math
import pathlib

import rospy
import yaml
from calibration_client import NAMESPACE, wait_for
from driver_node import DriverNode
from geometry_msgs.msg import QuaternionStamped
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import ActuatorParameters, CoilAxis, CoilCurrents, PoleAxis
from std_srvs.srv import SetBool

LIMIT = 2.5  # [A] of one coil


def description():
    path = pathlib.Path(rospy.get_param("~config")) / "pm_spherical_8x24.yaml"
    return yaml.safe_load(path.read_text())["actuator"]


def parameters_of(actuator):
    """The message of a description."""
    message = ActuatorParameters(actuator=actuator["name"], source="identified", revision=1, has_joints=True)
    for joint, item in zip(message.joints, actuator["joints"]):
        joint.axis.x, joint.axis.y, joint.axis.z = item["axis"]
        joint.offset = item["offset"]
    for pole in actuator["poles"]:
        axis = PoleAxis(polar=pole["polar"], azimuth=pole["azimuth"], polarity=pole["polarity"], gain=1.0)
        message.poles.append(axis)
    for coil in actuator["coils"]:
        message.coils.append(CoilAxis(polar=coil["polar"], azimuth=coil["azimuth"], gain=1.0))
    return message


def target(x, y, z, frame="stator"):
    message = QuaternionStamped()
    message.header.frame_id = frame
    quaternion = message.quaternion
    quaternion.x, quaternion.y, quaternion.z = x, y, z
    quaternion.w = math.sqrt(1.0 - x * x - y * y - z * z)
    return message


class Commands:
    """The commands of the controller."""

    def __init__(self):
        self.last = 0.0
        self.count = 0
        self.largest = 0.0
        self._subscriber = rospy.Subscriber(
            f"{NAMESPACE}/coil_command", CoilCurrents, self._keep, queue_size=1000
        )

    def close(self):
        """What still comes is of no controller that the next commands are of."""
        self._subscriber.unregister()

    def _keep(self, message):
        self.last = max(map(abs, message.current))
        self.largest = max(self.largest, self.last)
        self.count += 1

    def ended_with_zero(self):
        """Whether nothing comes any more, after a zero."""
        count = self.count
        rospy.sleep(0.2)
        return self.count == count > 0 and self.last == 0.0


class Controller(DriverNode):
    def __init__(self, actuator=None, **parameters):
        """`actuator`: its description, as a map; None: the shipped one with joints."""
        rospy.set_param(f"{NAMESPACE}/actuator", actuator or description())
        super().__init__("orientation_controller", {"diagnostic_period": 0.05, **parameters})
        self.targets = rospy.Publisher(f"{NAMESPACE}/orientation_target", QuaternionStamped, queue_size=10)
        self.joint_targets = rospy.Publisher(f"{NAMESPACE}/joint_target", JointState, queue_size=10)

    def enable(self, value=True):
        name = self.name + "/enable"
        rospy.wait_for_service(name)
        return rospy.ServiceProxy(name, SetBool)(value)

    def wait_until_enabled(self):
        wait_for(lambda: self.enable().success, "the controller to take hold")

    def send(self, message):
        wait_for(lambda: self.targets.get_num_connections() > 0, "the controller to listen")
        self.targets.publish(message)

    def send_joints(self, **joints):
        """A target by names and angles [rad]."""
        wait_for(lambda: self.joint_targets.get_num_connections() > 0, "the controller to listen")
        self.joint_targets.publish(JointState(name=list(joints), position=list(joints.values())))
