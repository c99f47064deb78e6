// A verdict that grows with its samples is that of all of them at once.
#include "spherical_actuator_calibration/calibration/held_out_judge.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "calibration/sensor_noise.hpp"
#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/measurement/sample_file.hpp"
#include "support/scenarios.hpp"
#include "support/source_dir.hpp"

namespace sac {
namespace {

constexpr double kRounding = 1e-9;
constexpr double kRateElsewhere = 3e-3;  // of outliers

class HeldOutJudgeTest : public ::testing::Test {
 protected:
  HeldOutJudgeTest() : session_({scenarios::paperNominal()}, sessionOf(5), {}) {
    EXPECT_TRUE(session_.run({Cycle::kRefine}).success);
  }

  /// Poses of four samples each, which share errors of their readings.
  static std::vector<Sample> sessionOf(std::uint64_t seed) {
    scenarios::Generator generator(seed);
    std::vector<Sample> samples =
        scenarios::paperSession(scenarios::paperTruth(), scenarios::Tracker::kEveryPose, generator);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      samples[n].id = static_cast<std::uint32_t>(n + 1);
      samples[n].torque += scenarios::uniformNoise(kTorqueNoise, generator);
      samples[n].joint_stddev.setConstant(2e-4);
      samples[n].joint_shared_stddev.setConstant(1.5e-4);
      samples[n].dwell = static_cast<Stamp>(1 + n / 4);
    }
    return samples;
  }

  /// Another session of the same unit, every third sample of it in use.
  static std::vector<Sample> furtherSamples() {
    std::vector<Sample> samples = sessionOf(6);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      samples[n].id += 1000;
      samples[n].dwell += 1000;
      samples[n].validation = n % 3 != 0;
    }
    return samples;
  }

  /// Judges samples one after the other, each time against a judge that sees all at once.
  HeldOutValidation expectTheSame(const std::vector<Sample>& further) const {
    HeldOutJudge growing = judge();
    std::vector<Sample> samples = session_.samples();
    HeldOutValidation last;
    for (const Sample& sample : further) {
      samples.push_back(sample);
      last = growing.judge(samples);
      const HeldOutValidation whole = judge().judge(samples);
      expectEqual(last, whole, "sample " + std::to_string(sample.id));
      if (sample.id % 2 == 0) {
        growing.settle();
      }
    }
    return last;
  }

  HeldOutJudge judge() const {
    return {session_.model(),
            session_.state(),
            session_.config().estimation,
            UsualOutliers{kRateElsewhere, {}}};
  }

  static void expectEqual(const HeldOutValidation& one,
                          const HeldOutValidation& other,
                          const std::string& at) {
    EXPECT_EQ(one.samples, other.samples) << at;
    EXPECT_EQ(one.orientations, other.orientations) << at;
    EXPECT_EQ(one.torques, other.torques) << at;
    EXPECT_EQ(one.unjudged_torques, other.unjudged_torques) << at;
    EXPECT_EQ(one.repeated, other.repeated) << at;
    EXPECT_EQ(one.outliers, other.outliers) << at;
    EXPECT_NEAR(one.orientation_rms, other.orientation_rms, kRounding) << at;
    EXPECT_NEAR(one.torque_rms, other.torque_rms, kRounding) << at;
    EXPECT_NEAR(one.reduced_chi_square,
                other.reduced_chi_square,
                kRounding * (1.0 + other.reduced_chi_square))
        << at;
    EXPECT_NEAR(one.probability, other.probability, kRounding) << at;
    ASSERT_EQ(one.groups.size(), other.groups.size()) << at;
    for (std::size_t n = 0; n < one.groups.size(); ++n) {
      EXPECT_NEAR(one.groups[n].chi_square, other.groups[n].chi_square, 1e-6) << at;
    }
    ASSERT_EQ(one.residuals.size(), other.residuals.size()) << at;
    for (std::size_t n = 0; n < one.residuals.size(); ++n) {
      EXPECT_EQ(one.residuals[n].id, other.residuals[n].id) << at;
      EXPECT_EQ(one.residuals[n].rejected, other.residuals[n].rejected) << at;
      EXPECT_EQ(one.residuals[n].reason, other.residuals[n].reason) << at;
    }
  }

  CalibrationSession session_;
};

