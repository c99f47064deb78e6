"""Quaternions that tell an orientation."""

import math

UNIT_TOLERANCE = 1e-3  # of the norm, as in base/rotations.hpp


def normalised(values):
    """x, y, z, w at norm 1, and the norm that they had; None in their place where that is too far from 1, or no number."""
    norm = math.sqrt(sum(value * value for value in values))
    return [value / norm for value in values] if abs(norm - 1.0) <= UNIT_TOLERANCE else None, norm
