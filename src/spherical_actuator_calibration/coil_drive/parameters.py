"""Parameters of a description file as the message that the controller follows."""

import math

import rospy
import yaml
from geometry_msgs.msg import Vector3
from spherical_actuator_calibration.msg import ActuatorParameters, CoilAxis, OrientationMap, PoleAxis, TorqueCurve

PATIENCE = 10.0  # [s] for those who listen
UNKNOWN = math.inf  # standard deviation of what is not identified


def stddevs(item, *names):
    """Standard deviations of an entry of a description, infinite where it states none."""
    stated = item.get("stddev", {})
    return [stated.get(name, UNKNOWN) for name in names]


def fill_joint(joint, item):
    joint.axis = Vector3(*item["axis"])
    joint.offset = item["offset"]
    joint.offset_stddev, *joint.axis_stddev = stddevs(item, "offset", "axis_u", "axis_v")
    for name, size in (("linear", 3), ("harmonics", 4)):
        setattr(joint, name, item.get(name, [0.0] * size))
        setattr(joint, name + "_stddev", item.get("stddev", {}).get(name, [UNKNOWN] * size))


def axis_of(kind, item):
    """The message of a pole or a coil."""
    axis = kind(polar=item["polar"], azimuth=item["azimuth"], gain=item.get("gain", 1.0))
    axis.polar_stddev, axis.azimuth_stddev, axis.gain_stddev = stddevs(item, "polar", "azimuth", "gain")
    return axis


def curve_of(curve):
    """The message of a torque curve, whose table must be in the description itself."""
    table = curve.get("table", {})
    if not isinstance(table, dict) or "blend_start" not in curve or "support" not in curve:
        raise RuntimeError(
            "A torque curve is taken over with its table, blend_start and support in the description; else start the "
            "laboratory with this description as actuator:=."
        )
    return TorqueCurve(
        in_degrees=curve.get("angle_unit", "deg") == "deg",
        coefficients=curve.get("coefficients", []),
        table_angles=table.get("angles", []),
        table_torques=table.get("torques", []),
        blend_start=curve["blend_start"],
        support=curve["support"],
    )


def map_of(item):
    """The message of an orientation map."""
    return OrientationMap(
        length=item["length"],
        amplitude=item["amplitude"],
        noise=item["noise"],
        readings=[Vector3(*point["reading"]) for point in item["points"]],
        rotations=[Vector3(*point["rotation"]) for point in item["points"]],
    )


def parameters_of_file(path, stator):
    """The message of a calibrated description, with everything that was identified. Raises RuntimeError for a torque
    curve that it cannot tell."""
    with open(path, encoding="utf-8") as file:
        actuator = yaml.safe_load(file)["actuator"]
    message = ActuatorParameters(
        actuator=actuator["name"], serial=actuator.get("serial", ""), revision=1, source="identified"
    )
    message.header.frame_id = stator
    for joint, item in zip(message.joints, actuator["joints"]):
        fill_joint(joint, item)
    for item in actuator.get("poles", []):
        message.poles.append(axis_of(PoleAxis, item))
        message.poles[-1].polarity = item["polarity"]
    message.coils = [axis_of(CoilAxis, item) for item in actuator.get("coils", [])]
    if "torque_curve" in actuator:
        message.torque_curve = curve_of(actuator["torque_curve"])
    message.unbalance = Vector3(*actuator.get("rotor_unbalance", [0.0] * 3))
    if "orientation_map" in actuator:
        message.orientation_map = map_of(actuator["orientation_map"])
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