TEST_F(HeldOutJudgeTest, TellsOfEachSampleWhatAllTellTogether) {
  const HeldOutValidation validation = expectTheSame(furtherSamples());
  EXPECT_GT(validation.orientations, 0U);
  EXPECT_GT(validation.torques, 0U);
  EXPECT_GT(validation.probability, kLeastProbability);
}

// With the noise of each, what the parameters leave open, and the errors that a dwell shares.
TEST_F(HeldOutJudgeTest, IsTheMahalanobisNormOfAllResiduals) {
  std::vector<Sample> samples = session_.samples();
  const std::vector<Sample> further = furtherSamples();
  samples.insert(samples.end(), further.begin(), further.end());
  EstimationProblem problem{&session_.model(), &samples, {}, {}, session_.state().belief};
  for (std::size_t n = session_.samples().size(); n < samples.size(); ++n) {
    if (samples[n].validation && samples[n].has_orientation) {
      problem.observations.push_back({n, Quantity::kOrientation});
    }
    if (samples[n].validation && samples[n].has_torque) {
      problem.observations.push_back({n, Quantity::kTorque});
    }
  }
  const EstimationOptions options;
  const ObservationEvaluator evaluator(problem, options);
  const auto count = static_cast<Eigen::Index>(problem.observations.size());
  const ModelPoint point = evaluator.at(problem.prior.x);
  Eigen::VectorXd r(3 * count);
  Eigen::MatrixXd J(3 * count, problem.prior.x.size());
  Eigen::MatrixXd shared(3 * count, kSharedErrors);
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(3 * count, 3 * count);
  LinearizedObservation linear;
  for (Eigen::Index n = 0; n < count; ++n) {
    const auto at = static_cast<std::size_t>(n);
    evaluator.linearize(at, point, linear);
    r.segment<3>(3 * n) = linear.residual;
    J.middleRows<3>(3 * n) = linear.jacobian;
    shared.middleRows<3>(3 * n) = evaluator.sharedErrors(at, linear);
    S.block<3, 3>(3 * n, 3 * n) = evaluator.ownNoise(at, linear);
    for (Eigen::Index k = 0; k <= n; ++k) {
      const auto other = static_cast<std::size_t>(k);
      if (samples[problem.observations[at].sample].dwell ==
          samples[problem.observations[other].sample].dwell) {
        const Eigen::Matrix3d both =
            shared.middleRows<3>(3 * n) * shared.middleRows<3>(3 * k).transpose();
        S.block<3, 3>(3 * n, 3 * k) += both;
        S.block<3, 3>(3 * k, 3 * n) +=
            k < n ? Eigen::Matrix3d(both.transpose()) : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
      }
    }
  }
  S += J * problem.prior.covariance * J.transpose();
  const HeldOutValidation validation = judge().judge(samples);
  ASSERT_EQ(validation.residuals.size(), problem.observations.size());
  ASSERT_EQ(validation.outliers, 0U);
  EXPECT_NEAR(
      validation.reduced_chi_square, r.dot(S.llt().solve(r)) / static_cast<double>(r.size()), 1e-6);
}

// Each group by itself: what the parameters leave open moves all of its misfits together.
TEST_F(HeldOutJudgeTest, JudgesEachCoilByItself) {
  std::vector<Sample> samples = session_.samples();
  const std::vector<Sample> further = furtherSamples();
  samples.insert(samples.end(), further.begin(), further.end());
  const HeldOutValidation validation = judge().judge(samples);
  ASSERT_GT(validation.groups.size(), 2U);
  std::size_t observations = 0;
  for (const HeldOutGroup& group : validation.groups) {
    EXPECT_LE(group.observations, kJudgedOfAGroup);
    EXPECT_GT(group.probability(), validation.leastOfAGroup()) << group.name;
    EXPECT_GT(group.sensitivity, 0.0) << group.name;
    observations += group.observations;
  }
  EXPECT_GT(observations, kJudgedOfAGroup);
  EXPECT_TRUE(validation.contradicting().empty());
}

