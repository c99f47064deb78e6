#include "stream_noise.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/estimation/estimator.hpp"
#include "support/scenarios.hpp"

namespace sac {
namespace {

/// A session of the paper's protocol with the tracker at every pose.
class StreamNoiseTest : public ::testing::Test {
 protected:
  StreamNoiseTest() {
    scenarios::Generator generator(6);
    const Actuator truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
    samples_ = scenarios::paperSession(truth, scenarios::Tracker::kEveryPose, generator);
  }

  /// Readings of a pose are wrong for its orientation and its torque alike.
  void disturbReadings(double stddev, double stated) {
    std::mt19937 generator(7);
    std::normal_distribution<double> noise(0.0, stddev);
    for (Sample& sample : samples_) {
      sample.joint_position += Eigen::Vector3d::NullaryExpr([&] { return noise(generator); });
      sample.joint_stddev.setConstant(stated);
    }
  }

  std::vector<StreamNoise> streams() {
    const Eigen::Index size = model_.space().size();
    EstimationProblem problem;
    problem.model = &model_;
    problem.samples = &samples_;
    for (std::size_t n = 0; n < samples_.size(); ++n) {
      for (const Quantity quantity : {Quantity::kOrientation, Quantity::kTorque}) {
        const bool is_orientation = quantity == Quantity::kOrientation;
        if (is_orientation ? samples_[n].has_orientation : samples_[n].has_torque) {
          problem.observations.push_back({n, quantity});
        }
      }
    }
    problem.prior = {Eigen::VectorXd::Zero(size), 9e-4 * Eigen::MatrixXd::Identity(size, size)};
    problem.free.resize(static_cast<std::size_t>(size));
    std::iota(problem.free.begin(), problem.free.end(), 0);
    estimate_ = estimate(problem, options_);
    EXPECT_EQ(estimate_.termination, Termination::kConverged);
    return streamNoise(problem, estimate_, options_);
  }

  /// Together the streams are all that the estimate weighed.
  void expectWhole(const std::vector<StreamNoise>& streams) const {
    double squares = 0.0;
    double freedom = 0.0;
    for (const StreamNoise& stream : streams) {
      squares += stream.squares;
      freedom += stream.freedom;
    }
    EXPECT_NEAR(freedom, estimate_.degrees_of_freedom, 0.01);
    EXPECT_NEAR(squares, estimate_.reduced_chi_square * estimate_.degrees_of_freedom, 1e-6);
  }

  CalibrationModel model_{ParameterSpace(scenarios::paperNominal())};
  std::vector<Sample> samples_;
  EstimationOptions options_;
  Estimate estimate_;
};

TEST_F(StreamNoiseTest, SharesOutMisfitAndFreedom) {
  const std::vector<StreamNoise> streams = this->streams();
  expectWhole(streams);
  EXPECT_TRUE(noiseInWords(streams, false).empty());
}

TEST_F(StreamNoiseTest, SharesThemOutWhereDwellsShareReadings) {
  disturbReadings(1e-3, 1e-3);
  const std::vector<StreamNoise> streams = this->streams();
  expectWhole(streams);
  EXPECT_GT(streams.at(2).freedom, 100.0);
  EXPECT_TRUE(noiseInWords(streams, false).empty());
}

TEST_F(StreamNoiseTest, NamesTheSensorThatScattersMore) {
  for (Sample& sample : samples_) {
    sample.torque_stddev /= 2.0;
  }
  const std::vector<std::string> words = noiseInWords(streams(), false);
  ASSERT_EQ(words.size(), 1U);
  EXPECT_EQ(words.front().rfind("The torques scatter by 2", 0), 0U) << words.front();
}

TEST_F(StreamNoiseTest, NamesReadingsThatScatterMore) {
  disturbReadings(2e-3, 1e-3);
  const std::vector<std::string> words = noiseInWords(streams(), false);
  ASSERT_FALSE(words.empty());
  EXPECT_TRUE(std::any_of(words.begin(), words.end(), [](const std::string& sentence) {
    return sentence.rfind("The readings of the joints scatter by ", 0) == 0;
  })) << words.front();
}

TEST_F(StreamNoiseTest, NamesTheSensorThatScattersLess) {
  for (Sample& sample : samples_) {
    sample.orientation_stddev *= 3.0;
  }
  const std::vector<std::string> words = noiseInWords(streams(), false);
  ASSERT_EQ(words.size(), 1U);
  EXPECT_EQ(words.front().rfind("The orientations scatter by only 0.3", 0), 0U) << words.front();
}

TEST(StreamNoise, LittleBesideAMapTellsNothing) {
  const std::vector<StreamNoise> little = {{"orientations", 10.0, 300.0}};
  EXPECT_EQ(noiseInWords(little, false).size(), 1U);
  EXPECT_TRUE(noiseInWords(little, true).empty());
  const std::vector<StreamNoise> much = {{"orientations", 900.0, 300.0}};
  EXPECT_EQ(noiseInWords(much, true).size(), 1U);
}

}  // namespace
}  // namespace sac
