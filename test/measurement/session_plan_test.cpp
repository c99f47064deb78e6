#include "spherical_actuator_calibration/measurement/session_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr std::uint64_t kSeed = 3;

/// Coil of a pattern that excites just one, counted from 0.
Eigen::Index onlyCoil(const Eigen::VectorXd& pattern) {
  EXPECT_EQ((pattern.array() != 0.0).count(), 1);
  Eigen::Index coil = 0;
  pattern.cwiseAbs().maxCoeff(&coil);
  return coil;
}

/// Angles [rad] between a coil and every pole.
std::vector<double> anglesToPoles(const Actuator& actuator,
                                  const Eigen::Vector3d& q,
                                  Eigen::Index coil) {
  const TorqueGeometry geometry = torqueGeometry(actuator);
  const Eigen::Vector3d coil_rotor =
      rotorOrientation(jointGeometry(actuator.joints), q).transpose() *
      geometry.coils_stator.col(coil);
  std::vector<double> angles;
  for (Eigen::Index pole = 0; pole < geometry.poles_rotor.cols(); ++pole) {
    angles.push_back(std::acos(geometry.poles_rotor.col(pole).dot(coil_rotor)));
  }
  return angles;
}

bool isInformative(double psi) {
  return psi >= 4.0 * kOneDegree && psi <= 24.0 * kOneDegree;
}

bool isUncertain(double psi) {
  return psi <= 3.0 * kOneDegree || (psi >= 26.1 * kOneDegree && psi <= 34.2 * kOneDegree);
}

TEST(SessionPlan, FollowsThePapersProtocol) {
  const SessionPlan plan = planSession(scenarios::paperNominal(), {}, kSeed);
  std::vector<int> poses_of_coil(24, 0);
  int joint_poses = 0;
  int validation_poses = 0;
  for (const PlannedDwell& dwell : plan.dwells) {
    if (dwell.validation) {
      ++validation_poses;
      ASSERT_EQ(dwell.patterns.size(), 1U);
      EXPECT_EQ((dwell.patterns[0].array().abs() == 2.0).count(), 3);
      continue;
    }
    joint_poses += dwell.patterns.empty() ? 1 : 0;
    EXPECT_LE(dwell.patterns.size(), 4U);
    for (const Eigen::VectorXd& pattern : dwell.patterns) {
      ++poses_of_coil[static_cast<std::size_t>(onlyCoil(pattern))];
      EXPECT_EQ(pattern.maxCoeff(), 2.0);
    }
  }
  EXPECT_EQ(joint_poses, 10);
  EXPECT_EQ(validation_poses, 5);
  EXPECT_EQ(poses_of_coil[0], 30);
  EXPECT_TRUE(
      std::all_of(poses_of_coil.begin() + 1, poses_of_coil.end(), [](int n) { return n == 4; }));
  EXPECT_NO_THROW(validate(plan, 24));
}

TEST(SessionPlan, MainCoilShowsEachPoleInTurn) {
  const Actuator actuator = scenarios::paperNominal();
  SessionPlanOptions options;
  options.joint_poses = 0;
  options.main_coil = 13;
  const SessionPlan plan = planSession(actuator, options, kSeed);
  for (std::size_t n = 0; n < 30; ++n) {
    ASSERT_EQ(onlyCoil(plan.dwells[n].patterns.at(0)), 13);
    const std::vector<double> angles = anglesToPoles(actuator, plan.dwells[n].joint_position, 13);
    EXPECT_TRUE(isInformative(angles[n % 8])) << "pose " << n;
    EXPECT_TRUE(std::none_of(angles.begin(), angles.end(), isUncertain)) << "pose " << n;
  }
}

TEST(SessionPlan, OtherCoilsStandWhereTheCurveIsSteepAndCertain) {
  const Actuator actuator = scenarios::paperNominal();
  for (const PlannedDwell& dwell : planSession(actuator, {}, kSeed).dwells) {
    for (const Eigen::VectorXd& pattern : dwell.patterns) {
      if (dwell.validation) {
        continue;
      }
      const std::vector<double> angles =
          anglesToPoles(actuator, dwell.joint_position, onlyCoil(pattern));
      EXPECT_TRUE(std::any_of(angles.begin(), angles.end(), isInformative));
      EXPECT_TRUE(std::none_of(angles.begin(), angles.end(), isUncertain));
    }
  }
}

