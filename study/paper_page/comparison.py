"""What the study found beside what the paper prints, as rows of text. Every judgement is computed from the numbers."""

import dataclasses

MINIMUM, LOW, MEDIAN, HIGH, MAXIMUM = range(5)  # of a spread
PRINTED_DIGIT = 1e-6  # the last one of the axes in Table 4
FIGURE_DIGIT = 0.01  # [rad] of the errors that Figure 14 tells
MEASUREMENTS = 30  # of situation 1 in the paper


@dataclasses.dataclass(frozen=True)
class Row:
    what: str
    paper: str
    ours: str
    verdict: str


def position(values, value):
    """Share of values below one, as text."""
    below = sum(v < value for v in values)
    return f"the paper's is larger than {below} of {len(values)}"


def spread_text(spread, unit="", factor=1.0):
    return (
        f"{factor * spread[MEDIAN]:.3g} ({factor * spread[MINIMUM]:.3g} to {factor * spread[MAXIMUM]:.3g})"
        f"{' ' + unit if unit else ''}"
    )


def printed_deviations(published):
    """Largest deviation of the axes of Table 4 from the assigned ones, by iteration [1]."""
    preset = [error["delta_omega"] for error in published["table_3_preset_errors"]]
    return [
        max(abs(a - b) for axis, wanted in zip(axes, preset) for a, b in zip(axis, wanted))
        for _, axes in sorted(published["table_4_identified_axes"].items())
    ]


def iterations_verdict(counts, printed):
    """Whether half of the sets or more take as many iterations as the paper prints: 8, or "4 to 5"."""
    bounds = [int(word) for word in str(printed).split() if word.isdigit()]
    sets = sum(counts.values())
    fewer = sum(count for n, count in counts.items() if int(n) < bounds[0])
    more = sum(count for n, count in counts.items() if int(n) > bounds[-1])
    if sets == 0:
        return "not shown"
    if 2 * (fewer + more) <= sets:
        return f"agrees in {sets - fewer - more} of {sets}"
    return f"fewer in {fewer} of {sets}" if fewer >= more else f"more in {more} of {sets}"


def method_of(printed, chord, newton):
    """Which methods' spreads hold a printed value, to half of its last digit: what is printed as 0.000001 is no zero."""

    def holds(spread):
        return spread[MINIMUM] - PRINTED_DIGIT / 2 <= printed <= spread[MAXIMUM] + PRINTED_DIGIT / 2

    if holds(chord) and holds(newton):
        return "inside both spreads: tells neither method"
    if holds(chord):
        return "inside the chord method's spread, outside Newton's"
    return "inside Newton's spread, outside the chord method's" if holds(newton) else "outside both spreads"


def agrees_as_printed(printed, ours):
    """Whether a value is the paper's, to half of the last digit of Figure 14."""
    return "agrees to its last digit" if abs(ours - printed) <= FIGURE_DIGIT / 2 else "differs"


def plotted_as(roots, printed):
    """Whether a plotted error is a mean square or its root, by where our values lie."""
    squares = [root * root for root in roots]
    if min(squares) <= printed <= max(squares):
        return "a mean square, without the root"
    return "a root mean square" if min(roots) <= printed <= max(roots) else "neither a mean square of ours nor a root"


def inside(values, value):
    return "inside the spread" if min(values) <= value <= max(values) else "outside the spread"


def left_open(observable, sets):
    """Of sets of which so many show everything."""
    return f"{sets - observable} of {sets} leave some open" if observable < sets else "all do"


def noise_rows(situation, orientations):
    return [row for row in situation["noise"] if row["orientations"] == orientations and "epsilon_2" in row]


def row_at(rows, key, value):
    return next(row for row in rows if row[key] == value)


def table_4(study, published):
    """Axes by iteration, of the first seed: the paper's orientations are not known."""

    def text(axes):
        return "; ".join(" ".join(f"{value:.6f}" for value in axis) for axis in axes)

    return [
        Row(f"Table 4: Δω₁; Δω₂; Δω₃ after iteration {n}", text(axes), text(study["table_4"][n]), "seed 1")
        for n, axes in sorted(published["table_4_identified_axes"].items())
    ]


def table_5(study, published):
    poles, coil = published["table_5_poles"], published["table_5_coil_1"]
    actual = {f"pole_{i}/polar": value for i, value in enumerate(poles["actual_theta"], 1)}
    actual.update({f"pole_{i}/azimuth": value for i, value in enumerate(poles["actual_phi"], 1)})
    actual.update(zip(("coil_1/polar", "coil_1/azimuth"), coil["actual"]))
    return [
        Row(
            f"Table 5: {row['name']}, nominal {row['nominal']:.4f} [rad]",
            f"{actual[row['name']]:.4f}",
            f"{row['without_noise']:.4f} without noise; {row['with_noise']:.4f} ± {row['stddev']:.4f} with",
            "seed 1, planned set",
        )
        for row in study["table_5"]
    ]


