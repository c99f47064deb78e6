#include "spherical_actuator_calibration/assessment/covariance_file.hpp"

#include <cmath>

#include <yaml-cpp/yaml.h>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/assessment/reported_covariance.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

CalibrationSession sessionRefinedAfterJoint() {
  scenarios::Generator generator(4);
  CalibrationSession session(
      {scenarios::paperNominal()},
      scenarios::paperSession(scenarios::paperTruth(), scenarios::Tracker::kEveryPose, generator),
      CalibrationConfig{});
  session.run({Cycle::kJoint});
  session.run({Cycle::kRefine});
  return session;
}

TEST(CovarianceFile, HasTheStandardDeviationsOfTheParametersOnItsDiagonal) {
  const CalibrationSession session = sessionRefinedAfterJoint();
  const YAML::Node file = YAML::Load(renderCovariance(session))["covariance"];
  const std::vector<ParameterEstimate> parameters = session.parameters();
  ASSERT_EQ(file["names"].size(), parameters.size());
  ASSERT_EQ(file["matrix"].size(), parameters.size());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    EXPECT_EQ(file["names"][p].as<std::string>(), parameters[p].name);
    EXPECT_EQ(file["units"][p].as<std::string>(), parameters[p].unit);
    EXPECT_EQ(file["values"][p].as<double>(), parameters[p].value);
    ASSERT_EQ(file["matrix"][p].size(), parameters.size());
    EXPECT_NEAR(std::sqrt(file["matrix"][p][p].as<double>()) / parameters[p].stddev, 1.0, 1e-6)
        << parameters[p].name;
    for (std::size_t q = 0; q < p; ++q) {
      EXPECT_NEAR(file["matrix"][p][q].as<double>(), file["matrix"][q][p].as<double>(), 1e-15);
    }
  }
  EXPECT_GT(file["degrees_of_freedom"].as<int>(), 100);
  EXPECT_NEAR(file["coverage_factor"].as<double>(), 1.96, 0.02);
}

TEST(CovarianceFile, KnowsThatPolesAndCoilsErrTogether) {
  const CalibrationSession session = sessionRefinedAfterJoint();
  const Eigen::MatrixXd covariance = reportedCovariance(session);
  const Eigen::VectorXd stddevs = covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation =
      stddevs.cwiseInverse().asDiagonal() * covariance * stddevs.cwiseInverse().asDiagonal();
  Eigen::MatrixXd others = correlation;
  others.diagonal().setZero();
  EXPECT_GT(others.cwiseAbs().maxCoeff(), 0.3);
  EXPECT_LT(others.cwiseAbs().maxCoeff(), 1.0);
}

}  // namespace
}  // namespace sac
