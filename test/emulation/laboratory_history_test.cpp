#include "spherical_actuator_calibration/emulation/laboratory_history.hpp"

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"

namespace sac {
namespace {

LaboratoryMoment momentAt(double time) {
  return {Eigen::Vector3d(time, -2.0 * time, 0.0), Eigen::VectorXd::Constant(2, 3.0 * time)};
}

TEST(LaboratoryHistory, TellsWhatWasBetweenTwoMoments) {
  LaboratoryHistory history(0.1);
  for (const double time : {1.0, 1.001, 1.003}) {
    history.add(time, momentAt(time));
  }
  const LaboratoryMoment moment = history.at(1.0018);
  EXPECT_NEAR(moment.position.x(), 1.0018, 1e-12);
  EXPECT_NEAR(moment.currents[1], 3.0 * 1.0018, 1e-12);
  EXPECT_EQ(history.at(0.5).position.x(), 1.0);
  EXPECT_EQ(history.at(2.0).position.x(), 1.003);
}

TEST(LaboratoryHistory, ForgetsNothingWithinItsSpan) {
  constexpr double kSpan = 0.05;
  LaboratoryHistory history(kSpan);
  for (int n = 0; n <= 1000; ++n) {
    const double time = 1e-3 * n;
    history.add(time, momentAt(time));
    if (time > kSpan) {
      EXPECT_NEAR(history.at(time - kSpan).position.x(), time - kSpan, 1e-12);
    }
  }
  // What is far older is gone: the oldest that is left stands for it.
  EXPECT_GT(history.at(0.5).position.x(), 0.9);
}

TEST(LaboratoryHistory, TheSameTimeAgainReplacesTheMoment) {
  LaboratoryHistory history(0.0);
  history.add(1.0, momentAt(1.0));
  history.add(1.0, momentAt(2.0));
  EXPECT_EQ(history.at(1.0).position.x(), 2.0);
}

TEST(LaboratoryHistory, NamesTheDelayThatCannotBe) {
  EXPECT_THROW(validate(StreamDelays{0.0, -1e-3, 0.0, 0.0}), ConfigError);
  EXPECT_THROW(validate(StreamDelays{0.0, 0.0, 0.6, 0.0}), ConfigError);
  EXPECT_EQ(longestDelay({0.01, 0.02, 0.05, 0.03}), 0.05);
}

}  // namespace
}  // namespace sac
