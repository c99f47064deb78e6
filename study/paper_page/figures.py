"""The paper's figures, drawn from a study."""

import matplotlib

matplotlib.use("Agg")

# pylint: disable=wrong-import-position
from matplotlib import pyplot
from matplotlib.ticker import MaxNLocator

from .comparison import HIGH, LOW, MAXIMUM, MEDIAN, MINIMUM, noise_rows, printed_deviations

OURS = "#1d6fb8"
SECOND = "#c77700"
PAPER = "#a3241e"
SMALLEST = 1e-17  # that a logarithmic scale shows


def new(xlabel, ylabel):
    figure, axes = pyplot.subplots(figsize=(6.4, 4.0), constrained_layout=True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    if xlabel != "time [s]":
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    return figure, axes


def put_legend(axes):
    """Above the picture, where it covers nothing."""
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), frameon=False, ncol=3, fontsize="small")


def band(axes, x, spreads, label, color):
    """Median as a line, 5 % to 95 % dark, minimum to maximum light."""
    columns = [[max(SMALLEST, spread[n]) for spread in spreads] for n in range(5)]
    axes.plot(x, columns[MEDIAN], color=color, marker="o", markersize=3, label=label)
    axes.fill_between(x, columns[LOW], columns[HIGH], color=color, alpha=0.25, linewidth=0)
    axes.fill_between(x, columns[MINIMUM], columns[MAXIMUM], color=color, alpha=0.12, linewidth=0)


def convergence(spreads, ylabel, paper):
    figure, axes = new("iteration", ylabel)
    band(axes, range(len(spreads)), spreads, "median and spread over the seeds", OURS)
    for n, (x, y) in enumerate(paper):
        axes.plot(x, y, "x", color=PAPER, label="the paper" if n == 0 else None)
    axes.set_yscale("log")
    put_legend(axes)
    return figure


def figure_6(study, published):
    figure, axes = new("iteration", "largest error of an axis component")
    ours = study["level_1"]
    count = 6
    band(axes, range(count), ours["axis_deviation_chord"][:count], "chord method, as in Table 4", SECOND)
    band(axes, range(count), ours["axis_deviation_newton"][:count], "Gauss–Newton", OURS)
    printed = printed_deviations(published)
    # The table's last digit is 1e-6.
    axes.plot(range(1, len(printed) + 1), [max(p, 1e-6) for p in printed], "x", color=PAPER, label="Table 4, to its last digit")
    axes.set_yscale("log")
    put_legend(axes)
    return figure


def figure_7(study, published):
    return convergence(
        study["level_1"]["epsilon_1"], "ε₁ [rad]", [(0, published["figure_7"]["epsilon_1_initial"])]
    )


def figure_8(study, _published):
    rows = [row for row in study["level_1_noise"] if row["orientations"] > 3]
    x = [row["orientations"] for row in rows]
    figure, axes = new("orientations", "ε₁, noise, error [rad]")
    band(axes, x, [row["epsilon_1"] for row in rows], "ε₁ after calibration", OURS)
    axes.plot(x, [row["added_noise"][MEDIAN] for row in rows], color="black", linestyle="--", label="added noise")
    axes.plot(x, [row["true_error"][MEDIAN] for row in rows], color=SECOND, label="true error elsewhere")
    axes.set_ylim(bottom=0.0)
    put_legend(axes)
    return figure


def figure_10(study, published):
    printed = [(n, value**0.5) for n, value in enumerate(published["situation_1"]["epsilon_2_plotted"])]
    return convergence(study["situation_1"]["epsilon_2"], "ε₂ [N·m] (the paper's: root of what it plots)", printed)


def figure_12(study, published):
    printed = [(n, value**0.5) for n, value in enumerate(published["situation_2"]["epsilon_2_plotted"])]
    return convergence(study["situation_2"]["epsilon_2"], "ε₂ [N·m] (the paper's: root of what it plots)", printed)


def against_measurements(situation, key, ylabel, factor=1.0):
    figure, axes = new("measurements", ylabel)
    for orientations, color in (("random", SECOND), ("planned", OURS)):
        rows = noise_rows(situation, orientations)
        x = [row["measurements"] for row in rows]
        band(axes, x, [[factor * v for v in row[key]] for row in rows], f"{orientations} orientations", color)
    put_legend(axes)
    return figure


def figure_11(study, published):
    figure = against_measurements(study["situation_1"], "epsilon_2", "ε₂ [mN·m]", 1e3)
    figure.axes[0].axvline(
        published["situation_1"]["stable_from_measurements"], color=PAPER, linewidth=0.8, linestyle="--"
    )
    return figure


def figure_11_errors(study, published):
    figure = against_measurements(study["situation_1"], "largest_share", "largest error over the assigned one [%]", 100)
    share = published["situation_1"]["largest_error_share_with_noise"]
    figure.axes[0].axhline(100 * share, color=PAPER, linewidth=0.8, linestyle="--")
    figure.axes[0].set_yscale("log")
    return figure


def figure_13(study, _published):
    return against_measurements(study["situation_2"], "epsilon_2", "ε₂ [mN·m]", 1e3)


def figure_13_errors(study, _published):
    figure = against_measurements(study["situation_2"], "largest_error", "largest error of coil 2 [rad]")
    figure.axes[0].set_yscale("log")
    return figure


def figure_14(study, published):
    figure, axes = new("time [s]", "rotation error [rad]")
    colors = {"nominal": PAPER, "level_1": SECOND, "both_levels": OURS}
    for run in study["control"]:
        load = ", loaded" if run["loaded"] else ""
        axes.plot(
            run["time"],
            [max(SMALLEST, error) for error in run["rotation_error"]],
            color=colors[run["model"]],
            linestyle="--" if run["loaded"] else "-",
            label=run["model"].replace("_", " ") + load,
        )
    axes.axhline(published["figure_14"]["max_error_before"], color="black", linewidth=0.6)
    axes.set_yscale("log")
    put_legend(axes)
    return figure


FIGURES = {
    "figure_06": (figure_6, "Figure 6: identified axes by iteration, level 1 without noise"),
    "figure_07": (figure_7, "Figure 7: ε₁ by iteration, level 1 without noise"),
    "figure_08": (figure_8, "Figure 8: ε₁ against the number of orientations, noise ±1 mrad"),
    "figure_10": (figure_10, "Figure 10: ε₂ by iteration, situation 1 without noise"),
    "figure_11": (figure_11, "Figure 11: ε₂ against the measurements, situation 1; dashed: where the paper finds it stable"),
    "figure_11_errors": (figure_11_errors, "Errors behind Figure 11; dashed: the paper's 4.7 %"),
    "figure_12": (figure_12, "Figure 12: ε₂ by iteration, situation 2 without noise"),
    "figure_13": (figure_13, "Figure 13: ε₂ against the measurements, situation 2"),
    "figure_13_errors": (figure_13_errors, "Errors behind Figure 13"),
    "figure_14": (figure_14, "Figure 14: closed loop along q₁ = πt/48; the line is the paper's 0.06 rad"),
}


def draw(name, study, published):
    """The figure and its caption."""
    function, caption = FIGURES[name]
    with pyplot.rc_context({"svg.fonttype": "none", "svg.hashsalt": name}):
        return function(study, published), caption
