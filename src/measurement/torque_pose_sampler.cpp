#include "spherical_actuator_calibration/measurement/torque_pose_sampler.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {
namespace {

constexpr int kMostDraws = 2000;

// Angles at which a pair is informative, and margins around the joints of the curve where its true
// shape is uncertain (doc/method.md, Torque curve).
constexpr double kInformativeBlends = 2.0;
constexpr double kInformativeSupport = 0.85;
constexpr double kUncertainBlends = 1.5;
constexpr double kUncertainMargin = 0.07;

/// Angle between unit vectors [rad], exact also for small ones.
double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Eigen::Vector3d randomPose(double tilt, NoiseSource& noise) {
  const double q1 = noise.uniform(tilt);
  const double q2 = noise.uniform(tilt);
  return {q1, q2, noise.uniform(kPi)};
}

TorquePoseSampler::TorquePoseSampler(const Actuator& actuator, double tilt)
    : curve_(*actuator.torque_curve),
      geometry_(torqueGeometry(actuator)),
      joints_(jointGeometry(actuator)),
      tilt_(tilt) {}

Eigen::Vector3d TorquePoseSampler::draw(std::size_t coil,
                                        std::optional<std::size_t> pole,
                                        NoiseSource& noise) const {
  Eigen::Vector3d best = randomPose(tilt_, noise);
  PoseGrade best_grade = grade(best, coil, pole);
  for (int draws = 1; draws < kMostDraws && best_grade != PoseGrade::kClear; ++draws) {
    const Eigen::Vector3d candidate = randomPose(tilt_, noise);
    const PoseGrade candidate_grade = grade(candidate, coil, pole);
    if (candidate_grade > best_grade) {
      best = candidate;
      best_grade = candidate_grade;
    }
  }
  return best;
}

PoseGrade TorquePoseSampler::grade(const Eigen::Vector3d& joint_position,
                                   std::size_t coil,
                                   std::optional<std::size_t> pole) const {
  const Eigen::Vector3d coil_rotor = rotorOrientation(joints_, joint_position).transpose() *
                                     geometry_.coils_stator.col(static_cast<Eigen::Index>(coil));
  bool informative = false;
  bool uncertain = false;
  for (Eigen::Index i = 0; i < geometry_.poles_rotor.cols(); ++i) {
    const double psi = angleBetween(geometry_.poles_rotor.col(i), coil_rotor);
    const bool wanted = !pole || static_cast<std::size_t>(i) == *pole;
    informative = informative || (wanted && isInformative(psi));
    uncertain = uncertain || isUncertain(psi);
  }
  if (!informative) {
    return PoseGrade::kBlind;
  }
  return uncertain ? PoseGrade::kUncertain : PoseGrade::kClear;
}

bool TorquePoseSampler::isInformative(double psi) const {
  return psi >= kInformativeBlends * curve_.blendStart() &&
         psi <= kInformativeSupport * curve_.supportBegin();
}

bool TorquePoseSampler::isUncertain(double psi) const {
  return psi <= kUncertainBlends * curve_.blendStart() ||
         (psi >= (1.0 - kUncertainMargin) * curve_.supportBegin() &&
          psi <= (1.0 + kUncertainMargin) * curve_.supportEnd());
}

}  // namespace sac
