"""Numbers as people read them."""

import math

# Factor and unit in which a quantity of the report is shown; others are in SI units.
SHOWN = {"rad": (1e3, "mrad"), "N·m": (1e3, "mN·m"), "1": (1.0, "")}


def shown_in(unit):
    """Factor and unit in which a quantity is shown."""
    return SHOWN.get(unit, (1.0, unit))


def significant(value, digits=3):
    """Shortest text with so many significant digits: 0.122, 65.5, 2840, 1.2e-7."""
    if not math.isfinite(value):
        return "–"
    if 10.0**digits <= abs(value) < 1e6:
        return f"{value:.0f}"
    return f"{value:.{digits}g}".replace("e-0", "e-").replace("e+0", "e")


def with_unit(value, unit, digits=3):
    """A value in SI units as it is shown: 0.000122 rad gives "0.122 mrad"."""
    factor, name = shown_in(unit)
    return f"{significant(factor * value, digits)} {name}".strip()


def change_of(before, after, unit):
    """ "65.5 → 0.122 mrad" of values in SI units."""
    factor, _ = shown_in(unit)
    return f"{significant(factor * before)} → {with_unit(after, unit)}"


def decimals_of(stddev):
    """Decimals with which a standard deviation has two significant digits."""
    if not math.isfinite(stddev) or stddev <= 0.0:
        return 6
    return min(12, max(0, 1 - math.floor(math.log10(stddev))))


def plus_minus(value, stddev):
    """ "0.017933 ± 0.000032": both to the second significant digit of the uncertainty."""
    decimals = decimals_of(stddev)
    value = round(value, decimals) + 0.0  # what rounds to zero has no sign
    return f"{value:.{decimals}f} ± {stddev:.{decimals}f}".replace("-", "−")


def signed(value, unit, digits=4):
    """A difference in SI units as it is shown, with its sign: -0.000122 rad gives "−0.122 mrad"."""
    factor, name = shown_in(unit)
    return f"{factor * value:+.{digits}g} {name}".replace("-", "−").strip()
