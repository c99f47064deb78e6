#include "spherical_actuator_calibration/study/torque_matrix_error.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

class TorqueMatrixErrorTest : public ::testing::Test {
 protected:
  TorqueMatrixErrorTest() {
    scenarios::Generator generator(1);
    poses_ = scenarios::randomPoses(200, 0.3, generator);
  }

  double mean(const Actuator& model) const {
    double sum = 0.0;
    for (const TorqueMatrixError& pose :
         torqueMatrixErrors(scenarios::paperTruth(), model, poses_)) {
      sum += pose.error / static_cast<double>(poses_.size());
    }
    return sum;
  }

  std::vector<Eigen::Vector3d> poses_;
};

TEST_F(TorqueMatrixErrorTest, TrueParametersMissNothing) {
  EXPECT_LT(mean(scenarios::paperTruth()), 1e-12);
}

TEST_F(TorqueMatrixErrorTest, EachLevelTakesItsPart) {
  EXPECT_NEAR(mean(scenarios::paperNominal()), 0.42, 0.06);
  Actuator level_one = scenarios::paperNominal();
  level_one.joints = scenarios::paperTruth().joints;
  EXPECT_NEAR(mean(level_one), 0.14, 0.02);
}

TEST_F(TorqueMatrixErrorTest, TellsHowWellTheCoilsServe) {
  const Eigen::Vector3d upright(0.0, 0.0, 0.0);
  const Eigen::Vector3d tilted(1.0, 0.0, 0.0);
  const auto errors =
      torqueMatrixErrors(scenarios::paperNominal(), scenarios::paperNominal(), {upright, tilted});
  EXPECT_GT(errors[0].smallest_singular_value, 0.1);
  EXPECT_LT(errors[0].condition_number, 5.0);
  EXPECT_GT(errors[1].condition_number, 20.0);
}

TEST_F(TorqueMatrixErrorTest, NeedsTorqueModels) {
  Actuator joint_only = scenarios::paperNominal();
  joint_only.coils.clear();
  EXPECT_THROW(torqueMatrixErrors(joint_only, scenarios::paperNominal(), poses_), ConfigError);
  EXPECT_THROW(torqueMatrixErrors(scenarios::paperNominal(), joint_only, poses_), ConfigError);
}

}  // namespace
}  // namespace sac
