#include "travel_order.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace sac {
namespace {

/// Length of the shortest way, by trying all.
double shortestLength(const Eigen::Vector3d& start, const std::vector<Eigen::Vector3d>& poses) {
  std::vector<std::size_t> order(poses.size());
  std::iota(order.begin(), order.end(), 0);
  double shortest = std::numeric_limits<double>::infinity();
  do {
    shortest = std::min(shortest, travelLength(start, poses, order));
  } while (std::next_permutation(order.begin(), order.end()));
  return shortest;
}

TEST(TravelOrder, MovesAsLongAsTheSlowestJoint) {
  EXPECT_DOUBLE_EQ(moveLength({0.1, -0.2, 1.0}, {0.2, 0.2, 0.7}), 0.4);
}

TEST(TravelOrder, VisitsEveryPoseOnce) {
  scenarios::Generator generator(1);
  const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(20, 0.3, generator);
  std::vector<std::size_t> order = travelOrder(Eigen::Vector3d::Zero(), poses);
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> all(poses.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}

TEST(TravelOrder, IsNearlyTheShortest) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    scenarios::Generator generator(seed);
    const std::vector<Eigen::Vector3d> poses = scenarios::randomPoses(8, 0.3, generator);
    const Eigen::Vector3d start(0.0, 0.0, 1.0);
    EXPECT_LE(travelLength(start, poses, travelOrder(start, poses)),
              1.05 * shortestLength(start, poses));
  }
}

TEST(TravelOrder, StaysWhereThereIsNothingToVisit) {
  EXPECT_TRUE(travelOrder(Eigen::Vector3d::Zero(), {}).empty());
}

}  // namespace
}  // namespace sac
