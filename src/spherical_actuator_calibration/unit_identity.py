"""Whose unit something is: the rule of actuator/unit_identity.hpp."""


def other_unit(name, serial, own_name, own_serial):
    """Of what unit something is that states name and serial, and of what it is not: "actuator cube", "sphere". None where
    it may be one's own: names agree, and serials where both are known; empty is not known."""
    if name and name != own_name:
        return f"actuator {name}", own_name
    if serial and own_serial and serial != own_serial:
        return f"unit {serial}", own_serial
    return None
