"""Pictures of a calibration: each an SVG in a data URI, with words for those who do not see it.

Every picture is narrow, so that its text can still be read on a telephone; the page puts two beside each other where
there is room.
"""

import math

import matplotlib.ticker
from matplotlib.patches import Rectangle

from ..shown_numbers import shown_in, significant, with_unit
from .picture import Figure

BLUE = "#1d6fb8"
TEAL = "#0f8a7e"
AMBER = "#c77700"
RED = "#c8322b"
GREY = "#8a97a5"
COLOURS = {"orientation": BLUE, "torque": TEAL}

# More points than this are drawn as pixels: as vectors they would fill the page's file.
MOST_VECTORS = 1500
# More numbers beside points would cover each other.
MOST_LABELS = 3
# 95 % of faultless standardised residuals (root mean square of three components) are below.
USUAL_STANDARDIZED = math.sqrt(7.814727903251179 / 3.0)


def _whole_numbers(axis):
    axis.set_major_locator(matplotlib.ticker.MaxNLocator(integer=True, nbins=8))


def _plain_logarithm(axes, values):
    """A logarithmic axis with 0.1, 1, 10 rather than powers, and with numbers between where it is short."""
    axes.set_yscale("log")
    positive = [value for value in values if value > 0.0]
    is_short = positive and max(positive) < 100.0 * min(positive)
    axes.yaxis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1.0, 2.0, 5.0) if is_short else (1.0,)))
    axes.yaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: significant(value, 2)))
    # Marks between them would take most of the time of a picture.
    axes.yaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    if is_short:
        axes.set_ylim(0.7 * min(positive), 1.4 * max(positive))


ERROR_TITLES = {"rad": "mean orientation error", "N·m": "torque error", "1": "standardised error"}


def convergence(kind, error_unit, cycles):
    """Error before the first and after each iteration, of all cycles of one kind (paper, Figures 7, 10, 12, 13).

    The cycles tell their errors in the same unit."""
    factor, unit = shown_in(error_unit)
    title = f"{cycles[0]['title_of_kind']}: {ERROR_TITLES[error_unit]}"
    with Figure(f"convergence_{kind}", title) as figure:
        axes = figure.axes
        for cycle in cycles:
            errors = [max(factor * error, 1e-12) for error in cycle["error_history"]]
            colour = BLUE if cycle["success"] else RED
            axes.plot(errors, marker="o", color=colour, alpha=0.9 if len(cycles) < 3 else 0.45)
        _plain_logarithm(axes, [max(factor * e, 1e-12) for cycle in cycles for e in cycle["error_history"]])
        axes.set_xlabel("iteration")
        axes.set_ylabel(f"error [{unit}]" if unit else "error [1]")
        _whole_numbers(axes.xaxis)
        before, after = (max(factor * cycle["error_history"][end] for cycle in cycles) for end in (0, -1))
        figure.alt = (
            f"{title} by iteration on a logarithmic scale, {len(cycles)} "
            f"{'cycle' if len(cycles) == 1 else 'cycles'}: from {significant(before)} to {significant(after)} {unit} "
            "at most."
        )
    return figure


def _from_zero(axes, values):
    axes.set_ylim(0.0, 1.12 * max(values, default=0.0) or 1.0)


