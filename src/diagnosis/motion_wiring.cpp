#include "motion_wiring.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Core>

#include "spherical_actuator_calibration/motion/motion_excerpt.hpp"
#include "spherical_actuator_calibration/motion/rough_motion.hpp"
#include "torque_hypotheses.hpp"
#include "wiring_problem.hpp"

namespace sac {
namespace {

StreamCurrents timesMatrix(const StreamCurrents& currents, const Eigen::MatrixXf& change) {
  StreamCurrents result;
  for (Eigen::Index n = 0; n < currents.rows(); ++n) {
    result.addRow(Eigen::RowVectorXf(currents.row(n) * change));
  }
  return result;
}

/// How well a step from the description explains the motion without the mistakes of a candidate.
double misfitWithout(const CalibrationSession& session,
                     const MotionRecording& excerpt,
                     const Candidate& candidate,
                     double variance,
                     const DelayRange& delays) {
  const CorrectedMotion motion = correctedMotion(session.start().actuator, excerpt, candidate);
  const WiringProblem problem(motion.actuator, motion.recording, session.config());
  return roughMisfit(problem.get(), variance, delays);
}

/// Mistakes of one coil or pole, or of all currents. A factor on all of them is sought coarsely:
/// milliamperes, or a gain that is far off; inertia takes up one that is near 1.
std::vector<Candidate> singleMistakes(const Actuator& actuator) {
  constexpr double kFactors[] = {1e-3, 0.1, 10.0};
  constexpr double kTolerance = 0.1;
  std::vector<Candidate> mistakes{
      {currentSign()}, {coilShift(1)}, {coilShift(actuator.coils.size() - 1)}};
  for (const double factor : kFactors) {
    mistakes.push_back({currentUnit(factor, kTolerance)});
  }
  for (std::size_t coil = 0; coil < actuator.coils.size(); ++coil) {
    mistakes.push_back({coilSign(coil)});
    mistakes.push_back({coilDead(coil)});
  }
  for (std::size_t pole = 0; pole < actuator.poles.size(); ++pole) {
    mistakes.push_back({polePolarity(pole)});
    mistakes.push_back({poleMissing(pole)});
  }
  return mistakes;
}

/// A mistake leaves a half of the misfit at most; what is none a tenth more or less.
bool explainsLittle(const SuspectedWiring& wiring) {
  constexpr double kMostLeft = 0.75;
  return !(wiring.share_left < kMostLeft);
}

/// The coil that a single mistake is at; nothing: at none.
std::optional<std::size_t> coilOf(const Candidate& single, std::size_t coils) {
  for (std::size_t coil = 0; coil < coils; ++coil) {
    if (single.front().family == coilSign(coil).family) {
      return coil;
    }
  }
  return std::nullopt;
}

/// Coils that are exchanged, among those at which single mistakes were promising.
std::vector<Candidate> exchanges(const std::vector<Candidate>& singles, std::size_t coils) {
  std::set<std::size_t> suspected;
  for (const Candidate& single : singles) {
    if (const std::optional<std::size_t> coil = coilOf(single, coils)) {
      suspected.insert(*coil);
    }
  }
  std::vector<Candidate> pairs;
  for (auto first = suspected.begin(); first != suspected.end(); ++first) {
    for (auto second = std::next(first); second != suspected.end(); ++second) {
      pairs.push_back({coilSwap(*first, *second)});
    }
  }
  return pairs;
}

/// Those that are known first: they are corrected first.
Candidate beside(const Candidate& known, const Candidate& others) {
  Candidate all = known;
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

/// A mistake and each of the others that is at another place.
std::vector<Candidate> both(const Candidate& first, const std::vector<Candidate>& others) {
  std::vector<Candidate> pairs;
  for (const Candidate& other : others) {
    if (other.front().family != first.front().family) {
      pairs.push_back({first.front(), other.front()});
    }
  }
  return pairs;
}

}  // namespace

std::vector<SuspectedWiring> suspectedWiring(const CalibrationSession& session,
                                             const Candidate& known,
                                             const DelayRange& delays) {
  constexpr std::size_t kPromising = 8;
  constexpr std::size_t kMostTried = 2;
  constexpr double kExcerpt = 30.0;  // [s]
  const MotionRecording excerpt = motionExcerpt(*session.motion(), kExcerpt);
  const double unchanged = misfitWithout(session, excerpt, known, 0.0, delays);
  if (!(unchanged > 0.0)) {
    return {};
  }
  std::vector<SuspectedWiring> all;
  const auto rank = [&](const std::vector<Candidate>& candidates) {
    for (const Candidate& candidate : candidates) {
      const double left =
          misfitWithout(session, excerpt, beside(known, candidate), unchanged, delays);
      all.push_back({candidate, left / unchanged});
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& one, const auto& other) {
      return one.share_left < other.share_left;
    });
  };
  const Actuator& actuator = session.start().actuator;
  rank(singleMistakes(actuator));
  std::vector<Candidate> promising;
  for (std::size_t n = 0; n < std::min(kPromising, all.size()); ++n) {
    promising.push_back(all[n].parts);
  }
  rank(exchanges(promising, actuator.coils.size()));
  if (promising.front().front().family == all.front().parts.front().family) {
    rank(both(promising.front(), promising));
  }
  all.erase(std::find_if(all.begin(), all.end(), explainsLittle), all.end());
  all.resize(std::min(kMostTried, all.size()));
  for (SuspectedWiring& suspected : all) {
    suspected.parts = beside(known, suspected.parts);
  }
  return all;
}

Candidate motionMistakes(const Actuator& actuator) {
  Candidate all;
  for (const Candidate& single : singleMistakes(actuator)) {
    all.push_back(single.front());
  }
  for (std::size_t first = 0; first < actuator.coils.size(); ++first) {
    for (std::size_t second = first + 1; second < actuator.coils.size(); ++second) {
      all.push_back(coilSwap(first, second));
    }
  }
  return all;
}

CorrectedMotion correctedMotion(const Actuator& actuator,
                                const MotionRecording& recording,
                                const Candidate& candidate) {
  // What it does to one ampere in each coil.
  const auto coils = static_cast<Eigen::Index>(actuator.coils.size());
  WiringCase described{actuator, {}};
  for (Eigen::Index coil = 0; coil < coils; ++coil) {
    Sample sample;
    sample.current = Eigen::VectorXd::Unit(coils, coil);
    sample.has_torque = true;  // currents of others are not corrected
    described.samples.push_back(sample);
  }
  const WiringCase undone = corrected(described, candidate, startOf(candidate));
  Eigen::MatrixXf change(coils, coils);
  for (Eigen::Index coil = 0; coil < coils; ++coil) {
    change.row(coil) =
        undone.samples[static_cast<std::size_t>(coil)].current.transpose().cast<float>();
  }
  CorrectedMotion result{undone.actuator, recording};
  for (MotionStreams& streams : result.recording.spans) {
    streams.currents = timesMatrix(streams.currents, change);
    if (streams.commanded != nullptr) {
      CommandedCurrents commanded = *streams.commanded;
      commanded.currents = timesMatrix(commanded.currents, change);
      streams.commanded = std::make_shared<const CommandedCurrents>(std::move(commanded));
    }
  }
  return result;
}

}  // namespace sac
