"""A calibrated description against that of the emulated unit."""

import yaml

INTERVALS = 5.0  # standard deviations that hold every parameter: with 4, one run in 400 fails by chance
LARGEST = 5e-3  # [rad] that they may be wide


def _actuator(path):
    with open(path, encoding="utf-8") as file:
        return yaml.safe_load(file)["actuator"]


def expect_truth(test, result_path, truth_path):
    """Every pole, coil and offset is identified, and as far from the truth as its standard deviation says."""
    result, truth = _actuator(result_path), _actuator(truth_path)
    compared = 0
    for group in ("poles", "coils"):
        for one, other in zip(result[group], truth[group]):
            for angle in ("polar", "azimuth"):
                limit = INTERVALS * one["stddev"][angle]
                test.assertLess(limit, LARGEST)
                test.assertLess(abs(one[angle] - other[angle]), limit, f"{group} {angle}")
                compared += 1
    test.assertEqual(len(result["joints"]), len(truth["joints"]))
    for one, other in zip(result["joints"], truth["joints"]):
        test.assertLess(abs(one["offset"] - other["offset"]), INTERVALS * one["stddev"]["offset"])
        compared += 1
    axes = len(truth["poles"]) + len(truth["coils"])
    test.assertEqual(compared, 2 * axes + len(truth["joints"]))
    test.assertGreater(axes, 0)
