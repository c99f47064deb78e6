#include "spherical_actuator_calibration/measurement/carried_currents.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

constexpr double kThreshold = 0.05;  // [A]

TEST(CarriedCurrents, NameTheFirstCoilThatDoesNotCarryItsCommand) {
  const Eigen::Vector3d commanded(2.0, 0.0, -2.0);
  EXPECT_FALSE(coilAmiss(commanded, Eigen::Vector3d(1.85, 0.03, -2.0), kThreshold));
  EXPECT_EQ(coilAmiss(commanded, Eigen::Vector3d(2.0, 0.045, -2.0), kThreshold), 1U);
  EXPECT_EQ(coilAmiss(commanded, Eigen::Vector3d(2.0, 0.0, 2.0), kThreshold), 2U);
  EXPECT_EQ(coilAmiss(commanded, Eigen::Vector3d(0.3, 0.0, 2.0), kThreshold), 0U);
}

}  // namespace
}  // namespace sac
