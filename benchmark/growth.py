"""How the time of a refinement grows: exponents by a fit, and their picture."""

import math

import matplotlib

matplotlib.use("Agg")

# pylint: disable=wrong-import-position
from matplotlib import pyplot

COLOR = "#2b6cb0"
FIT_COLOR = "#b0b7c3"


def series(times, name):
    """Sizes and times [s] of all benchmarks "name/SIZE", ascending."""
    found = {}
    for run, seconds in times.items():
        begin, _, size = run.rpartition("/")
        if begin == name and size.isdigit():
            found[int(size)] = seconds
    return sorted(found.items())


def fitted(points):
    """Exponent and factor of the power of the size that is next to the times, by least squares of logarithms."""
    if len({size for size, _ in points}) < 2:
        raise ValueError("a power of the size is fitted to two sizes at least")
    logs = [(math.log(size), math.log(seconds)) for size, seconds in points]
    mean_size = sum(x for x, _ in logs) / len(logs)
    mean_time = sum(y for _, y in logs) / len(logs)
    exponent = sum((x - mean_size) * (y - mean_time) for x, y in logs) / sum((x - mean_size) ** 2 for x, _ in logs)
    return exponent, math.exp(mean_time - exponent * mean_size)


def draw_curve(axes, points, what):
    sizes = [size for size, _ in points]
    exponent, factor = fitted(points)
    axes.loglog(sizes, [1e3 * factor * size**exponent for size in sizes], "--", color=FIT_COLOR,
                label=f"exponent {exponent:.2f}")
    axes.loglog(sizes, [1e3 * seconds for _, seconds in points], "o-", color=COLOR, label="measured")
    axes.set_xlabel(what)
    axes.set_ylabel("processor time [ms]")
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend()


def draw(curves, path):
    """One picture for each curve, side by side. `curves`: points and what the size counts."""
    figure, all_axes = pyplot.subplots(1, len(curves), figsize=(4.5 * len(curves), 3.6), squeeze=False)
    for axes, (points, what) in zip(all_axes[0], curves):
        draw_curve(axes, points, what)
    figure.tight_layout()
    # Without date and random names, so that the same numbers give the same file.
    with pyplot.rc_context({"svg.hashsalt": "growth"}):
        figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)
