"""Parameters of a description file as the message that the controller follows."""

import rospy
import yaml
from spherical_actuator_calibration.msg import ActuatorParameters, CoilAxis, PoleAxis

PATIENCE = 10.0  # [s] for those who listen


def parameters_of_file(path, stator):
    """The message of a calibrated description."""
    with open(path, encoding="utf-8") as file:
        actuator = yaml.safe_load(file)["actuator"]
    message = ActuatorParameters(
        actuator=actuator["name"], serial=actuator.get("serial", ""), revision=1, source="identified"
    )
    message.header.frame_id = stator
    for joint, item in zip(message.joints, actuator["joints"]):
        joint.axis.x, joint.axis.y, joint.axis.z = item["axis"]
        joint.offset = item["offset"]
    for item in actuator["poles"]:
        axis = PoleAxis(polar=item["polar"], azimuth=item["azimuth"], polarity=item["polarity"])
        axis.gain = item.get("gain", 1.0)
        message.poles.append(axis)
    for item in actuator["coils"]:
        message.coils.append(CoilAxis(polar=item["polar"], azimuth=item["azimuth"], gain=item.get("gain", 1.0)))
    return message


def publish(ns, path):
    """Makes the parameters of a file those in force, in the place of the calibration node, until the program ends.
    Returns what publishes them, which must be kept."""
    stator = rospy.get_param(f"{ns}/orientation_controller/frames/stator", "stator")
    publisher = rospy.Publisher(f"{ns}/parameters", ActuatorParameters, queue_size=1, latch=True)
    end = rospy.get_time() + PATIENCE
    while publisher.get_num_connections() == 0 and rospy.get_time() < end:
        rospy.sleep(0.05)
    publisher.publish(parameters_of_file(path, stator))
    return publisher
