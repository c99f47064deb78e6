#include "torque_screen.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cube_rotations.hpp"
#include "orientation_hypotheses.hpp"
#include "posterior_fit.hpp"
#include "predicted_torques.hpp"
#include "spherical_actuator_calibration/base/median.hpp"
#include "spherical_actuator_calibration/base/nearest_rotation.hpp"
#include "spherical_actuator_calibration/base/rotations.hpp"
#include "spherical_actuator_calibration/measurement/current_tolerance.hpp"
#include "torque_hypotheses.hpp"

namespace sac {
namespace {

constexpr std::size_t kMostTurnsFitted = 8;
/// Gains below it come by chance and are not worth a fit [nats].
constexpr double kLeastGain = 3.0;
/// A strength this near to none counts as none, and a factor this near to 1 as 1.
constexpr double kAlikeUnit = 0.2;
/// Coils with fewer torques are not judged by themselves.
constexpr std::size_t kFewestOfCoil = 3;
/// Twice the mean of a chi-square of three degrees of freedom: few coils reach it by chance.
constexpr double kMisfits = 6.0;
constexpr std::size_t kMostMisfitting = 2;

/// All hypotheses of one case against its torques at the nominal description.
class TorqueScreen {
 public:
  TorqueScreen(const WiringCase& described, const CalibrationConfig& config)
      : described_(described), config_(config), torques_(predictTorques(described, config)) {
    for (const PredictedTorque& torque : torques_) {
      losses_.push_back(lossOf(torque.measured - torque.total, torque.variance(torque.current)));
      loss_ += losses_.back();
    }
  }

  double loss() const { return loss_; }

  std::vector<ScreenedCandidate> run(bool with_joints) {
    addSensors();
    addCurrents();
    addCoils();
    addPoles();
    if (with_joints) {
      addJoints();
    }
    std::vector<ScreenedCandidate> promising;
    for (ScreenedCandidate& candidate : candidates_) {
      if (candidate.gain > kLeastGain) {
        promising.push_back(std::move(candidate));
      }
    }
    keepBest(promising, kMostTurnsFitted);
    return promising;
  }

 private:
  static double lossOf(const Eigen::Vector3d& residual, double variance) {
    return studentLoss(residual.squaredNorm() / variance) + 1.5 * std::log(variance);
  }

  void add(Candidate parts, double gain) { candidates_.push_back({std::move(parts), gain}); }

  /// Frame, place, sign and unit of torques, in all combinations.
  void addSensors() {
    for (const bool in_stator : {false, true}) {
      std::vector<Eigen::Vector3d> measured;
      for (const PredictedTorque& torque : torques_) {
        measured.push_back(
            in_stator ? Eigen::Vector3d(torque.R_stator_rotor.transpose() * torque.measured)
                      : torque.measured);
      }
      const std::vector<Eigen::Matrix3d> rotations = cubeRotations();
      for (std::size_t n = 0; n < rotations.size(); ++n) {
        // A sensor that is turned and reads in the stator is one turn before the other.
        if (in_stator && n > 0) {
          break;
        }
        for (const double sign : {1.0, -1.0}) {
          addSensor(measured, in_stator, rotations[n], n > 0, sign);
        }
      }
      if (!in_stator) {
        addRotation(measured);
      }
    }
  }

  void addSensor(const std::vector<Eigen::Vector3d>& measured,
                 bool in_stator,
                 const Eigen::Matrix3d& rotation,
                 bool is_turned,
                 double sign) {
    Candidate parts;
    if (in_stator) {
      parts.push_back(torqueInStatorFrame());
    }
    if (is_turned) {
      parts.push_back(torqueFrame(rotation));
    }
    if (sign < 0.0) {
      parts.push_back(torqueSign());
    }
    std::vector<Eigen::Vector3d> turned;
    turned.reserve(measured.size());
    for (const Eigen::Vector3d& torque : measured) {
      turned.emplace_back(sign * rotation * torque);
    }
    if (!parts.empty()) {
      add(parts, loss_ - loss(turned));
    }
    addUnits(turned, parts);
    if (sign < 0.0 && parts.size() == 1) {
      add({currentSign()}, candidates_[candidates_.size() - 1].gain);
    }
  }

  /// `factor`: by which what was measured was multiplied. Its noise and allowance go with it; the
  /// density of what was measured counts, not of what is made of it.
  double loss(const std::vector<Eigen::Vector3d>& measured, double factor = 1.0) const {
    double sum = -3.0 * static_cast<double>(torques_.size()) * std::log(factor);
    for (std::size_t n = 0; n < torques_.size(); ++n) {
      const PredictedTorque& torque = torques_[n];
      const double further_noise = (factor * factor - 1.0) * torque.noise;
      sum += lossOf(measured[n] - torque.total, torque.variance(torque.current) + further_noise);
    }
    return sum;
  }

