#include "table_coverage.hpp"

#include <cmath>
#include <cstddef>

#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"

namespace sac {
namespace {

/// Of angles between pole and coil where the curve is what nobody stated, by their cosines.
struct GuessedZone {
  double least = 0.0;
  double largest = 0.0;

  bool holds(double cosine) const { return cosine > least && cosine < largest; }
};

/// From the last point of the table to where the curve ends.
GuessedZone guessedZone(const TorqueCurveDescription& curve) {
  const double unit = curve.angle_unit == AngleUnit::kDegree ? kOneDegree : 1.0;
  return {std::cos(curve.support_end * unit), std::cos(curve.table.angles.back() * unit)};
}

bool isUsed(const GuessedZone& zone,
            const TorqueGeometry& geometry,
            const Eigen::Matrix3d& R_stator_rotor,
            const std::vector<Excitation>& excitations) {
  for (const Excitation& excitation : excitations) {
    const Eigen::Vector3d coil_rotor =
        R_stator_rotor.transpose() *
        geometry.coils_stator.col(static_cast<Eigen::Index>(excitation.coil));
    for (Eigen::Index i = 0; i < geometry.poles_rotor.cols(); ++i) {
      if (zone.holds(geometry.poles_rotor.col(i).dot(coil_rotor))) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

std::string tableCoverageInWords(const EstimationProblem& problem,
                                 const Estimate& estimate,
                                 const EstimationOptions& options) {
  const ParameterSpace& space = problem.model->space();
  if (!problem.model->hasTorqueModel() || space.nominal().torque_curve->table.empty()) {
    return {};
  }
  const TorqueCurveDescription& curve = *space.nominal().torque_curve;
  // A support that begins before the last point is the user's own.
  if (curve.support_begin < curve.table.angles.back()) {
    return {};
  }
  const GuessedZone zone = guessedZone(curve);
  const ModelPoint point(*problem.model, estimate.belief.x);
  const TorqueGeometry geometry = torqueGeometry(space.actuatorAt(estimate.belief.x));
  std::size_t torques = 0;
  std::size_t guessed = 0;
  for (const ObservationResidual& residual : estimate.residuals) {
    if (residual.observation.quantity != Quantity::kTorque) {
      continue;
    }
    const Sample& sample = (*problem.samples)[residual.observation.sample];
    ++torques;
    guessed += isUsed(zone,
                      geometry,
                      point.orientation(sample),
                      excitedCoils(sample, options.current_threshold))
                   ? 1U
                   : 0U;
  }
  if (guessed == 0) {
    return {};
  }
  const char* const unit = curve.angle_unit == AngleUnit::kDegree ? "deg" : "rad";
  return format(
      "%zu of %zu torques have a pole between %.3g and %.3g %s from an excited coil, beyond the "
      "last point of torque_curve.table, where the curve is a guess; continue the table to where "
      "the torque ends, or state a support that begins within it, or model it (effects: "
      "{torque_curve: true}).",
      guessed,
      torques,
      curve.table.angles.back(),
      curve.support_end,
      unit);
}

}  // namespace sac