// Among all misfits one coil of many does not show.
TEST_F(HeldOutJudgeTest, NamesTheCoilThatContradictsAmongMany) {
  std::vector<Sample> samples = session_.samples();
  constexpr std::size_t kCoil = 4;
  for (Sample sample : furtherSamples()) {
    const std::vector<Excitation> on = excitedCoils(sample, 0.05);
    if (sample.validation && on.size() == 1 && on.front().coil == kCoil) {
      sample.torque += Eigen::Vector3d::Constant(2.0 * kTorqueNoise);
    }
    samples.push_back(sample);
  }
  const HeldOutValidation validation = judge().judge(samples);
  const std::vector<HeldOutGroup> found = validation.contradicting();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().name, "coil 5");
  EXPECT_EQ(validation.outliers, 0U);
  EXPECT_LT(validation.probability, kLeastProbability);
  EXPECT_LT(validation.reduced_chi_square, 1.5);
  EXPECT_NE(verdict(validation).find("by coil 5 (chi-square"), std::string::npos);
}

// The first is set aside, until there are more of them than elsewhere.
TEST_F(HeldOutJudgeTest, TakesOutliersBackWhenTheyBecomeTooMany) {
  std::vector<Sample> samples = furtherSamples();
  constexpr std::size_t kFirst = 34;
  constexpr std::size_t kSecond = 61;
  for (const std::size_t n : {kFirst, kSecond, kSecond + 1, kSecond + 3, kSecond + 4}) {
    ASSERT_TRUE(samples[n].validation && samples[n].has_torque) << n;
    samples[n].torque.x() += 40.0 * kTorqueNoise;
  }
  samples.resize(kSecond);
  EXPECT_EQ(expectTheSame(samples).outliers, 1U);
  samples = furtherSamples();
  for (const std::size_t n : {kFirst, kSecond, kSecond + 1, kSecond + 3, kSecond + 4}) {
    samples[n].torque.x() += 40.0 * kTorqueNoise;
  }
  const HeldOutValidation validation = expectTheSame(samples);
  EXPECT_EQ(validation.outliers, 0U);
  EXPECT_LT(validation.probability, kLeastProbability);
}

// Whatever comes first, it is the held-out one that tells nothing.
TEST_F(HeldOutJudgeTest, LeavesOutWhatRepeatsASample) {
  std::vector<Sample> samples = furtherSamples();
  const auto repeat = [&samples](std::size_t n, std::size_t earlier) {
    samples[n].R_stator_rotor = samples[earlier].R_stator_rotor;
    samples[n].torque = samples[earlier].torque;
  };
  ASSERT_TRUE(samples[34].validation && samples[35].validation && !samples[42].validation);
  repeat(35, 34);
  repeat(42, 38);
  const HeldOutValidation validation = expectTheSame(samples);
  EXPECT_GE(validation.repeated, 2U);
}

TEST_F(HeldOutJudgeTest, SaysNothingWhereNoneIsHeldOut) {
  std::vector<Sample> samples = furtherSamples();
  for (Sample& sample : samples) {
    sample.validation = false;
  }
  const HeldOutValidation validation = expectTheSame(samples);
  EXPECT_EQ(validation.samples, 0U);
  EXPECT_FALSE(validation.hasVerdict());
}

// Trackers that are better than what the map leaves open, some more than others.
TEST(HeldOutJudge, TellsTheSameWithAnOrientationMap) {
  const std::string positioner = SOURCE_DIR "/config/examples/two_axis_positioner";
  std::vector<Sample> all = loadSamples(positioner + "/samples.yaml", 0);
  CalibrationConfig config;
  config.orientation_map = MapUse::kAlways;
  const std::vector<Sample> first(all.begin(), all.begin() + 60);
  CalibrationSession session({loadActuator(positioner + "/actuator.yaml")}, first, config);
  ASSERT_TRUE(session.run({Cycle::kJoint}).success);
  ASSERT_TRUE(session.orientationMap().map);
  HeldOutJudge growing = session.heldOutJudge();
  for (std::size_t n = first.size(); n < all.size(); ++n) {
    all[n].validation = n % 2 == 0;
    all[n].orientation_stddev *= n % 3 == 0 ? 0.3 : 0.8;
    session.add(all[n]);
    const double grown = growing.judge(session.samples()).reduced_chi_square;
    const std::optional<HeldOutValidation> whole = session.validation();
    EXPECT_NEAR(grown, whole ? whole->reduced_chi_square : 0.0, 1e-9) << n;
  }
  EXPECT_GT(session.validation()->reduced_chi_square, 0.1);
}

}  // namespace
}  // namespace sac