  /// The factor between measured and predicted torques, where it is none of tolerance.
  void addUnits(const std::vector<Eigen::Vector3d>& measured, const Candidate& others) {
    std::vector<double> ratios;
    for (std::size_t n = 0; n < torques_.size(); ++n) {
      const double size = torques_[n].total.norm() * measured[n].norm();
      if (size > 0.0) {
        ratios.push_back(torques_[n].total.norm() / measured[n].norm());
      }
    }
    if (ratios.size() < 3) {
      return;
    }
    std::nth_element(ratios.begin(),
                     ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2),
                     ratios.end());
    const double factor = ratios[ratios.size() / 2];
    if (std::abs(std::log(factor)) < kAlikeUnit) {
      return;
    }
    std::vector<Eigen::Vector3d> scaled = measured;
    for (Eigen::Vector3d& torque : scaled) {
      torque *= factor;
    }
    const double gain = loss_ - loss(scaled, factor);
    Candidate parts = others;
    parts.push_back(torqueUnit(factor, config_.tolerance.effect));
    add(parts, gain);
    if (others.empty()) {
      add({currentUnit(1.0 / factor, config_.tolerance.effect)}, gain);
    }
  }

  /// The rotation that turns measured torques best into predicted ones (Kabsch).
  void addRotation(const std::vector<Eigen::Vector3d>& measured) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t n = 0; n < torques_.size(); ++n) {
      const PredictedTorque& torque = torques_[n];
      const double size = torque.total.norm() * measured[n].norm();
      if (size > 0.0) {
        sum += torque.total * measured[n].transpose() / size;
      }
    }
    const Eigen::Matrix3d rotation = nearestRotation(sum);
    std::vector<Eigen::Vector3d> turned;
    turned.reserve(measured.size());
    for (const Eigen::Vector3d& torque : measured) {
      turned.emplace_back(rotation * torque);
    }
    add({torqueRotation(rotationLog(rotation), config_.tolerance.pole)}, loss_ - loss(turned));
  }

  /// Currents of other coils, and rows that were mixed up.
  void addCurrents() {
    for (std::size_t steps = 1; steps < described_.actuator.coils.size(); ++steps) {
      addExactly(coilShift(steps));
    }
    // Neighbours of the right shift explain somewhat, too: they must not crowd others out.
    std::vector<ScreenedCandidate> others = std::exchange(candidates_, {});
    for (const Hypothesis& hypothesis : shiftHypotheses(Quantity::kTorque)) {
      addExactly(hypothesis);
    }
    keepBest(candidates_, kMostShifts);
    for (ScreenedCandidate& candidate : others) {
      candidates_.push_back(std::move(candidate));
    }
  }

  /// By the corrected currents and torques at the same poses.
  void addExactly(const Hypothesis& hypothesis) {
    const WiringCase mended = corrected(described_, {hypothesis}, hypothesis.start);
    double sum = 0.0;
    for (const PredictedTorque& torque : torques_) {
      const Sample& sample = mended.samples[torque.sample];
      sum += lossOf(sample.torque - torque.per_ampere * sample.current,
                    torque.variance(sample.current));
    }
    add({hypothesis}, loss_ - sum);
  }

  void addCoils() {
    const auto coils = static_cast<Eigen::Index>(described_.actuator.coils.size());
    for (Eigen::Index j = 0; j < coils; ++j) {
      const auto coil = static_cast<std::size_t>(j);
      addWithCurrent(
          coilSign(coil), [j](Eigen::VectorXd& current) { current[j] *= -1.0; }, j, j);
      addWithCurrent(
          coilDead(coil), [j](Eigen::VectorXd& current) { current[j] = 0.0; }, j, j);
      addGain(j);
      for (Eigen::Index other = j + 1; other < coils; ++other) {
        addWithCurrent(
            coilSwap(coil, static_cast<std::size_t>(other)),
            [j, other](Eigen::VectorXd& current) { std::swap(current[j], current[other]); },
            j,
            other);
      }
    }
  }

  /// A coil that is off measures some milliamperes all the same, which explain anything when they
  /// are multiplied by enough.
  bool isOn(const PredictedTorque& torque, Eigen::Index coil) const {
    return isExcited(torque.current[coil], config_.estimation.current_threshold);
  }

  /// By the samples in which one of two coils is on.
  template <typename Change>
  void addWithCurrent(const Hypothesis& hypothesis,
                      Change change,
                      Eigen::Index first,
                      Eigen::Index second) {
    double gain = 0.0;
    for (std::size_t n = 0; n < torques_.size(); ++n) {
      const PredictedTorque& torque = torques_[n];
      if (!isOn(torque, first) && !isOn(torque, second)) {
        continue;
      }
      Eigen::VectorXd current = torque.current;
      change(current);
      gain += losses_[n] -
              lossOf(torque.measured - torque.per_ampere * current, torque.variance(current));
    }
    if (gain > kLeastGain) {
      add({hypothesis}, gain);
    }
  }

  /// The strength that explains a coil's torques best, by weighted least squares.
  void addGain(Eigen::Index coil) {
    double top = 0.0;
    double bottom = 0.0;
    for (const PredictedTorque& torque : torques_) {
      if (!isOn(torque, coil)) {
        continue;
      }
      const Eigen::Vector3d own = torque.per_ampere.col(coil) * torque.current[coil];
      const double weight = 1.0 / torque.variance(torque.current);
      top += weight * own.dot(torque.measured - torque.total + own);
      bottom += weight * own.squaredNorm();
    }
    if (bottom == 0.0) {
      return;
    }
    const double gain = top / bottom;
    addWithCurrent(
        coilGain(static_cast<std::size_t>(coil), gain, config_.tolerance.effect),
        [coil, gain](Eigen::VectorXd& current) { current[coil] *= gain; },
        coil,
        coil);
  }

  void addPoles() {
    for (std::size_t i = 0; i < described_.actuator.poles.size(); ++i) {
      addPole(polePolarity(i), i, 2.0);
      addPole(poleMissing(i), i, 1.0);
    }
  }

  /// `share`: of the pole's torque that goes away.
  void addPole(const Hypothesis& hypothesis, std::size_t pole, double share) {
    double gain = 0.0;
    for (std::size_t n = 0; n < torques_.size(); ++n) {
      const PredictedTorque& torque = torques_[n];
      const Eigen::Vector3d own = torque.of_pole.col(static_cast<Eigen::Index>(pole));
      if (!own.isZero(0.0)) {
        gain += losses_[n] - lossOf(torque.measured - torque.total + share * own,
                                    torque.variance(torque.current));
      }
    }
    add({hypothesis}, gain);
  }

  void addJoints() {
    for (const Hypothesis& hypothesis : jointHypotheses(described_.actuator, config_.tolerance)) {
      if (hypothesis.start.size() == 0) {
        const WiringCase mended = corrected(described_, {hypothesis}, hypothesis.start);
        add({hypothesis}, loss_ - torqueLoss(mended, config_));
      }
    }
  }

  const WiringCase& described_;
  const CalibrationConfig& config_;
  std::vector<PredictedTorque> torques_;
  std::vector<double> losses_;
  double loss_ = 0.0;
  std::vector<ScreenedCandidate> candidates_;
};

}  // namespace