def level_1(study, published):
    ours = study["level_1"]
    initial = published["figure_7"]["epsilon_1_initial"]
    rows = [
        Row(
            "Figure 7: ε₁ before calibration [mrad]",
            f"{1e3 * initial:.1f}",
            spread_text(ours["epsilon_1"][0], factor=1e3),
            f"{inside(ours['initial'], initial)}, {position(ours['initial'], initial)}",
        ),
        Row(
            "Figure 7: iterations to full recovery",
            published["figure_7"]["iterations_to_zero"],
            ", ".join(f"{n} in {count}" for n, count in ours["iterations"].items()),
            iterations_verdict(ours["iterations"], published["figure_7"]["iterations_to_zero"]),
        ),
    ]
    for n, printed in enumerate(printed_deviations(published), 1):
        chord, newton = ours["axis_deviation_chord"][n], ours["axis_deviation_newton"][n]
        rows.append(
            Row(
                f"Table 4: largest axis error after iteration {n}",
                f"{printed:.1e}",
                f"chord {chord[MEDIAN]:.1e} ({chord[MINIMUM]:.0e} to {chord[MAXIMUM]:.0e}), "
                f"Newton {newton[MEDIAN]:.1e}",
                method_of(printed, chord, newton),
            )
        )
    rows += table_4(study, published)
    stable = published["figure_8"]["stable_from_orientations"]
    for name, side in (("level_1_noise", "left"), ("level_1_noise_of_rotor_side", "right")):
        from_stable = [row["seeds_below_noise"] for row in study[name] if row["orientations"] >= stable]
        rows.append(
            Row(
                f"Figure 8: ε₁ below the added noise from {stable} orientations, noise from the {side}",
                published["figure_8"]["claim"],
                f"{min(from_stable)} of {study['seeds']} seeds at least",
                "agrees" if min(from_stable) == study["seeds"] else "does not hold for every seed",
            )
        )
    return rows


def level_2(study, published):
    rows = table_5(study, published)
    for number in (1, 2):
        ours, paper = study[f"situation_{number}"], published[f"situation_{number}"]
        printed = paper["epsilon_2_plotted"][0]
        squares = [value * value for value in ours["initial"]]
        rows += [
            Row(
                f"Situation {number}: ε₂ before, as plotted",
                f"{printed:.2g}",
                f"rms {spread_text(ours['epsilon_2'][0])} N·m; mean square "
                f"{min(squares):.2g} to {max(squares):.2g}",
                plotted_as(ours["initial"], printed),
            ),
            Row(
                f"Situation {number}: iterations",
                str(paper["iterations"]),
                ", ".join(f"{n} in {count}" for n, count in ours["iterations"].items()),
                iterations_verdict(ours["iterations"], paper["iterations"]),
            ),
            Row(
                f"Situation {number}: random sets that show every parameter",
                "not told",
                f"{ours['observable_sets']} of {study['seeds']}",
                left_open(ours["observable_sets"], study["seeds"]),
            ),
        ]
    share = published["situation_1"]["largest_error_share_with_noise"]
    shown = {
        row["orientations"]: row["observable_sets"]
        for row in study["situation_1"]["noise"]
        if row["measurements"] == MEASUREMENTS
    }
    rows.append(
        Row(
            f"Situation 1: sets of {MEASUREMENTS} that show every parameter, of {study['seeds']}",
            "poses of large torque",
            ", ".join(f"{count} {orientations}" for orientations, count in shown.items()),
            f"{'fewer' if shown['of large torque'] < shown['random'] else 'not fewer'} by the rule than by chance",
        )
    )
    for orientations in ("random", "of large torque", "planned"):
        row = row_at(noise_rows(study["situation_1"], orientations), "measurements", MEASUREMENTS)
        rows.append(
            Row(
                f"Situation 1 with noise: largest error over the assigned one, {orientations} set",
                f"{100 * share:.1f} %",
                spread_text(row["largest_share"], "%", 100.0),
                position(row["largest_shares"], share),
            )
        )
    return rows


def control(study, published):
    rows = []
    figure = published["figure_14"]
    for run in study["control"]:
        paper, verdict = "–", "not shown by the paper"
        if not run["loaded"]:
            printed = figure["max_error_before"] if run["model"] == "nominal" else figure["max_error_after"]
            paper, verdict = str(printed), agrees_as_printed(printed, run["largest_error"])
        rows.append(
            Row(
                f"Figure 14{', loaded' if run['loaded'] else ''}: rotation error, {run['model'].replace('_', ' ')} [rad]",
                paper,
                f"{run['final_error']:.2g} at the end, at most {run['largest_error']:.2g}",
                verdict,
            )
        )
    for run in study["torque_errors"]:
        rows.append(
            Row(
                f"‖Q_true Q_model⁺ − I‖₂ within ±{run['tilt']:.1f} rad, {run['model'].replace('_', ' ')}",
                "–",
                f"mean {run['mean']:.2g}, median {run['spread'][MEDIAN]:.2g}, at most {run['spread'][MAXIMUM]:.2g}",
                "not shown by the paper",
            )
        )
    return rows


def sections(study, published):
    """(title, rows) of every part."""
    return [
        ("Level 1: the joint", level_1(study, published)),
        ("Level 2: poles and coils", level_2(study, published)),
        ("What calibration buys a controller", control(study, published)),
    ]


def as_text(parts):
    lines = []
    for title, rows in parts:
        widths = [max(len(getattr(row, key)) for row in rows) for key in ("what", "paper", "ours")]
        lines += [title, "=" * len(title)]
        for row in rows:
            cells = (row.what, row.paper, row.ours)
            lines.append("  ".join(c.ljust(w) for c, w in zip(cells, widths)) + "  " + row.verdict)
        lines.append("")
    return "\n".join(line.rstrip() for line in lines)
