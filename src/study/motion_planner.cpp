#include "spherical_actuator_calibration/study/motion_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/noise_source.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"
#include "spherical_actuator_calibration/base/value_range.hpp"
#include "spherical_actuator_calibration/base/version.hpp"
#include "spherical_actuator_calibration/emulation/manufacturing_errors.hpp"

namespace sac {
namespace {

constexpr int kTilts = 3;  // sines of joints 1 and 2
constexpr int kTones = 6;  // of each coil
// Lower ones cost more motion where the model is wrong, and tell no more.
constexpr double kLowestTone = 1.0;   // [Hz]
constexpr double kHighestTone = 4.0;  // [Hz]
constexpr double kSpin = 1.1 * kPi;   // of the slow sine of joint 3 [rad]
constexpr double kTotalShare = 0.7;   // of the limit, that the excitation takes in the mean
constexpr int kAttempts = 10;         // to find an excitation
constexpr double kWeaker = 0.75;      // from one attempt to the next
constexpr double kLeastMeanShare = 2.0 / 3.0;  // of the excitation, that rehearsals must leave
// Of the limit of the tracking error: other models are worse than those of rehearsals.
constexpr double kMostOfError = 0.75;

class MotionSource {
 public:
  MotionSource(const Actuator& actuator, const MotionPlannerOptions& options)
      : actuator_(actuator),
        options_(options),
        noise_(options.seed, RandomPurpose::kMotionCandidates) {}

  MotionPlan next(double excitation) {
    MotionPlan plan;
    plan.actuator = actuator_.name;
    plan.serial = actuator_.serial;
    plan.duration = options_.duration;
    plan.ramp = options_.ramp;
    plan.limits = options_.limits;
    plan.joints[0].sines = tilt();
    plan.joints[1].sines = tilt();
    plan.joints[2].sines = spin();
    for (JointMotion& joint : plan.joints) {
      slowDown(joint.sines);
    }
    for (std::size_t coil = 0; coil < actuator_.coils.size(); ++coil) {
      plan.coils.push_back(tones(excitation));
    }
    return plan;
  }

 private:
  double between(double low, double high) { return low + (high - low) * noise_.share(); }
  double phase() { return noise_.uniform(kPi); }

  std::vector<Sine> tilt() {
    std::vector<Sine> sines;
    sines.reserve(kTilts);
    for (int n = 0; n < kTilts; ++n) {
      sines.push_back({between(0.1, 0.5), between(0.5, 1.5), phase()});
    }
    const double scale = options_.limits.tilt / largestValueOf(sines);
    for (Sine& sine : sines) {
      sine.amplitude *= scale;
    }
    return sines;
  }

  /// Once around and back at least, and something quicker.
  std::vector<Sine> spin() {
    const double slow = std::max(1.0 / options_.duration, between(0.05, 0.1));
    return {{slow, kSpin, phase()},
            {between(0.2, 0.5), between(0.1, 0.3), phase()},
            {between(0.2, 0.5), between(0.1, 0.3), phase()}};
  }

  /// Within the limit of the rate, at lower frequencies.
  void slowDown(std::vector<Sine>& sines) const {
    const double share = options_.limits.rate / largestRateOf(sines);
    for (Sine& sine : sines) {
      sine.frequency *= std::min(1.0, share);
    }
  }

  std::vector<Sine> tones(double excitation) {
    std::vector<Sine> sines;
    const double amplitude = excitation * std::sqrt(2.0 / kTones);
    sines.reserve(kTones);
    for (int n = 0; n < kTones; ++n) {
      sines.push_back({between(kLowestTone, kHighestTone), amplitude, phase()});
    }
    return sines;
  }

