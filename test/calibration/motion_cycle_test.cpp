#include <algorithm>
#include <memory>
#include <numeric>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "support/moving_rotor.hpp"

namespace sac {
namespace {

bool isTold(const CycleReport& report, const std::string& name) {
  return std::any_of(
      report.estimates.begin(), report.estimates.end(), [&](const ParameterEstimate& one) {
        return one.name == name && one.observable;
      });
}

class MotionCycleTest : public ::testing::Test {
 protected:
  MotionCycleTest() {
    scenarios::Generator generator(3);
    moving_.truth = scenarios::perturbed(scenarios::paperNominal(), 0.02, 0.02, generator);
  }

  MovingRotor moving_;
  CalibrationSession session_{{scenarios::paperNominal()}, {}, CalibrationConfig{}};
};

// As in a running laboratory, where dwells and motion are calibrated by one session.
TEST_F(MotionCycleTest, NeedsNoModelOfWhatOnlyMotionTells) {
  session_.setMotion(std::make_shared<const MotionRecording>(moving_.record()));
  const ParameterSpace& space = session_.model().space();
  ASSERT_EQ(space.size(), space.effect());
  const CycleReport report = session_.run({Cycle::kMotion});
  ASSERT_TRUE(report.success) << report.message;
  const CalibrationState& state = session_.state();
  ASSERT_EQ(state.belief.x.size(), space.size());
  const Eigen::VectorXd apart = state.belief.x - space.coordinatesOf(moving_.truth);
  EXPECT_LT(apart.cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_EQ(std::count(state.identified.begin(), state.identified.end(), true), space.size());
  EXPECT_LT(state.belief.covariance.diagonal().maxCoeff(), 1e-6);
  EXPECT_TRUE(isTold(report, "rotor_inertia/xx"));
  EXPECT_TRUE(isTold(report, "tracker_delay"));
  EXPECT_NEAR(session_.expectedErrors().orientation, report.orientation_uncertainty, 1e-15);
  EXPECT_NEAR(session_.expectedErrors().torque, report.torque_uncertainty, 1e-15);
}

TEST_F(MotionCycleTest, KeepsInertiaFrictionAndUnbalanceInTheDescription) {
  moving_.rotor.inertia(0, 0) *= 1.1;
  moving_.rotor.inertia(0, 1) = moving_.rotor.inertia(1, 0) = 2e-5;
  moving_.rotor.unbalance = Eigen::Vector3d(1e-3, -5e-4, 2e-3);
  session_.setMotion(std::make_shared<const MotionRecording>(moving_.record()));
  ASSERT_TRUE(session_.run({Cycle::kMotion}).success);
  CalibrationOrigin origin;
  origin.date = "2026-01-31T12:00:00Z";
  origin.software = "0.2.0";
  const CalibratedDescription kept = session_.description(origin);
  ASSERT_TRUE(kept.actuator.inertia && kept.actuator.friction);
  EXPECT_LT((*kept.actuator.inertia - moving_.rotor.inertia).cwiseAbs().maxCoeff(), 2e-6);
  EXPECT_LT((kept.actuator.unbalance - moving_.rotor.unbalance).cwiseAbs().maxCoeff(), 4e-5);
  EXPECT_NEAR(kept.actuator.friction->viscous, 0.0, 1e-4);
  ASSERT_TRUE(kept.stddevs.unbalance);
  EXPECT_GT(kept.stddevs.unbalance->minCoeff(), 0.0);
  EXPECT_LT(kept.stddevs.unbalance->maxCoeff(), 2e-5);
  // The same is in force.
  EXPECT_EQ(session_.actuator().unbalance, kept.actuator.unbalance);
  EXPECT_EQ(session_.stddevs().unbalance, kept.stddevs.unbalance);
  // Who calibrates on from there keeps them.
  const CalibratedDescription read = parseDescription(renderDescription(kept, "kept"), "kept");
  const CalibrationSession next(read, {}, CalibrationConfig{});
  const Actuator again = next.description({}).actuator;
  EXPECT_TRUE(again.inertia->isApprox(*kept.actuator.inertia, 1e-12));
  EXPECT_NEAR(again.friction->coulomb, kept.actuator.friction->coulomb, 1e-12);
  ASSERT_TRUE(next.stddevs().unbalance);
  EXPECT_TRUE(next.stddevs().unbalance->isApprox(*kept.stddevs.unbalance, 1e-6));
}

/// With the currents of some coils the other way round.
MotionRecording turned(MotionRecording recording, const std::vector<Eigen::Index>& coils) {
  for (MotionStreams& streams : recording.spans) {
    for (const Eigen::Index coil : coils) {
      streams.currents.matrix().col(coil) *= -1.0F;
    }
  }
  return recording;
}

// Momentum tells the ratio of strength and inertia: both negative fit as well.
TEST_F(MotionCycleTest, RefusesAnInertiaOrAStrengthBelowZero) {
  std::vector<Eigen::Index> all(24);
  std::iota(all.begin(), all.end(), 0);
  session_.setMotion(std::make_shared<const MotionRecording>(turned(moving_.record(), all)));
  const CycleReport report = session_.run({Cycle::kMotion});
  EXPECT_FALSE(report.success);
  EXPECT_NE(report.message.find("check the signs of currents"), std::string::npos)
      << report.message;
  CalibrationConfig config;
  config.effects["coil_gains"] = true;
  CalibrationSession with_gains({scenarios::paperNominal()}, {}, config);
  with_gains.setMotion(std::make_shared<const MotionRecording>(turned(moving_.record(), {4})));
  const CycleReport other = with_gains.run({Cycle::kMotion});
  EXPECT_FALSE(other.success);
  EXPECT_NE(other.message.find("coil_5/gain"), std::string::npos) << other.message;
}

// Windows in which a coil that is too strong counts most look as if a hand had touched the rotor.
TEST_F(MotionCycleTest, DoubtsWhatManyWindowsContradict) {
  moving_.duration = 12.0;
  MotionRecording recording = noisy(moving_.record());
  for (MotionStreams& streams : recording.spans) {
    streams.currents.matrix().col(4) *= 1.01F;
  }
  session_.setMotion(std::make_shared<const MotionRecording>(std::move(recording)));
  const CycleReport report = session_.run({Cycle::kMotion});
  ASSERT_TRUE(report.success) << report.message;
  ASSERT_FALSE(report.doubts.empty()) << report.message;
  // What names the coil comes before what may follow from it.
  ASSERT_GE(report.doubts.size(), 2U) << report.message;
  EXPECT_NE(report.doubts[0].find("coil 5 by -1"), std::string::npos) << report.doubts[0];
  EXPECT_NE(report.doubts[1].find("windows, at "), std::string::npos) << report.doubts[1];
}

bool isDoubted(const CycleReport& report, const std::string& begin) {
  return std::any_of(report.doubts.begin(), report.doubts.end(), [&](const std::string& doubt) {
    return doubt.rfind(begin, 0) == 0;
  });
}

TEST_F(MotionCycleTest, DoubtsSetpointsInPlaceOfMeasuredCurrents) {
  MotionRecording recording = noisy(moving_.record());
  StreamCurrents& currents = recording.spans.front().currents;
  for (Eigen::Index n = 0; n < currents.rows(); ++n) {
    currents.row(n) = Eigen::RowVectorXf(currents.row(n - n % 3));
  }
  session_.setMotion(std::make_shared<const MotionRecording>(std::move(recording)));
  const CycleReport report = session_.run({Cycle::kMotion});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_TRUE(isDoubted(report, "67 % of the currents repeat")) << report.message;
}

// Either part fits as well without the other one.
TEST_F(MotionCycleTest, DoubtsCurrentsWhoseClockJumps) {
  moving_.duration = 15.0;
  MotionRecording recording = noisy(moving_.record());
  LongSeries<Stamp>& stamps = recording.spans.front().current_stamps;
  for (std::size_t n = 0; n < stamps.size(); ++n) {
    stamps[n] += n < stamps.size() * 3 / 5 ? 0 : 3'000'000;
  }
  session_.setMotion(std::make_shared<const MotionRecording>(std::move(recording)));
  const CycleReport report = session_.run({Cycle::kMotion});
  ASSERT_TRUE(report.success) << report.message;
  ASSERT_FALSE(report.doubts.empty()) << report.message;
  EXPECT_NE(report.doubts[0].find("check the clock"), std::string::npos) << report.doubts[0];
}

/// With the third joint read a step of 1 ms later than the others.
MotionRecording skewed(MotionRecording recording) {
  for (MotionStreams& streams : recording.spans) {
    for (std::size_t n = 0; n + 1 < streams.joints.size(); ++n) {
      streams.joints[n][2] = streams.joints[n + 1][2];
    }
  }
  return recording;
}

TEST_F(MotionCycleTest, SaysThatJointsAreNotReadAtOnceWhereThatDoesNotFit) {
  session_.setMotion(std::make_shared<const MotionRecording>(skewed(moving_.record())));
  const CycleReport report = session_.run({Cycle::kMotion});
  EXPECT_FALSE(report.success);
  EXPECT_TRUE(std::regex_search(report.message,
                                std::regex("does not fit the model. The motion fits better with "
                                           "joints that are not read at once: joint 2 by "
                                           "-?0[.]00.*joint 3 by (1[.]0[01]|0[.]99)")))
      << report.message;
}

TEST_F(MotionCycleTest, DoubtsATrackerWhoseClockJumps) {
  moving_.duration = 15.0;
  for (const Stamp jump : {0, 200'000}) {
    MotionRecording recording = noisy(moving_.record());
    LongSeries<Stamp>& stamps = recording.spans.front().orientation_stamps;
    for (std::size_t n = stamps.size() / 2; n < stamps.size(); ++n) {
      stamps[n] += jump;
    }
    session_.setMotion(std::make_shared<const MotionRecording>(std::move(recording)));
    const CycleReport report = session_.run({Cycle::kMotion});
    ASSERT_TRUE(report.success) << report.message;
    EXPECT_EQ(isDoubted(report, "Orientations, in the mean"), jump > 0)
        << report.motion->orientation_chi_square;
  }
}

// Neighbouring orientations are compared with the same few readings, whose noise they share.
TEST_F(MotionCycleTest, DoubtsNoTrackerForCoarseJoints) {
  constexpr double kCoarse = 6e-4;  // [rad]
  constexpr std::size_t kSeldom = 5;
  moving_.duration = 15.0;
  MotionRecording recording = noisy(moving_.record(), kCoarse);
  MotionStreams& streams = recording.spans.front();
  const std::size_t count = streams.joints.size() / kSeldom;
  for (std::size_t n = 0; n < count; ++n) {
    streams.joints[n] = streams.joints[kSeldom * n];
    streams.joint_stamps[n] = streams.joint_stamps[kSeldom * n];
  }
  streams.joints.truncate(count);
  streams.joint_stamps.truncate(count);
  session_.setMotion(std::make_shared<const MotionRecording>(std::move(recording)));
  const CycleReport report = session_.run({Cycle::kMotion});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_FALSE(isDoubted(report, "Orientations, in the mean")) << report.message;
}

TEST_F(MotionCycleTest, DoubtsATrackerWhoseMarkerSlips) {
  moving_.duration = 15.0;
  MotionRecording recording = noisy(moving_.record());
  LongSeries<Eigen::Quaterniond>& orientations = recording.spans.front().orientations;
  const Eigen::Quaterniond slip(rotationExp({0.0, 2e-4, 2e-4}));
  for (std::size_t n = orientations.size() / 2; n < orientations.size(); ++n) {
    orientations[n] = orientations[n] * slip;
  }
  session_.setMotion(std::make_shared<const MotionRecording>(std::move(recording)));
  const CycleReport report = session_.run({Cycle::kMotion});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_TRUE(isDoubted(report, "Orientations, in the mean")) << report.message;
}

// Two parts in a thousand: all windows fit, and axes are off by more than their intervals.
TEST_F(MotionCycleTest, DoubtsCoilsOrPolesOfUnevenStrength) {
  moving_.duration = 12.0;
  moving_.rotor.inertia *= 1.1;
  const Actuator made = moving_.truth;
  const std::string words = "The motion fits better where ";
  const auto report_of = [&] {
    session_.setMotion(std::make_shared<const MotionRecording>(noisy(moving_.record())));
    const CycleReport report = session_.run({Cycle::kMotion});
    EXPECT_TRUE(report.success) << report.message;
    return report;
  };
  EXPECT_FALSE(isDoubted(report_of(), words));
  for (const std::size_t coil : {0U, 4U}) {
    moving_.truth = made;
    moving_.truth.coils[coil].gain = 1.002;
    const CycleReport report = report_of();
    EXPECT_TRUE(isDoubted(
        report, words + "coils differ in strength, coil " + std::to_string(coil + 1) + " by 0."))
        << report.message;
  }
  moving_.truth = made;
  moving_.truth.poles[2].gain = 0.998;
  const CycleReport report = report_of();
  EXPECT_TRUE(isDoubted(report, words + "poles differ in strength, pole 3 by -0.2"))
      << report.message;
}

// The amplifier is off, and what is read is the noise of its sensor.
TEST_F(MotionCycleTest, HoldsACoilThroughWhichNothingFlowed) {
  constexpr std::size_t kDead = 4;
  moving_.duration = 12.0;
  moving_.truth.coils[kDead].gain = 0.0;
  MotionRecording recording = moving_.record();
  for (MotionStreams& streams : recording.spans) {
    streams.currents.matrix().col(kDead).setZero();
  }
  session_.setMotion(std::make_shared<const MotionRecording>(noisy(std::move(recording))));
  const CycleReport report = session_.run({Cycle::kMotion});
  ASSERT_TRUE(report.success) << report.message;
  EXPECT_FALSE(isTold(report, "coil_5/polar"));
  EXPECT_FALSE(isTold(report, "coil_5/azimuth"));
  EXPECT_TRUE(isTold(report, "coil_6/azimuth"));
  EXPECT_NE(report.message.find("flowed in coil 5:"), std::string::npos) << report.message;
}

// No window tells it, and there are too few without it.
TEST_F(MotionCycleTest, DoubtsAMotionInWhichAHandLeansMostOfTheTime) {
  moving_.duration = 20.0;
  moving_.push_begin = 3.0;
  moving_.push_end = 15.0;
  for (const double push : {0.0, 2e-4}) {
    moving_.push = push;
    session_.setMotion(std::make_shared<const MotionRecording>(noisy(moving_.record())));
    const CycleReport report = session_.run({Cycle::kMotion});
    ASSERT_TRUE(report.success) << report.message;
    EXPECT_EQ(isDoubted(report, "Residuals are "), push > 0.0) << report.motion->window_chi_square;
  }
}

TEST_F(MotionCycleTest, SaysWhyTooFewWindowsServe) {
  MotionRecording recording = moving_.record();
  for (MotionStreams& streams : recording.spans) {
    std::fill(streams.joints.begin(), streams.joints.end(), streams.joints.front());
  }
  session_.setMotion(std::make_shared<const MotionRecording>(std::move(recording)));
  const CycleReport report = session_.run({Cycle::kMotion});
  EXPECT_FALSE(report.success);
  EXPECT_NE(report.message.find("0 windows of 23 (23: the rotor rests) are too few"),
            std::string::npos)
      << report.message;
}

TEST_F(MotionCycleTest, WithoutMotionChangesNothing) {
  const CycleReport report = session_.run({Cycle::kMotion});
  EXPECT_FALSE(report.success);
  EXPECT_NE(report.message.find("No motion is recorded"), std::string::npos) << report.message;
  EXPECT_TRUE(session_.state().belief.x.isZero(0.0));
}

}  // namespace
}  // namespace sac
