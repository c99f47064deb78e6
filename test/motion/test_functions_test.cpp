#include "spherical_actuator_calibration/motion/test_functions.hpp"

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(TestFunctions, VanishWithTheirSlopeAtBothEnds) {
  const TestFunctions functions(1.0, 1.4, 6);
  TestFunctionValues values;
  for (const double time : {1.0, 1.4}) {
    functions.evaluate(time, values);
    EXPECT_LT(values.value.cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT(values.first.cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(TestFunctions, HaveTheDerivativesThatTheyTell) {
  constexpr double kStep = 1e-5;
  const TestFunctions functions(1.0, 1.4, 6);
  TestFunctionValues before;
  TestFunctionValues at;
  TestFunctionValues after;
  TestFunctionBends bends_before;
  TestFunctionBends bends;
  TestFunctionBends bends_after;
  for (const double time : {1.05, 1.17, 1.33}) {
    functions.evaluate(time - kStep, before);
    functions.evaluate(time, at);
    functions.evaluate(time + kStep, after);
    functions.evaluate(time - kStep, bends_before);
    functions.evaluate(time, bends);
    functions.evaluate(time + kStep, bends_after);
    EXPECT_LT(((after.value - before.value) / (2.0 * kStep) - at.first).norm(), 1e-6);
    EXPECT_LT(((after.first - before.first) / (2.0 * kStep) - bends.second).norm(), 1e-4);
    EXPECT_LT(((bends_after.second - bends_before.second) / (2.0 * kStep) - bends.third).norm(),
              1e-2);
  }
}

TEST(TestFunctions, KnowTheIntegralOfTheFirst) {
  const TestFunctions functions(-0.2, 0.3, 1);
  TestFunctionValues values;
  double sum = 0.0;
  constexpr int kSteps = 1000;
  for (int n = 0; n < kSteps; ++n) {
    functions.evaluate(-0.2 + 0.5 * (n + 0.5) / kSteps, values);
    sum += values.value[0] * 0.5 / kSteps;
  }
  EXPECT_NEAR(sum, functions.integralOfFirst(), 1e-6 * sum);
}

}  // namespace
}  // namespace sac
