#include "coil_order.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace sac {
namespace {

/// A motion in which channels reached other coils than is described.
class CoilOrderTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kCoils = 8;

  CoilOrderTest() {
    impulses_.coils = kCoils;
    impulses_.through.resize(kValues, kCoils * kCoils);
    for (Eigen::Index n = 0; n < impulses_.through.size(); ++n) {
      impulses_.through.data()[n] = normal_(generator_);
    }
    order_.coil.resize(kCoils);
    std::iota(order_.coil.begin(), order_.coil.end(), std::size_t{0});
    order_.sign.assign(kCoils, 1);
  }

  /// What is found, with a tenth of each value beside what the currents explain.
  CoilOrder found() {
    impulses_.momentum.resize(kValues);
    for (Eigen::Index n = 0; n < kValues; ++n) {
      impulses_.momentum[n] = 0.3 * normal_(generator_);
    }
    for (std::size_t channel = 0; channel < kCoils; ++channel) {
      impulses_.momentum += order_.sign[channel] * impulses_.at(channel, order_.coil[channel]);
    }
    return bestCoilOrder(impulses_);
  }

  static constexpr Eigen::Index kValues = 200;
  std::mt19937 generator_{5};
  std::normal_distribution<double> normal_;
  ChannelImpulses impulses_;
  CoilOrder order_;
};

TEST_F(CoilOrderTest, FindsWhatIsAsDescribed) {
  const CoilOrder result = found();
  EXPECT_EQ(result.mistakes(), 0U);
  EXPECT_EQ(result.coil, order_.coil);
  EXPECT_NEAR(leftAsDescribed(impulses_), result.left, 1e-12);
}

TEST_F(CoilOrderTest, FindsCirclesTurnsAndDeathsTogether) {
  order_.coil = {1, 4, 2, 7, 0, 5, 6, 3};
  order_.sign = {1, -1, 1, 1, 1, 0, -1, 1};
  const CoilOrder result = found();
  EXPECT_EQ(result.coil, order_.coil);
  EXPECT_EQ(result.sign, order_.sign);
  EXPECT_EQ(result.mistakes(), 8U);
  EXPECT_LT(result.left, 0.1 * leftAsDescribed(impulses_));
}

TEST_F(CoilOrderTest, CountsAShiftAsOneMistake) {
  std::rotate(order_.coil.begin(), order_.coil.begin() + 3, order_.coil.end());
  order_.sign[4] = -1;
  const CoilOrder result = found();
  EXPECT_EQ(result.coil, order_.coil);
  EXPECT_EQ(result.sign, order_.sign);
  EXPECT_EQ(result.steps(), 3U);
  EXPECT_EQ(result.mistakes(), 2U);
}

// Coils on opposite sides of a rotor turn it alike.
TEST_F(CoilOrderTest, TakesTheFewestMistakesWhereNothingTells) {
  for (const Eigen::Index channel : {0, 2}) {
    const Eigen::Index first = channel * static_cast<Eigen::Index>(kCoils);
    impulses_.through.col(first + 2) = impulses_.through.col(first);
  }
  order_.coil = {2, 3, 0, 1, 4, 5, 6, 7};
  const CoilOrder result = found();
  EXPECT_EQ(result.coil, (std::vector<std::size_t>{0, 3, 2, 1, 4, 5, 6, 7}));
}

}  // namespace
}  // namespace sac
