"""Where the programs of this package are."""

PACKAGE = "spherical_actuator_calibration"


def program(name):
    """Path of a program. Raises FileNotFoundError where ROS does not know it."""
    # Who names programs by themselves needs no ROS.
    from roslib.packages import find_node  # pylint: disable=import-outside-toplevel

    paths = find_node(PACKAGE, name)
    if not paths:
        raise FileNotFoundError(f"{PACKAGE} has no program {name}: build it, and source its setup.bash")
    return paths[0]