def _logarithmic_if_wide(axes, values):
    ordered = sorted(value for value in values if value > 0.0)
    if ordered and ordered[-1] > 20.0 * ordered[len(ordered) // 2]:
        _plain_logarithm(axes, ordered)
    else:
        _from_zero(axes, ordered)


def _draw_residuals(axes, kind, residuals, key, factor, colour, influential):
    used = [item for item in residuals if not item["rejected"]]
    rejected = [item for item in residuals if item["rejected"]]
    marked = sorted(
        (item for item in used if item["id"] in influential), key=lambda item: influential.index(item["id"])
    )
    as_pixels = len(residuals) > MOST_VECTORS

    def points(items):
        return [item["id"] for item in items], [factor * item[key] for item in items]

    axes.plot(*points(used), ".", color=colour, rasterized=as_pixels, label="used")
    if rejected:
        axes.plot(*points(rejected), "x", color=RED, markeredgewidth=1.5, rasterized=as_pixels, label="rejected")
    if marked:
        axes.plot(*points(marked), "o", color="none", markeredgecolor=AMBER, markersize=9, label="most influential")
        for item in marked[:MOST_LABELS]:
            axes.annotate(
                str(item["id"]), (item["id"], factor * item[key]), (5, 4), textcoords="offset points", fontsize=7
            )
    _logarithmic_if_wide(axes, points(residuals)[1])
    axes.set_xlabel(kind)
    if rejected or marked:
        axes.legend(loc="best", ncol=3, handletextpad=0.2, columnspacing=1.0)


def residuals_of(quantity, kind, residuals, influential):
    """Residual norm of each sample, or window: its kind."""
    unit = residuals[0]["unit"]
    factor, name = shown_in(unit)
    with Figure(f"residuals_{quantity}", f"{quantity.capitalize()} residuals") as figure:
        _draw_residuals(figure.axes, kind, residuals, "residual", factor, COLOURS[quantity], influential)
        figure.axes.set_ylabel(f"residual [{name}]")
        largest = max((item["residual"] for item in residuals if not item["rejected"]), default=0.0)
        count = sum(item["rejected"] for item in residuals)
        figure.alt = (
            f"{quantity.capitalize()} residual of each of {len(residuals)} {kind}s: at most "
            f"{with_unit(largest, unit)} among those used, {count} rejected."
        )
    return figure


def residuals_over_time(residuals):
    """Mean residual torque of each window of a motion."""
    factor, name = shown_in("N·m")
    with Figure("motion_residuals", "Residual torque over the motion") as figure:
        axes = figure.axes
        for is_rejected, style, label in ((False, {"marker": ".", "color": TEAL}, "used"), (True, {"marker": "x", "color": RED}, "left out")):
            chosen = [item for item in residuals if item["rejected"] is is_rejected]
            if chosen:
                values = [factor * item["residual"] for item in chosen]
                axes.plot([item["time"] for item in chosen], values, linestyle="none", label=label, **style)
        _logarithmic_if_wide(axes, [factor * item["residual"] for item in residuals])
        axes.set_xlabel("time of the windows [s]")
        axes.set_ylabel(f"residual [{name}]")
        axes.legend(loc="best", ncol=2, handletextpad=0.2, columnspacing=1.0)
        largest = max((item["residual"] for item in residuals if not item["rejected"]), default=0.0)
        count = sum(item["rejected"] for item in residuals)
        figure.alt = (
            f"Mean residual torque of each of {len(residuals)} windows over time: at most "
            f"{with_unit(largest, 'N·m')} among those used, {count} left out."
        )
    return figure


def _usual_line(axes):
    axes.axhline(USUAL_STANDARDIZED, color=GREY, linewidth=1.0, linestyle="--")


def standardized_of(quantity, kind, residuals, influential):
    """Residuals over their stated uncertainty."""
    with Figure(f"standardized_{quantity}", f"{quantity.capitalize()}, standardised") as figure:
        _draw_residuals(figure.axes, kind, residuals, "standardized", 1.0, COLOURS[quantity], influential)
        _usual_line(figure.axes)
        figure.axes.set_ylabel("residual / uncertainty")
        used = [item["standardized"] for item in residuals if not item["rejected"]]
        share = sum(value < USUAL_STANDARDIZED for value in used) / max(len(used), 1)
        figure.alt = (
            f"Standardised {quantity} residual of each {kind}; {100 * share:.0f} % of those used lie below the dashed "
            f"line at {USUAL_STANDARDIZED:.2f}, where 95 % should."
        )
    return figure


def residuals_by_joint(quantity, residuals, positions, joints):
    """Residual norms over each joint angle: what depends on an angle is a fault of the model, not noise."""
    factor, unit = shown_in(residuals[0]["unit"])
    chosen = [item for item in residuals if not item["rejected"] and item["id"] in positions]
    values = [factor * item["residual"] for item in chosen]
    as_pixels = len(chosen) > MOST_VECTORS
    title = f"{quantity.capitalize()} residuals by joint angle"
    with Figure(f"by_joint_{quantity}", title, rows=len(joints), size=(4.7, 5.4), sharex=False) as figure:
        for place, (axes, joint) in enumerate(zip(figure.panels, joints)):
            angles = [positions[item["id"]][place] for item in chosen]
            axes.plot(angles, values, ".", color=COLOURS[quantity], rasterized=as_pixels)
            _from_zero(axes, values)
            axes.set_xlabel(f"{joint['name']} [rad]")
            axes.set_ylabel(f"[{unit}]")
        figure.alt = (
            f"{quantity.capitalize()} residual of {len(chosen)} samples over the angle of "
            f"{', '.join(joint['name'] for joint in joints)}, at most {significant(max(values, default=0.0))} {unit}."
        )
    return figure


def held_out(validation):
    """Standardised residuals of what no estimate has seen."""
    residuals, what = validation["residuals"], validation.get("of", "samples")
    with Figure("held_out", f"Held-out {what}, standardised") as figure:
        axes = figure.axes
        for quantity, marker in (("orientation", "o"), ("torque", "s")):
            chosen = [item for item in residuals if item["quantity"] == quantity]
            if chosen:
                axes.plot(
                    [item["id"] for item in chosen],
                    [item["standardized"] for item in chosen],
                    marker,
                    color=COLOURS[quantity],
                    label=quantity,
                    rasterized=len(chosen) > MOST_VECTORS,
                )
        _usual_line(axes)
        _logarithmic_if_wide(axes, [item["standardized"] for item in residuals])
        _whole_numbers(axes.xaxis)
        axes.set_xlabel(what.rstrip("s"))
        axes.set_ylabel("residual / uncertainty")
        axes.legend(loc="best", ncol=2)
        largest = max(item["standardized"] for item in residuals)
        figure.alt = (
            f"Standardised residuals of {len(residuals)} held-out measurements, the largest {significant(largest)}; "
            f"95 % should lie below the dashed line at {USUAL_STANDARDIZED:.2f}."
        )
    return figure


def position_of(sample):
    """Joint angles [rad], or the turns that stand for the orientation of a rotor without joints."""
    return sample["joint_position"] if "joint_position" in sample else sample["turns"]


def poses(samples, joints, tilt_limit):
    """Where the rotor was."""
    with Figure("poses", "Poses of the samples", size=(4.7, 3.6)) as figure:
        axes = figure.axes
        limit = tilt_limit
        axes.add_patch(Rectangle((-limit, -limit), 2 * limit, 2 * limit, fill=False, edgecolor=GREY, linestyle="--"))
        points = None
        for held, marker, label in ((False, "o", "in use"), (True, "s", "held out")):
            chosen = [position_of(sample) for sample in samples if sample["validation"] == held]
            if chosen:
                points = axes.scatter(
                    [q[0] for q in chosen],
                    [q[1] for q in chosen],
                    c=[math.remainder(q[2], 2.0 * math.pi) for q in chosen],
                    cmap="twilight_shifted",
                    vmin=-math.pi,
                    vmax=math.pi,
                    s=26 if held else 16,
                    marker=marker,
                    edgecolors=AMBER if held else GREY,
                    linewidths=1.0 if held else 0.4,
                    label=label,
                    rasterized=len(chosen) > MOST_VECTORS,
                )
        if points is not None:
            bar = figure.bar(points, f"{joints[2]['name']} [rad]", ticks=[-math.pi, 0.0, math.pi])
            bar.set_yticklabels(["−π", "0", "π"])
            axes.legend(loc="upper left", ncol=2, handletextpad=0.2)
        axes.set_aspect("equal")
        reach = 1.15 * max([limit] + [abs(angle) for sample in samples for angle in position_of(sample)[:2]])
        axes.set_xlim(-reach, reach)
        axes.set_ylim(-reach, 1.15 * reach)
        axes.set_xlabel(f"{joints[0]['name']} [rad]")
        axes.set_ylabel(f"{joints[1]['name']} [rad]")
        motion = ", ".join(
            f"{joint['name']} from {joint['lowest']:.2f} to {joint['highest']:.2f} rad" for joint in joints
        )
        figure.alt = f"Poses of {len(samples)} samples within the workspace (dashed): {motion}."
    return figure


def coverage(kind, counts, stddevs):
    """How often each pole or coil was seen, and what that told. `stddevs`: [rad], None where not identified."""
    numbers = list(range(1, len(counts) + 1))
    with Figure(f"coverage_{kind}", f"{kind.capitalize()}s: samples and uncertainty", rows=2) as figure:
        above, below = figure.panels
        above.bar(numbers, counts, color=[BLUE if stddev is not None else GREY for stddev in stddevs], width=0.7)
        above.set_ylabel("samples")
        _whole_numbers(above.yaxis)
        known = [(number, 1e3 * stddev) for number, stddev in zip(numbers, stddevs) if stddev is not None]
        if known:
            below.plot(*zip(*known), "o", color=TEAL)
            _from_zero(below, [value for _, value in known])
        for number, stddev in zip(numbers, stddevs):
            if stddev is None:
                below.axvspan(number - 0.4, number + 0.4, color="#f3d9d7", linewidth=0)
        below.set_ylabel("± [mrad]")
        below.set_xlabel(kind)
        below.set_xlim(0.3, len(counts) + 0.7)
        below.xaxis.set_major_locator(matplotlib.ticker.MaxNLocator(integer=True, nbins=12))
        unknown = len(counts) - len(known)
        figure.alt = (
            f"Number of torque samples that see each {kind}, from {min(counts)} to {max(counts)}, and standard "
            f"deviation of its worse angle"
            + (f", at most {significant(max(value for _, value in known))} mrad" if known else "")
            + (f"; {unknown} not identified (shaded)." if unknown else ".")
        )
    return figure


def workspace_map(quantity, tilt, values, joints):
    """Expected error over the tilt, average over the spin. Rows of `values` are positions of joint 1."""
    factor, unit = (1e3, "mrad") if quantity == "orientation" else (1e3, "mN·m/A")
    shown = [[factor * value for value in column] for column in zip(*values)]
    flat = [value for row in shown for value in row]
    with Figure(f"workspace_{quantity}", f"Expected {quantity} error", size=(4.7, 3.7)) as figure:
        axes = figure.axes
        axes.grid(False)
        has_relief = max(flat) > 1.02 * min(flat)
        # What is the same everywhere shall look so.
        span = {} if has_relief else {"vmin": 0.9 * min(flat), "vmax": 1.1 * max(flat)}
        image = axes.pcolormesh(tilt, tilt, shown, shading="gouraud", cmap="viridis_r", rasterized=True, **span)
        if has_relief:
            lines = axes.contour(tilt, tilt, shown, levels=5, colors="white", linewidths=0.8)
            axes.clabel(lines, fontsize=7, fmt=lambda value: significant(value, 3))
        axes.set_aspect("equal")
        axes.set_xlabel(f"{joints[0]['name']} [rad]")
        axes.set_ylabel(f"{joints[1]['name']} [rad]")
        figure.bar(image, f"1 σ [{unit}]")
        figure.alt = (
            f"Expected {quantity} error over the tilt of the rotor, averaged over its spin: from "
            f"{significant(min(flat))} to {significant(max(flat))} {unit}."
        )
    return figure


def changes(parameters):
    """What calibration changed in parameters in rad, with 95 % intervals."""
    with Figure("changes", "Identified minus nominal") as figure:
        axes = figure.axes
        identified = [item for item in parameters if item["identified"]]
        kinds = {"joint": BLUE, "pole": AMBER, "coil": TEAL}
        for kind, colour in kinds.items():
            chosen = [
                (place, 1e3 * (item["value"] - item["nominal"]), 1.96e3 * item["stddev"])
                for place, item in enumerate(identified, 1)
                if item["kind"] == kind
            ]
            if chosen:
                place, change, interval = zip(*chosen)
                axes.errorbar(place, change, interval, fmt=".", color=colour, elinewidth=1.0, label=f"{kind}s")
        axes.axhline(0.0, color=GREY, linewidth=1.0)
        _whole_numbers(axes.xaxis)
        axes.set_xlabel("parameter, in the order of the table")
        axes.set_ylabel("change [mrad]")
        axes.legend(loc="best", ncol=3, handletextpad=0.2, columnspacing=1.0)
        largest = max(abs(item["value"] - item["nominal"]) for item in identified)
        figure.alt = (
            f"Difference between identified and nominal value of {len(identified)} parameters with 95 % intervals: at "
            f"most {with_unit(largest, 'rad')}."
        )
    return figure