TEST(SessionPlan, StaysWithinTheTilt) {
  const Actuator actuator = scenarios::paperNominal();
  SessionPlanOptions options;
  options.joint_tilt_share = 0.75;
  double largest_joint = 0.0;
  double largest_torque = 0.0;
  for (const PlannedDwell& dwell : planSession(actuator, options, kSeed).dwells) {
    const double tilt = dwell.joint_position.head<2>().cwiseAbs().maxCoeff();
    double& largest = dwell.patterns.empty() || dwell.validation ? largest_joint : largest_torque;
    largest = std::max(largest, tilt);
    EXPECT_LE(std::abs(dwell.joint_position[2]), kPi);
  }
  EXPECT_LE(largest_joint, 0.45);
  EXPECT_GT(largest_joint, 0.38);
  EXPECT_LE(largest_torque, 0.30);
  EXPECT_GT(largest_torque, 0.25);
}

TEST(SessionPlan, HasJointPosesOnlyWithoutTorqueModel) {
  Actuator actuator = scenarios::paperNominal();
  actuator.torque_curve.reset();
  const SessionPlan plan = planSession(actuator, {}, kSeed);
  EXPECT_EQ(plan.dwells.size(), 10U);
  EXPECT_TRUE(std::all_of(plan.dwells.begin(), plan.dwells.end(), [](const PlannedDwell& dwell) {
    return dwell.patterns.empty();
  }));
}

TEST(SessionPlan, TakesTheBestPoseWhereNoneIsGood) {
  // The coil on top of the stator is out of every pole's reach.
  Actuator actuator = scenarios::paperNominal();
  actuator.coils = {{0.5 * kPi, 0.0, 1.0}};
  SessionPlanOptions options;
  options.main_coil_poses = 2;
  EXPECT_EQ(planSession(actuator, options, kSeed).dwells.size(), 10U + 2U + 5U);
}

TEST(SessionPlan, DependsOnTheSeedAlone) {
  const Actuator actuator = scenarios::paperNominal();
  const SessionPlan plan = planSession(actuator, {}, kSeed);
  const SessionPlan same = planSession(actuator, {}, kSeed);
  const SessionPlan other = planSession(actuator, {}, kSeed + 1);
  ASSERT_EQ(plan.dwells.size(), same.dwells.size());
  for (std::size_t d = 0; d < plan.dwells.size(); ++d) {
    EXPECT_EQ(plan.dwells[d].joint_position, same.dwells[d].joint_position);
    EXPECT_EQ(plan.dwells[d].patterns, same.dwells[d].patterns);
  }
  EXPECT_NE(plan.dwells[0].joint_position, other.dwells[0].joint_position);
}

TEST(SessionPlan, RefusesOptionsThatCannotBe) {
  const Actuator actuator = scenarios::paperNominal();
  const auto refused = [&](void (*change)(SessionPlanOptions&)) {
    SessionPlanOptions options;
    change(options);
    EXPECT_THROW(planSession(actuator, options, kSeed), ConfigError);
  };
  refused([](SessionPlanOptions& options) { options.main_coil = 24; });
  refused([](SessionPlanOptions& options) { options.coils_per_dwell = 0; });
  refused([](SessionPlanOptions& options) { options.current = 0.0; });
  refused([](SessionPlanOptions& options) { options.joint_tilt_share = 1.01; });
  refused([](SessionPlanOptions& options) { options.torque_tilt_share = 0.0; });
}

TEST(SessionPlan, RefusesPlansThatCannotBeFollowed) {
  EXPECT_THROW(validate(SessionPlan{}, 2), ConfigError);
  SessionPlan plan;
  plan.dwells.push_back({Eigen::Vector3d::Zero(), {Eigen::Vector2d(1.0, 0.0)}});
  EXPECT_NO_THROW(validate(plan, 2));
  EXPECT_THROW(validate(plan, 3), ConfigError);
  plan.dwells[0].joint_position[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validate(plan, 2), ConfigError);
}

}  // namespace
}  // namespace sac
