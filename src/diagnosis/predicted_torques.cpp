#include "predicted_torques.hpp"

#include <cmath>

#include "posterior_fit.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "torque_hypotheses.hpp"
#include "torque_scale.hpp"

namespace sac {
namespace {

void addPairs(const TorqueCurve& curve,
              const TorqueGeometry& geometry,
              const ManufacturingTolerance& tolerance,
              PredictedTorque& torque) {
  const Eigen::Index poles = geometry.poles_rotor.cols();
  const Eigen::Index coils = geometry.coils_stator.cols();
  torque.per_ampere.setZero(3, coils);
  torque.coil_variance.setZero(coils);
  torque.of_pole.setZero(3, poles);
  // Tolerance of the joints turns the coils in the rotor as well.
  const double coil_variance = std::pow(tolerance.coil, 2) + std::pow(tolerance.joint_offset, 2);
  for (Eigen::Index j = 0; j < coils; ++j) {
    const Eigen::Vector3d coil = torque.R_stator_rotor.transpose() * geometry.coils_stator.col(j);
    for (Eigen::Index i = 0; i < poles; ++i) {
      const Eigen::Vector3d pole = geometry.poles_rotor.col(i);
      if (!interacts(curve, pole, coil)) {
        continue;
      }
      const PairTorque pair = linearizePairTorque(curve, pole, coil);
      const double strength = geometry.pole_strength[i] * geometry.coil_gain[j];
      torque.per_ampere.col(j) += strength * pair.torque;
      torque.of_pole.col(i) += strength * torque.current[j] * pair.torque;
      torque.coil_variance[j] += strength * strength *
                                 (std::pow(tolerance.pole, 2) * pair.d_pole.squaredNorm() +
                                  coil_variance * pair.d_coil.squaredNorm()) /
                                 3.0;
    }
  }
  torque.total = torque.per_ampere * torque.current;
}

}  // namespace

double PredictedTorque::variance(const Eigen::VectorXd& currents) const {
  return noise + currents.cwiseAbs2().dot(coil_variance);
}

std::vector<PredictedTorque> predictTorques(const WiringCase& described,
                                            const CalibrationConfig& config) {
  std::vector<PredictedTorque> torques;
  if (!described.actuator.hasTorqueModel()) {
    return torques;
  }
  const TorqueCurve curve(*described.actuator.torque_curve);
  const TorqueGeometry geometry = torqueGeometry(described.actuator);
  const double allowance = ModelAllowance{}.torque *
                           largeTorque(described.samples, config.estimation.default_torque_stddev);
  for (std::size_t n = 0; n < described.samples.size(); ++n) {
    const Sample& sample = described.samples[n];
    if (!sample.has_torque) {
      continue;
    }
    PredictedTorque torque;
    torque.sample = n;
    torque.measured = sample.torque;
    torque.R_stator_rotor = knownOrientation(described.actuator, sample);
    torque.current = sample.current;
    const double stated =
        sample.torque_stddev > 0.0 ? sample.torque_stddev : config.estimation.default_torque_stddev;
    torque.noise = stated * stated + allowance * allowance;
    addPairs(curve, geometry, config.tolerance, torque);
    torques.push_back(std::move(torque));
  }
  return torques;
}

}  // namespace sac
