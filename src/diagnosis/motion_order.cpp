#include "motion_order.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "coil_order.hpp"
#include "spherical_actuator_calibration/motion/motion_excerpt.hpp"
#include "torque_hypotheses.hpp"
#include "wiring_problem.hpp"

namespace sac {
namespace {

/// By how many steps all channels are shifted; 0: they are not.
std::size_t shiftOf(const CoilOrder& order) {
  const std::size_t coils = order.coil.size();
  const std::size_t steps = order.coil.front();
  for (std::size_t channel = 0; channel < coils; ++channel) {
    if (order.coil[channel] != (channel + steps) % coils) {
      return 0;
    }
  }
  return steps;
}

/// What brings each current to its coil: exchanges of two, and circles of more.
void addCircles(const CoilOrder& order, Candidate& candidate) {
  std::vector<bool> is_seen(order.coil.size(), false);
  for (std::size_t channel = 0; channel < order.coil.size(); ++channel) {
    std::vector<std::size_t> circle;
    for (std::size_t next = channel; !is_seen[next]; next = order.coil[next]) {
      is_seen[next] = true;
      circle.push_back(next);
    }
    if (circle.size() == 2) {
      candidate.push_back(coilSwap(circle[0], circle[1]));
    } else if (circle.size() > 2) {
      candidate.push_back(coilCircle(circle));
    }
  }
}

Candidate mistakesOf(const CoilOrder& order) {
  Candidate candidate;
  const std::size_t steps = shiftOf(order);
  if (steps > 0 && order.coil.size() > 2) {
    candidate.push_back(coilShift(steps));
  } else {
    addCircles(order, candidate);
  }
  const bool all_turned =
      std::all_of(order.sign.begin(), order.sign.end(), [](int sign) { return sign < 0; });
  if (all_turned) {
    candidate.push_back(currentSign());
    return candidate;
  }
  for (std::size_t channel = 0; channel < order.coil.size(); ++channel) {
    if (order.sign[channel] != 1) {
      const std::size_t coil = order.coil[channel];
      candidate.push_back(order.sign[channel] < 0 ? coilSign(coil) : coilDead(coil));
    }
  }
  return candidate;
}

}  // namespace

std::optional<SuspectedWiring> suspectedOrder(const CalibrationSession& session) {
  constexpr double kExcerpt = 30.0;  // [s]
  constexpr double kGrid = 0.01;     // [s]
  constexpr int kReach = 6;
  // A single coil is a fifth of what is left as described, at least.
  constexpr double kMostLeft = 0.75;
  const MotionRecording excerpt = motionExcerpt(*session.motion(), kExcerpt);
  const WiringProblem problem(session.start().actuator, excerpt, session.config());
  std::optional<CoilOrder> best;
  double described = std::numeric_limits<double>::infinity();
  for (int n = -kReach; n <= kReach; ++n) {
    const ChannelImpulses impulses = channelImpulses(problem.get(), kGrid * n);
    if (impulses.momentum.size() == 0) {
      return std::nullopt;
    }
    described = std::min(described, leftAsDescribed(impulses));
    CoilOrder order = bestCoilOrder(impulses);
    if (!best || order.left < best->left) {
      best = std::move(order);
    }
  }
  if (best->mistakes() == 0 || !(best->left < kMostLeft * described)) {
    return std::nullopt;
  }
  return SuspectedWiring{mistakesOf(*best), best->left / described};
}

}  // namespace sac
