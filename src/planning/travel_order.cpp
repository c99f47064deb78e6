#include "travel_order.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace sac {
namespace {

/// Shorter by less than this is not shorter [rad].
constexpr double kLeastShortening = 1e-9;
/// A way that no change shortens need not be the shortest, so several first poses are tried: fewer
/// where there are many poses, because the time of one trial grows with their third power.
constexpr std::size_t kMostVisits = 300;

using Order = std::vector<std::size_t>;

/// Pose `first`, then from each pose to the nearest that is left.
Order nearestAfter(std::size_t first, const std::vector<Eigen::Vector3d>& poses) {
  Order order(poses.size());
  std::iota(order.begin(), order.end(), 0);
  std::swap(order.front(), order[first]);
  Eigen::Vector3d at = poses[first];
  for (auto next = order.begin() + 1; next != order.end(); ++next) {
    std::iter_swap(next, std::min_element(next, order.end(), [&](std::size_t a, std::size_t b) {
                     return moveLength(at, poses[a]) < moveLength(at, poses[b]);
                   }));
    at = poses[*next];
  }
  return order;
}

/// Takes the first change found that shortens the way; false when there is none.
bool shorten(const Eigen::Vector3d& start,
             const std::vector<Eigen::Vector3d>& poses,
             Order& order) {
  const double length = travelLength(start, poses, order);
  const auto improves = [&](const Order& changed) {
    return travelLength(start, poses, changed) < length - kLeastShortening;
  };
  const auto count = static_cast<std::ptrdiff_t>(order.size());
  for (std::ptrdiff_t first = 0; first < count; ++first) {
    for (std::ptrdiff_t last = first + 2; last <= count; ++last) {
      Order reversed = order;
      std::reverse(reversed.begin() + first, reversed.begin() + last);
      Order later = order;
      std::rotate(later.begin() + first, later.begin() + first + 1, later.begin() + last);
      Order earlier = order;
      std::rotate(earlier.begin() + first, earlier.begin() + last - 1, earlier.begin() + last);
      for (Order* changed : {&reversed, &later, &earlier}) {
        if (improves(*changed)) {
          order.swap(*changed);
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace

double moveLength(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return (to - from).cwiseAbs().maxCoeff();
}

double travelLength(const Eigen::Vector3d& start,
                    const std::vector<Eigen::Vector3d>& poses,
                    const std::vector<std::size_t>& order) {
  double length = 0.0;
  Eigen::Vector3d at = start;
  for (const std::size_t next : order) {
    length += moveLength(at, poses[next]);
    at = poses[next];
  }
  return length;
}

std::vector<std::size_t> travelOrder(const Eigen::Vector3d& start,
                                     const std::vector<Eigen::Vector3d>& poses) {
  Order shortest;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t trials = std::min(poses.size(), 1 + kMostVisits / (1 + poses.size()));
  for (std::size_t first = 0; first < trials; ++first) {
    Order order = nearestAfter(first, poses);
    // Each change shortens the way, and there are finitely many ways.
    while (shorten(start, poses, order)) {
    }
    const double length = travelLength(start, poses, order);
    if (length < least) {
      least = length;
      shortest = std::move(order);
    }
  }
  return shortest;
}

}  // namespace sac
