#include "spherical_actuator_calibration/measurement/session_plan.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/random_purpose.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/measurement/torque_pose_sampler.hpp"

namespace sac {
namespace {

constexpr std::size_t kValidationCoils = 3;

Eigen::VectorXd singleCoil(std::size_t coils, std::size_t coil, double current) {
  return current *
         Eigen::VectorXd::Unit(static_cast<Eigen::Index>(coils), static_cast<Eigen::Index>(coil));
}

/// Coils that a dwell excites: the first, and further ones that the pose shows clearly too, those
/// first that have the most poses to come.
std::vector<std::size_t> coilsToExcite(const TorquePoseSampler& sampler,
                                       const Eigen::Vector3d& pose,
                                       std::size_t first,
                                       const std::vector<std::size_t>& poses_to_come,
                                       std::size_t most) {
  std::vector<std::size_t> others(poses_to_come.size());
  std::iota(others.begin(), others.end(), 0);
  std::stable_sort(others.begin(), others.end(), [&](std::size_t a, std::size_t b) {
    return poses_to_come[a] > poses_to_come[b];
  });
  std::vector<std::size_t> excited = {first};
  for (const std::size_t coil : others) {
    if (excited.size() >= most || poses_to_come[coil] == 0) {
      break;
    }
    if (coil != first && sampler.grade(pose, coil, std::nullopt) == PoseGrade::kClear) {
      excited.push_back(coil);
    }
  }
  return excited;
}

void planMainCoil(const TorquePoseSampler& sampler,
                  const Actuator& nominal,
                  const SessionPlanOptions& options,
                  NoiseSource& noise,
                  SessionPlan& plan) {
  for (std::size_t n = 0; n < options.main_coil_poses; ++n) {
    PlannedDwell dwell;
    dwell.joint_position = sampler.draw(options.main_coil, n % nominal.poles.size(), noise);
    dwell.patterns = {singleCoil(nominal.coils.size(), options.main_coil, options.current)};
    plan.dwells.push_back(dwell);
  }
}

void planOtherCoils(const TorquePoseSampler& sampler,
                    const Actuator& nominal,
                    const SessionPlanOptions& options,
                    NoiseSource& noise,
                    SessionPlan& plan) {
  std::vector<std::size_t> poses_to_come(nominal.coils.size(), options.coil_poses);
  poses_to_come[options.main_coil] = 0;
  for (;;) {
    const auto neediest = std::max_element(poses_to_come.begin(), poses_to_come.end());
    if (*neediest == 0) {
      return;
    }
    const auto first = static_cast<std::size_t>(neediest - poses_to_come.begin());
    PlannedDwell dwell;
    dwell.joint_position = sampler.draw(first, std::nullopt, noise);
    for (const std::size_t coil : coilsToExcite(
             sampler, dwell.joint_position, first, poses_to_come, options.coils_per_dwell)) {
      dwell.patterns.push_back(singleCoil(nominal.coils.size(), coil, options.current));
      --poses_to_come[coil];
    }
    plan.dwells.push_back(dwell);
  }
}

PlannedDwell validationDwell(const Actuator& nominal,
                             double tilt,
                             double current,
                             NoiseSource& noise) {
  PlannedDwell dwell;
  dwell.validation = true;
  dwell.joint_position = randomPose(tilt, noise);
  const std::size_t coils = nominal.coils.size();
  Eigen::VectorXd pattern = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coils));
  for (std::size_t excited = 0; excited < std::min(kValidationCoils, coils);) {
    const auto coil = static_cast<Eigen::Index>(noise.index(coils));
    if (pattern[coil] == 0.0) {
      pattern[coil] = noise.share() < 0.5 ? -current : current;
      ++excited;
    }
  }
  dwell.patterns.push_back(pattern);
  return dwell;
}

}  // namespace

void validate(const SessionPlanOptions& options, const Actuator& nominal) {
  const ValueRange share = ValueRange{0.0, 1.0, "of the tilt limit", true, false};
  requireInRange("tilt of joint poses", options.joint_tilt_share, share);
  requireInRange("tilt of torque poses", options.torque_tilt_share, share);
  requireInRange("current", options.current, ValueRange::positive("A"));
  if (!nominal.hasTorqueModel()) {
    return;
  }
  if (options.main_coil >= nominal.coils.size()) {
    throw ConfigError("main coil: " + std::to_string(numberOf(options.main_coil)) +
                      " is not one of the coils 1 to " + std::to_string(nominal.coils.size()) +
                      ".");
  }
  if (options.coils_per_dwell == 0) {
    throw ConfigError("coils per dwell: at least 1 is needed.");
  }
}

SessionPlan planSession(const Actuator& nominal,
                        const SessionPlanOptions& options,
                        std::uint64_t seed) {
  validate(options, nominal);
  NoiseSource noise(seed, RandomPurpose::kSessionPlan);
  const double joint_tilt = options.joint_tilt_share * nominal.workspace.tilt_limit;
  const double torque_tilt = options.torque_tilt_share * nominal.workspace.tilt_limit;
  SessionPlan plan;
  for (std::size_t n = 0; nominal.has_joints && n < options.joint_poses; ++n) {
    PlannedDwell dwell;
    dwell.joint_position = randomPose(joint_tilt, noise);
    plan.dwells.push_back(dwell);
  }
  if (!nominal.hasTorqueModel()) {
    return plan;
  }
  const TorquePoseSampler sampler(nominal, torque_tilt);
  planMainCoil(sampler, nominal, options, noise, plan);
  planOtherCoils(sampler, nominal, options, noise, plan);
  for (std::size_t n = 0; n < options.validation_poses; ++n) {
    plan.dwells.push_back(validationDwell(nominal, joint_tilt, options.current, noise));
  }
  return plan;
}

void validate(const SessionPlan& plan, std::size_t coils) {
  if (plan.dwells.empty()) {
    throw ConfigError("The session plan holds no dwells.");
  }
  for (std::size_t d = 0; d < plan.dwells.size(); ++d) {
    const PlannedDwell& dwell = plan.dwells[d];
    const std::string name = "Dwell " + std::to_string(d + 1) + " of the session plan";
    if (!dwell.joint_position.allFinite()) {
      throw ConfigError(name + " has a joint position that is not finite.");
    }
    for (const Eigen::VectorXd& pattern : dwell.patterns) {
      if (static_cast<std::size_t>(pattern.size()) != coils || !pattern.allFinite()) {
        throw ConfigError(name + " needs a finite current for each of the " +
                          std::to_string(coils) + " coils.");
      }
    }
  }
}

}  // namespace sac
