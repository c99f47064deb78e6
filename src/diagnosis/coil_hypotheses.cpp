#include <algorithm>
#include <cmath>
#include <utility>

#include "explanation_words.hpp"
#include "material_value.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "torque_hypotheses.hpp"

namespace sac {
namespace {

/// Strength of a pole that is missing: a description has no zero.
constexpr double kNearlyNothing = 1e-6;

/// Strengths nearer to −1 or 0 than to 1.
constexpr double kTurned = -0.5;
constexpr double kNone = 0.5;

template <typename Change>
Hypothesis ofCurrents(const std::string& cause,
                      const std::string& family,
                      const std::string& sentence,
                      Change change) {
  Hypothesis result;
  result.cause = cause;
  result.family = family;
  result.correct = [change](WiringCase& wiring, const Eigen::VectorXd& /*values*/) {
    for (Sample& sample : wiring.samples) {
      if (sample.current.size() > 0) {
        change(sample.current);
      }
    }
  };
  result.sentence = [sentence](const Eigen::VectorXd& /*values*/) { return sentence; };
  return result;
}

template <typename Change>
Hypothesis ofPole(const std::string& cause,
                  std::size_t pole,
                  const std::string& sentence,
                  Change change) {
  Hypothesis result;
  result.cause = cause + ":" + numberText(pole);
  result.family = "pole:" + numberText(pole);
  result.correct = [pole, change](WiringCase& wiring, const Eigen::VectorXd& /*values*/) {
    change(wiring.actuator.poles[pole]);
  };
  result.redescribe = [pole, change](Actuator& actuator, const Eigen::VectorXd& /*values*/) {
    change(actuator.poles[pole]);
  };
  result.sentence = [sentence](const Eigen::VectorXd& /*values*/) { return sentence; };
  return result;
}

/// A pole or coil whose torque is a factor times that of its description, by its start; what it
/// corrects is left to the caller. `should`: how much it should exert, and what to check.
Hypothesis strength(const std::string& kind,
                    std::size_t index,
                    double factor,
                    double tolerance,
                    const std::string& should) {
  Hypothesis result;
  result.cause = kind + "_gain:" + numberText(index);
  result.family = kind + ":" + numberText(index);
  result.start = Eigen::VectorXd::Constant(1, factor);
  result.is_strength = true;
  result.is_material = [tolerance](const Eigen::VectorXd& values) {
    return std::abs(values[0] - 1.0) > kMaterial * tolerance;
  };
  result.sentence =
      [kind, name = kind + " " + numberText(index), should](const Eigen::VectorXd& values) {
        return name + format(" exerts %.3g times the torque that ", values[0]) + should +
               format("; multiply its `gain` in the description by %.4g, or model ", values[0]) +
               kind + "_gains in calibration.yaml.";
      };
  return result;
}

}  // namespace

Hypothesis coilShift(std::size_t steps) {
  const std::string sentence =
      "the currents of all coils are shifted: what is recorded as coil 1 flows in coil " +
      numberText(steps) +
      ", and so on around: correct the first register `address` of setpoints and currents in the "
      "coil driver's file (coil_driver.yaml), or the order of coils in the description.";
  Hypothesis result =
      ofCurrents("coil_shift", "coil_shift", sentence, [steps](Eigen::VectorXd& current) {
        const Eigen::VectorXd before = current;
        const Eigen::Index size = current.size();
        for (Eigen::Index j = 0; j < size; ++j) {
          current[(j + static_cast<Eigen::Index>(steps)) % size] = before[j];
        }
      });
  result.redescribe = [steps](Actuator& actuator, const Eigen::VectorXd& /*values*/) {
    std::rotate(actuator.coils.begin(),
                actuator.coils.begin() + static_cast<std::ptrdiff_t>(steps),
                actuator.coils.end());
  };
  return result;
}

Hypothesis coilSign(std::size_t coil) {
  return ofCurrents(
      "coil_sign:" + numberText(coil),
      "coil:" + numberText(coil),
      "coil " + numberText(coil) +
          " is wired the wrong way round: exchange its leads at the amplifier.",
      [coil](Eigen::VectorXd& current) { current[static_cast<Eigen::Index>(coil)] *= -1.0; });
}

Hypothesis coilSwap(std::size_t first, std::size_t second) {
  const std::string cause = "coil_swap:" + numberText(first) + ":" + numberText(second);
  Hypothesis result =
      ofCurrents(cause,
                 cause,
                 "coils " + numberText(first) + " and " + numberText(second) +
                     " are exchanged: exchange their leads at the amplifier, or their entries in "
                     "the description.",
                 [first, second](Eigen::VectorXd& current) {
                   std::swap(current[static_cast<Eigen::Index>(first)],
                             current[static_cast<Eigen::Index>(second)]);
                 });
  result.redescribe = [first, second](Actuator& actuator, const Eigen::VectorXd& /*values*/) {
    std::swap(actuator.coils[first], actuator.coils[second]);
  };
  return result;
}

Hypothesis coilCircle(const std::vector<std::size_t>& coils) {
  std::string cause = "coil_circle";
  std::string places;
  for (std::size_t n = 0; n < coils.size(); ++n) {
    cause += ":" + numberText(coils[n]);
    places += (n == 0 ? "" : ", ") + numberText(coils[n]) + " in " +
              numberText(coils[(n + 1) % coils.size()]);
  }
  Hypothesis result = ofCurrents(
      cause,
      cause,
      "coils are exchanged in a circle, the current recorded of " + places +
          ": exchange their leads at the amplifier, or their entries in the "
          "description.",
      [coils](Eigen::VectorXd& current) {
        const Eigen::VectorXd before = current;
        for (std::size_t n = 0; n < coils.size(); ++n) {
          const std::size_t next = coils[(n + 1) % coils.size()];
          current[static_cast<Eigen::Index>(next)] = before[static_cast<Eigen::Index>(coils[n])];
        }
      });
  result.redescribe = [coils](Actuator& actuator, const Eigen::VectorXd& /*values*/) {
    const std::vector<CoilAxis> before = actuator.coils;
    for (std::size_t n = 0; n < coils.size(); ++n) {
      actuator.coils[coils[n]] = before[coils[(n + 1) % coils.size()]];
    }
  };
  return result;
}

Hypothesis coilDead(std::size_t coil) {
  return ofCurrents(
      "coil_dead:" + numberText(coil),
      "coil:" + numberText(coil),
      "coil " + numberText(coil) +
          " exerts no torque though a current is measured: check its winding, its "
          "connector and its current sensor; remove its samples meanwhile.",
      [coil](Eigen::VectorXd& current) { current[static_cast<Eigen::Index>(coil)] = 0.0; });
}

Hypothesis coilGain(std::size_t coil, double gain, double tolerance) {
  Hypothesis result = strength("coil",
                               coil,
                               gain,
                               tolerance,
                               "its current should: check its winding and the scale of its current "
                               "sensor");
  if (gain < kNone) {
    result.simpler = {gain < kTurned ? coilSign(coil) : coilDead(coil)};
  }
  result.correct = [coil](WiringCase& wiring, const Eigen::VectorXd& values) {
    // By the currents: the factor may pass zero on the way.
    for (Sample& sample : wiring.samples) {
      if (sample.current.size() > 0) {
        sample.current[static_cast<Eigen::Index>(coil)] *= values[0];
      }
    }
  };
  result.redescribe = [coil](Actuator& actuator, const Eigen::VectorXd& values) {
    actuator.coils[coil].gain *= std::max(values[0], kNearlyNothing);
  };
  return result;
}

Hypothesis polePolarity(std::size_t pole) {
  return ofPole("pole_polarity",
                pole,
                "pole " + numberText(pole) +
                    " has the opposite polarity: turn its magnet around, or change its "
                    "`polarity` in the description.",
                [](PoleAxis& axis) { axis.polarity *= -1; });
}

Hypothesis poleMissing(std::size_t pole) {
  return ofPole("pole_missing",
                pole,
                "pole " + numberText(pole) +
                    " exerts no torque: its magnet is missing or lost its strength; mount it, or "
                    "take it out of the description.",
                [](PoleAxis& axis) { axis.gain *= kNearlyNothing; });
}

Hypothesis poleGain(std::size_t pole, double gain, double tolerance) {
  Hypothesis result = strength(
      "pole", pole, gain, tolerance, "it should: check its magnet and its distance to the coils");
  if (gain < kNone) {
    result.simpler = {gain < kTurned ? polePolarity(pole) : poleMissing(pole)};
  }
  result.redescribe = [pole](Actuator& actuator, const Eigen::VectorXd& values) {
    // The polarity is another hypothesis, and a description has no zero.
    actuator.poles[pole].gain *= std::max(values[0], kNearlyNothing);
  };
  result.correct = [change = result.redescribe](WiringCase& wiring, const Eigen::VectorXd& values) {
    change(wiring.actuator, values);
  };
  return result;
}

}  // namespace sac
