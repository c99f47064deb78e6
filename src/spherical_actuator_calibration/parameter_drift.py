"""How far parameters went from one calibration to the next, for what is known of them."""

import dataclasses
import math


@dataclasses.dataclass(frozen=True)
class Drift:
    """What changed of one parameter between two calibrations that share no sample."""

    name: str
    change: float  # in its unit; of an angle the shorter way round
    unit: str
    deviations: float  # the change by its standard deviation


def drifts_between(before, after):
    """Drift of each common parameter, those first that went furthest for what is known of them. `before`, `after`: of
    each name value, standard deviation and unit."""
    drifts = []
    for name in before.keys() & after.keys():
        (old, old_stddev, _), (new, new_stddev, unit) = before[name], after[name]
        change = math.remainder(new - old, math.tau) if unit == "rad" else new - old
        stddev = math.hypot(old_stddev, new_stddev)
        deviations = abs(change) / stddev if stddev > 0.0 else math.inf if change else 0.0
        drifts.append(Drift(name, change, unit, deviations))
    return sorted(drifts, key=lambda drift: (-drift.deviations, drift.name))
