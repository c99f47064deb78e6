#include "spherical_actuator_calibration/calibration/sample_coverage.hpp"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/pi.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

constexpr double kThreshold = 0.05;  // [A]

class SampleCoverageTest : public ::testing::Test {
 protected:
  SampleCoverage coverage(const std::vector<Sample>& samples) const {
    return sampleCoverage(
        model_, samples, Eigen::VectorXd::Zero(model_.space().size()), kThreshold);
  }

  /// Torque samples with one coil (from 0) excited, upright, at these spins.
  std::vector<Sample> atSpins(const std::vector<double>& spins, std::size_t coil) {
    std::vector<Eigen::Vector3d> poses;
    poses.reserve(spins.size());
    for (const double spin : spins) {
      poses.emplace_back(0.0, 0.0, spin);
    }
    return scenarios::torqueSamples(
        scenarios::paperNominal(), poses, coil, 2.0, 0.0, 1e-3, generator_);
  }

  const CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  scenarios::Generator generator_{1};
};

/// Coil 1 lies at azimuth 0, poles every 45 degrees, and one reaches no further than 32 degrees.
TEST_F(SampleCoverageTest, CountsPolesWithinReachOfTheExcitedCoil) {
  const SampleCoverage result = coverage(atSpins({0.0, 0.0, -kPi / 4.0}, 0));
  EXPECT_EQ(result.poles, (std::vector<std::uint32_t>{2, 1, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(result.coils[0], 3U);
  EXPECT_EQ(result.coils[1], 0U);
}

TEST_F(SampleCoverageTest, SmallCurrentsAndHeldOutSamplesDoNotCount) {
  std::vector<Sample> samples = atSpins({0.0, 0.0, 0.0}, 0);
  samples[0].validation = true;
  samples[1].current[0] = 0.5 * kThreshold;
  EXPECT_EQ(coverage(samples).poles[0], 1U);
  EXPECT_EQ(coverage(samples).coils[0], 1U);
}

TEST_F(SampleCoverageTest, APoleThatTwoCoilsReachCountsOnce) {
  std::vector<Sample> samples = atSpins({0.0}, 0);
  samples[0].current[12] = 2.0;  // below coil 1, in the other layer
  EXPECT_EQ(coverage(samples).poles[0], 1U);
  EXPECT_EQ(coverage(samples).coils[0], 1U);
  EXPECT_EQ(coverage(samples).coils[12], 1U);
}

TEST_F(SampleCoverageTest, TellsTheRangeOfEachJoint) {
  const SampleCoverage result = coverage(atSpins({0.5, -1.0, 0.25}, 0));
  EXPECT_EQ(result.joints[2].lowest, -1.0);
  EXPECT_EQ(result.joints[2].highest, 0.5);
  EXPECT_EQ(coverage({}).joints[2].highest, 0.0);
}

}  // namespace
}  // namespace sac
