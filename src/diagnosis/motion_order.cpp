#include "motion_order.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "coil_order.hpp"
#include "spherical_actuator_calibration/motion/delay_range.hpp"
#include "spherical_actuator_calibration/motion/motion_excerpt.hpp"
#include "torque_hypotheses.hpp"
#include "wiring_problem.hpp"

namespace sac {
namespace {

/// What brings each current to its coil: exchanges of two, and circles of more.
void addCircles(const std::vector<std::size_t>& coil_of, Candidate& candidate) {
  std::vector<bool> is_seen(coil_of.size(), false);
  for (std::size_t channel = 0; channel < coil_of.size(); ++channel) {
    std::vector<std::size_t> circle;
    for (std::size_t next = channel; !is_seen[next]; next = coil_of[next]) {
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

/// In the order in which currents are corrected: shifted, exchanged, turned.
Candidate mistakesOf(const CoilOrder& order) {
  Candidate candidate;
  const std::size_t coils = order.coil.size();
  const std::size_t steps = coils > 2 ? order.steps() : 0;
  if (steps > 0) {
    candidate.push_back(coilShift(steps));
  }
  std::vector<std::size_t> coil_of(coils);  // of each channel once all are shifted back
  for (std::size_t channel = 0; channel < coils; ++channel) {
    coil_of[(channel + steps) % coils] = order.coil[channel];
  }
  addCircles(coil_of, candidate);
  for (std::size_t channel = 0; channel < order.coil.size(); ++channel) {
    if (order.sign[channel] != 1) {
      const std::size_t coil = order.coil[channel];
      candidate.push_back(order.sign[channel] < 0 ? coilSign(coil) : coilDead(coil));
    }
  }
  return candidate;
}

/// An order of the coils, and mistakes of poles beside it.
struct Arrangement {
  CoilOrder order;
  Candidate poles;

  std::size_t mistakes() const { return order.mistakes() + poles.size(); }
};

/// The best order once mistakes of poles are undone; nothing where the motion has too few windows.
std::optional<Arrangement> arrangementWith(const Candidate& poles,
                                           const CalibrationSession& session,
                                           const MotionRecording& excerpt,
                                           double current_delay) {
  const CorrectedMotion motion = correctedMotion(session.start().actuator, excerpt, poles);
  const WiringProblem problem(motion.actuator, excerpt, session.config());
  const ChannelImpulses impulses = channelImpulses(problem.get(), current_delay);
  if (impulses.momentum.size() == 0) {
    return std::nullopt;
  }
  return Arrangement{bestCoilOrder(impulses), poles};
}

/// The best of those with a mistake of one more pole.
Arrangement withOneMorePole(const Arrangement& present,
                            const CalibrationSession& session,
                            const MotionRecording& excerpt,
                            double current_delay) {
  Arrangement best = present;
  for (std::size_t pole = 0; pole < session.start().actuator.poles.size(); ++pole) {
    for (const Hypothesis& mistake : {polePolarity(pole), poleMissing(pole)}) {
      Candidate poles = present.poles;
      poles.push_back(mistake);
      std::optional<Arrangement> one = arrangementWith(poles, session, excerpt, current_delay);
      if (one && one->order.left < best.order.left) {
        best = std::move(*one);
      }
    }
  }
  return best;
}

}  // namespace

std::optional<MotionOrder> orderOfMotion(const CalibrationSession& session) {
  constexpr double kExcerpt = 30.0;  // [s]
  // A coil that is turned leaves a fifth of the misfit, an exchange of two a third at most.
  constexpr double kMostLeft = 0.75;
  // Memory grows with their square, time by more.
  constexpr std::size_t kMostCoils = 64;
  constexpr std::size_t kMostPoles = 2;
  // Of the momentum. Axes that are 30 mrad off leave a twentieth.
  constexpr double kExplained = 0.1;
  if (session.start().actuator.coils.size() > kMostCoils) {
    return std::nullopt;
  }
  const MotionRecording excerpt = motionExcerpt(*session.motion(), kExcerpt);
  const WiringProblem problem(session.start().actuator, excerpt, session.config());
  std::optional<Arrangement> best;
  double described = std::numeric_limits<double>::infinity();
  double best_delay = 0.0;
  for (const double delay : DelayRange().delays()) {
    const ChannelImpulses impulses = channelImpulses(problem.get(), delay);
    if (impulses.momentum.size() == 0) {
      return std::nullopt;
    }
    described = std::min(described, leftAsDescribed(impulses));
    CoilOrder order = bestCoilOrder(impulses);
    if (!best || order.left < best->order.left) {
      best = Arrangement{std::move(order), {}};
      best_delay = delay;
    }
  }
  while (best->poles.size() < kMostPoles) {
    Arrangement next = withOneMorePole(*best, session, excerpt, best_delay);
    if (!(next.order.left < kMostLeft * best->order.left)) {
      break;
    }
    best = std::move(next);
  }
  MotionOrder result;
  if (best->order.left < kExplained) {
    result.current_delay = best_delay;
  }
  if (best->mistakes() > 0 && best->order.left < kMostLeft * described) {
    Candidate parts = mistakesOf(best->order);
    parts.insert(parts.end(), best->poles.begin(), best->poles.end());
    result.mistakes = SuspectedWiring{std::move(parts), best->order.left / described};
  }
  return result;
}

}  // namespace sac