  const Actuator& actuator_;
  const MotionPlannerOptions& options_;
  NoiseSource noise_;
};

/// Of normally distributed currents of this root mean square in each coil, Σ|I| has this mean.
double excitationFor(double mean_total, std::size_t coils) {
  return mean_total / static_cast<double>(coils) * std::sqrt(kPi / 2.0);
}

/// Root mean square of a coil whose tones together reach its limit [A].
double largestExcitation(const MotionPlannerOptions& options) {
  return options.limits.coil_current * std::sqrt(0.5 / kTones);
}

double startExcitation(const Actuator& actuator, const MotionPlannerOptions& options) {
  if (options.excitation > 0.0) {
    return std::min(options.excitation, largestExcitation(options));
  }
  const auto coils = static_cast<double>(actuator.coils.size());
  return std::min({excitationFor(kTotalShare * options.limits.total_current, actuator.coils.size()),
                   std::sqrt(kTotalShare * options.limits.square_current / coils),
                   largestExcitation(options)});
}

void scaleExcitation(MotionPlan& plan, double factor) {
  for (std::vector<Sine>& sines : plan.coils) {
    for (Sine& sine : sines) {
      sine.amplitude *= factor;
    }
  }
}

Rehearsal rehearseWithWrongModel(const MotionPlan& plan,
                                 const Actuator& actuator,
                                 const MotionPlannerOptions& options,
                                 std::uint64_t number) {
  const double error = options.model_error;
  const Actuator truth =
      manufacturedActuator(actuator, {error, error, error, error}, options.seed + number);
  RehearsalOptions rehearsal = options.rehearsal;
  rehearsal.seed = options.seed + number;
  return rehearse(plan, actuator, truth, rehearsal);
}

bool isGood(const Rehearsal& rehearsal) {
  return rehearsal.completed && rehearsal.mean_excitation_share >= kLeastMeanShare;
}

std::string describe(const Rehearsal& rehearsal, double excitation) {
  return format("%.3f A of excitation: %s; %.0f %% of it were left, the rotor was %.0f mrad off.",
                excitation,
                rehearsal.completed ? "too much is faded" : rehearsal.reason.c_str(),
                100.0 * rehearsal.mean_excitation_share,
                1e3 * rehearsal.largest_tracking_error);
}

/// How a motion goes with wrong models.
struct RehearsedMotion {
  std::vector<Rehearsal> rehearsals;  ///< up to the first that is not good
  bool is_good = true;
  double largest_error = 0.0;  ///< from the reference [rad]
};

RehearsedMotion rehearsed(const MotionPlan& plan,
                          const Actuator& actuator,
                          const MotionPlannerOptions& options) {
  RehearsedMotion motion;
  for (std::size_t n = 0; n < options.rehearsals && motion.is_good; ++n) {
    const Rehearsal rehearsal = rehearseWithWrongModel(plan, actuator, options, n);
    motion.is_good = isGood(rehearsal);
    motion.largest_error = std::max(motion.largest_error, rehearsal.largest_tracking_error);
    motion.rehearsals.push_back(rehearsal);
  }
  return motion;
}

/// The first of the motions that stays well within the limit of its error, else the one of the
/// others that stays within by most; the excitation is weakened until there is one. Where a wrong
/// model turns torques round that is of little use: there it takes another motion.
void chooseByRehearsals(std::vector<MotionPlan> motions,
                        const Actuator& actuator,
                        const MotionPlannerOptions& options,
                        const std::function<void(const std::string&)>& progress,
                        PlannedMotionResult& result) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    double least_error = std::numeric_limits<double>::infinity();
    for (const MotionPlan& plan : motions) {
      RehearsedMotion motion = rehearsed(plan, actuator, options);
      if (!motion.is_good) {
        if (progress) {
          progress(describe(motion.rehearsals.back(), result.excitation));
        }
        continue;
      }
      if (motion.largest_error < least_error) {
        least_error = motion.largest_error;
        result.record.plan = plan;
        result.rehearsals = std::move(motion.rehearsals);
      }
      if (least_error <= kMostOfError * plan.limits.error) {
        return;
      }
    }
    if (std::isfinite(least_error)) {
      return;
    }
    for (MotionPlan& plan : motions) {
      scaleExcitation(plan, kWeaker);
    }
    result.excitation *= kWeaker;
  }
  throw DataError("No excitation is weak enough for a model that is wrong by " +
                  shortNumber(options.model_error) +
                  " rad: give slower motions, larger gains, or a smaller error of the model.");
}

}  // namespace

void validate(const MotionPlannerOptions& options) {
  requireInRange("duration", options.duration, ValueRange::closed(5.0, 3600.0, "s"));
  requireInRange("ramp", options.ramp, ValueRange::closed(0.1, 0.5 * options.duration, "s"));
  requireInRange("excitation", options.excitation, ValueRange::nonNegative("A"));
  requireInRange(
      "candidates", static_cast<double>(options.candidates), ValueRange::closed(1.0, 1000.0));
  requireInRange(
      "rehearsals", static_cast<double>(options.rehearsals), ValueRange::closed(0.0, 1000.0));
  requireInRange("model-error", options.model_error, ValueRange::closed(0.0, 0.5, "rad"));
  validate(options.sensors);
  validate(options.rehearsal.controller);
}

std::vector<MotionPlan> drawMotions(const Actuator& actuator,
                                    const MotionPlannerOptions& options,
                                    const MotionScore& score) {
  validate(options);
  const double excitation = startExcitation(actuator, options);
  MotionSource source(actuator, options);
  std::vector<std::pair<double, MotionPlan>> scored;
  for (std::size_t n = 0; n < options.candidates; ++n) {
    MotionPlan plan = source.next(excitation);
    validate(plan, actuator);
    const double value = score(plan);
    scored.emplace_back(value, std::move(plan));
  }
  std::stable_sort(
      scored.begin(), scored.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<MotionPlan> motions;
  motions.reserve(scored.size());
  for (auto& [value, plan] : scored) {
    motions.push_back(std::move(plan));
  }
  return motions;
}

PlannedMotionResult planMotion(const Actuator& actuator,
                               const MotionPlannerOptions& options,
                               const std::function<void(const std::string&)>& progress) {
  constexpr int kFewWindows = 8;  // one of so many tells which candidate is better
  const CalibrationModel model{ParameterSpace(actuator)};
  const RigidRotor& rotor = options.rehearsal.controller.rotor;
  std::size_t seen = 0;
  PlannedMotionResult result;
  result.record.software = packageVersion();
  const auto score = [&](const MotionPlan& plan) {
    const double worst =
        expectedStddevs(model, rotor, plan, options.sensors, kFewWindows).maxCoeff();
    if (progress) {
      progress(
          format("Candidate %zu: worst standard deviation about %.4f mrad.", ++seen, 1e3 * worst));
    }
    return worst;
  };
  result.excitation = startExcitation(actuator, options);
  chooseByRehearsals(drawMotions(actuator, options, score), actuator, options, progress, result);
  // What rehearsals had to fade does not tell.
  MotionPlan faded = result.record.plan;
  double share = 1.0;
  for (const Rehearsal& rehearsal : result.rehearsals) {
    share = std::min(share, rehearsal.mean_excitation_share);
  }
  scaleExcitation(faded, share);
  const Eigen::VectorXd stddevs = expectedStddevs(model, rotor, faded, options.sensors, 2);
  for (Eigen::Index p = 0; p < stddevs.size(); ++p) {
    result.record.expected.push_back({model.space().name(p), stddevs[p]});
    if (stddevs[p] > result.worst_stddev) {
      result.worst_stddev = stddevs[p];
      result.worst_parameter = model.space().name(p);
    }
  }
  return result;
}

}  // namespace sac
