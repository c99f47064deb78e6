#include "levitated_screen.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "orientation_hypotheses.hpp"
#include "spherical_actuator_calibration/actuator/inverse_kinematics.hpp"
#include "torque_screen.hpp"

namespace sac {
namespace {

/// More than so many torques tell nothing more to a screening.
constexpr std::size_t kMostMapsScreened = 40;
constexpr std::size_t kMostMapsFitted = 8;

/// The orientation is the reading of the rotor, too.
Hypothesis ofReadings(Hypothesis hypothesis) {
  hypothesis.correct = [change = hypothesis.correct](WiringCase& wiring,
                                                     const Eigen::VectorXd& values) {
    change(wiring, values);
    for (Sample& sample : wiring.samples) {
      sample.joint_position = freeRotorAngles(sample.R_stator_rotor);
    }
  };
  return hypothesis;
}

/// Evenly chosen samples with torque.
WiringCase torquesOf(const WiringCase& described) {
  std::vector<const Sample*> all;
  for (const Sample& sample : described.samples) {
    if (sample.has_torque) {
      all.push_back(&sample);
    }
  }
  WiringCase few;
  few.actuator = described.actuator;
  const std::size_t step = (all.size() + kMostMapsScreened - 1) / kMostMapsScreened;
  for (std::size_t n = 0; n < all.size(); n += step) {
    few.samples.push_back(*all[n]);
  }
  return few;
}

/// Small to large turns about the axes and diagonals of a cube [rad].
std::vector<Eigen::Vector3d> rotationGrid() {
  std::vector<Eigen::Vector3d> grid;
  for (const double angle : {0.15, 0.3, 0.5, 0.75}) {
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3d direction =
          Eigen::Vector3i(n % 3, n / 3 % 3, n / 9).cast<double>() - Eigen::Vector3d::Ones();
      if (!direction.isZero()) {
        grid.emplace_back(angle * direction.normalized());
      }
    }
  }
  return grid;
}

class Screen {
 public:
  Screen(const WiringCase& described, const CalibrationConfig& config)
      : described_(described),
        config_(config),
        few_(torquesOf(described)),
        unchanged_(torqueLoss(few_, config)) {}

  std::vector<ScreenedCandidate> run() {
    for (const Hypothesis& hypothesis : trackerHypotheses()) {
      add(hypothesis, gainOf(hypothesis));
    }
    const double tolerance = config_.tolerance.joint_axis;
    for (const Hypothesis& rotation : {trackerRotation(tolerance), markerRotation(tolerance)}) {
      const Hypothesis scanned = atBestStart(rotation);
      add(scanned, gainOf(scanned));
    }
    const double all = torqueLoss(described_, config_);
    for (const Hypothesis& shift : shiftHypotheses(Quantity::kOrientation)) {
      const double loss = torqueLoss(corrected(described_, {shift}, {}), config_);
      add(shift, (all - loss) * share());
    }
    keepBest(candidates_, kMostMapsFitted);
    return std::move(candidates_);
  }

 private:
  double share() const {
    return static_cast<double>(few_.samples.size()) /
           static_cast<double>(std::max<std::size_t>(1, described_.samples.size()));
  }

  double gainOf(const Hypothesis& hypothesis) const {
    return unchanged_ - torqueLoss(corrected(few_, {hypothesis}, hypothesis.start), config_);
  }

  Hypothesis atBestStart(const Hypothesis& rotation) const {
    Hypothesis best = rotation;
    double best_gain = 0.0;
    for (const Eigen::Vector3d& start : rotationGrid()) {
      Hypothesis trial = rotation;
      trial.start = start;
      const double gain = gainOf(trial);
      if (gain > best_gain) {
        best_gain = gain;
        best = std::move(trial);
      }
    }
    return best;
  }

  void add(const Hypothesis& hypothesis, double gain) {
    if (gain > 0.0) {
      candidates_.push_back({{ofReadings(hypothesis)}, gain});
    }
  }

  const WiringCase& described_;
  const CalibrationConfig& config_;
  const WiringCase few_;
  const double unchanged_;
  std::vector<ScreenedCandidate> candidates_;
};

}  // namespace

std::vector<ScreenedCandidate> screenTrackerByTorques(const WiringCase& described,
                                                      const CalibrationConfig& config) {
  return Screen(described, config).run();
}

}  // namespace sac
