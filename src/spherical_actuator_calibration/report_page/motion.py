"""What the page tells of a motion: its windows, their residual torques, and what else than coils moves the rotor."""

from ..shown_numbers import plus_minus, significant, with_unit
from . import figures

INERTIA = "rotor_inertia/"
# Where a parameter belongs, by the begin of its name.
TABLES = (
    ("Inertia", (INERTIA,)),
    ("Unbalance", ("rotor_unbalance/",)),
    ("Friction", ("viscous_friction", "coulomb_friction")),
    ("Delays", ("current_delay", "current_dispersion", "tracker_delay")),
)


def told_by(cycle, motion):
    """Of a cycle, and of what became of its recording."""
    return {
        "windows": _windows(motion),
        "noise": _noise(motion),
        "tables": [(title, rows) for title, begins in TABLES if (rows := _rows(cycle["estimates"], begins))],
        "picture": figures.residuals_over_time(_times(cycle, motion)) if cycle["residuals"] else None,
    }


def _windows(motion):
    rows = [
        ("Motion that served", f"{motion['duration']:.1f} s"),
        ("Windows that served", f"{motion['windows_used']} of {motion['windows']}"),
    ]
    rows += [(f"{one['count']} left out", one["reason"]) for one in motion["windows_left_out"]]
    orientations = f"{motion['orientations']} ({motion['orientations_rejected']} rejected)"
    rows.append(("Orientations of the tracker", orientations))
    rows.append(("Reduced χ² of the windows", significant(motion["window_chi_square"])))
    rows.append(("Reduced χ² of the orientations", significant(motion["orientation_chi_square"])))
    return rows


def _noise(motion):
    """As the streams tell it themselves."""
    joints = ", ".join(with_unit(stddev, "rad", 2) for stddev in motion["joint_stddev"])
    rows = [
        ("Joints", joints),
        ("Currents", f"{significant(1e3 * motion['current_stddev'], 2)} mA"),
        ("Tracker", with_unit(motion["orientation_stddev"], "rad", 2)),
    ]
    if "commands" in motion:
        told = {key: 1e3 * value for key, value in motion["commands"].items()}
        late = plus_minus(told["delay"] + told["time_constant"], told["stddev"])
        lag = significant(told["time_constant"], 2)
        rows.append(("Currents follow commands", f"{late} ms later in the mean, with a time constant of some {lag} ms"))
    return rows


def _rows(estimates, begins):
    rows = []
    for item in estimates:
        if not item["name"].startswith(begins):
            continue
        against = "–"
        if item["name"].startswith(INERTIA) and item["nominal"]:
            against = f"{100.0 * (item['value'] / item['nominal'] - 1.0):+.2f} %".replace("-", "−")
        rows.append(
            {
                "name": item["name"],
                "nominal": significant(item["nominal"]),
                "value": f"{plus_minus(item['value'], item['stddev'])} {item['unit']}",
                "against": against,
                "observable": item["observable"],
            }
        )
    return rows


def _times(cycle, motion):
    """Residuals with the middle of their windows, on a clock that stands still between stretches of motion [s]."""
    length = motion["duration"] / max(motion["windows_used"], 1)
    return [dict(item, time=length * (item["id"] - 0.5)) for item in cycle["residuals"]]