std::vector<ScreenedCandidate> screenTorques(const WiringCase& described,
                                             const CalibrationConfig& config,
                                             bool with_joints) {
  return TorqueScreen(described, config).run(with_joints);
}

double torqueLoss(const WiringCase& given, const CalibrationConfig& config) {
  return TorqueScreen(given, config).loss();
}

std::vector<ScreenedCandidate> screenMisfittingCoils(const WiringCase& described,
                                                     const WiringCase& fitted,
                                                     const CalibrationConfig& config) {
  const std::vector<PredictedTorque> drawn = predictTorques(described, config);
  const std::vector<PredictedTorque> torques = predictTorques(fitted, config);
  std::vector<ScreenedCandidate> worst;
  for (std::size_t coil = 0; coil < described.actuator.coils.size(); ++coil) {
    const auto column = static_cast<Eigen::Index>(coil);
    std::vector<double> misfits;
    std::vector<double> strengths;
    for (std::size_t n = 0; n < torques.size(); ++n) {
      const Eigen::Vector3d own = drawn[n].per_ampere.col(column) * drawn[n].current[column];
      if (isExcited(torques[n].current[column], config.estimation.current_threshold) &&
          !own.isZero(0.0)) {
        misfits.push_back((torques[n].measured - torques[n].total).squaredNorm() /
                          torques[n].noise);
        const Eigen::Vector3d rest = drawn[n].measured - drawn[n].total + own;
        strengths.push_back(std::copysign(rest.norm() / own.norm(), rest.dot(own)));
      }
    }
    if (misfits.size() < kFewestOfCoil) {
      continue;
    }
    const double misfit = medianOf(misfits);
    if (misfit > kMisfits) {
      worst.push_back({{coilGain(coil, medianOf(strengths), config.tolerance.effect)}, misfit});
    }
  }
  keepBest(worst, kMostMisfitting);
  return worst;
}

}  // namespace sac
