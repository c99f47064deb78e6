#include "spherical_actuator_calibration/study/calibration_study.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/normal_distribution.hpp"
#include "spherical_actuator_calibration/base/parallel_for.hpp"
#include "spherical_actuator_calibration/calibration/calibration_session.hpp"
#include "spherical_actuator_calibration/calibration/cycle_selection.hpp"
#include "spherical_actuator_calibration/study/cramer_rao_bound.hpp"

namespace sac {
namespace {

ParameterGroup groupOf(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kJointOffset:
      return ParameterGroup::kOffsets;
    case ParameterKind::kJointAxisU:
    case ParameterKind::kJointAxisV:
      return ParameterGroup::kJointAxes;
    case ParameterKind::kPolePolar:
    case ParameterKind::kPoleAzimuth:
      return ParameterGroup::kPoles;
    case ParameterKind::kCoilPolar:
    case ParameterKind::kCoilAzimuth:
      return ParameterGroup::kCoils;
    case ParameterKind::kEffect:
      break;
  }
  return ParameterGroup::kEffects;
}

/// Coordinates that the refinement frees: what the samples of the plan can serve.
GroupTallies tally(const ParameterSpace& space,
                   const std::vector<Eigen::Index>& free,
                   const ParameterBelief& belief,
                   const Eigen::VectorXd& truth,
                   const Eigen::VectorXd& bound_variance) {
  GroupTallies tallies;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const Eigen::Index p = free[k];
    GroupTally& group = tallies[static_cast<std::size_t>(groupOf(space.id(p).kind))];
    const double error = belief.x[p] - truth[p];
    ++group.parameters;
    group.covered += std::abs(error) <= kTwoSided95 * std::sqrt(belief.covariance(p, p)) ? 1U : 0U;
    group.squared_error += error * error;
    group.squared_bound += bound_variance[static_cast<Eigen::Index>(k)];
  }
  return tallies;
}

StudyErrors errorsOf(const GroupTally& sum) {
  const auto count = static_cast<double>(sum.parameters);
  return {std::sqrt(sum.squared_error / count),
          std::sqrt(sum.squared_bound / count),
          static_cast<double>(sum.covered) / count};
}

void accumulate(GroupTally& sum, const GroupTally& more) {
  sum.parameters += more.parameters;
  sum.covered += more.covered;
  sum.squared_error += more.squared_error;
  sum.squared_bound += more.squared_bound;
}

/// Sums in the order of the seeds, so that the same trials give the same bits.
StageSummary summarize(std::vector<StudyTrial>& trials,
                       bool StudyTrial::*converged,
                       GroupTallies StudyTrial::*tallies) {
  std::sort(trials.begin(), trials.end(), [](const StudyTrial& a, const StudyTrial& b) {
    return a.seed < b.seed;
  });
  StageSummary summary;
  summary.trials = trials.size();
  GroupTallies sums;
  GroupTally all;
  for (const StudyTrial& trial : trials) {
    summary.converged += trial.*converged ? 1U : 0U;
    for (std::size_t g = 0; g < kParameterGroups; ++g) {
      accumulate(sums[g], (trial.*tallies)[g]);
      accumulate(all, (trial.*tallies)[g]);
    }
  }
  std::transform(sums.begin(), sums.end(), summary.groups.begin(), errorsOf);
  summary.all = errorsOf(all);
  return summary;
}

}  // namespace

const char* groupName(ParameterGroup group) {
  constexpr std::array<const char*, kParameterGroups> kNames = {
      "offsets", "joint_axes", "poles", "coils", "effects"};
  return kNames[static_cast<std::size_t>(group)];
}

StudyTrial runTrial(const StudyOptions& options, std::uint64_t seed) {
  const Actuator made = manufacturedActuator(options.nominal, options.errors, seed);
  const std::vector<Sample> samples =
      simulateSamples(made, options.plan, options.tracker, options.noise, seed);
  CalibrationConfig config;
  config.estimation = options.estimation;
  // Its bound is that of a rotor without one.
  config.orientation_map = MapUse::kNever;
  CalibrationSession session({options.nominal}, samples, config);
  const CalibrationModel& model = session.model();
  const Eigen::VectorXd truth = model.space().coordinatesOf(made);
  const CycleRequest refine{Cycle::kRefine};
  const std::vector<Eigen::Index> free =
      selectCoordinates(model.space(), samples, refine, options.estimation);
  const Eigen::VectorXd bound = cramerRaoBound(model, samples, refine, free, truth).diagonal();

  StudyTrial trial;
  trial.seed = seed;
  trial.sequence_converged = true;
  for (const CycleRequest& request : possibleCycles(model, samples, options.estimation)) {
    if (request.cycle != Cycle::kRefine) {
      trial.sequence_converged =
          session.run(withoutExpectedErrors(request)).success && trial.sequence_converged;
    }
  }
  if (trial.sequence_converged) {
    trial.sequence = tally(model.space(), free, session.state().belief, truth, bound);
  }
  trial.refine_converged = session.run(withoutExpectedErrors(refine)).success;
  if (trial.refine_converged) {
    trial.refined = tally(model.space(), free, session.state().belief, truth, bound);
  }
  return trial;
}

std::vector<StudyTrial> runTrials(const StudyOptions& options,
                                  std::uint64_t first,
                                  std::uint64_t end,
                                  std::uint64_t stride,
                                  unsigned threads,
                                  const std::function<void(double)>& progress) {
  if (stride == 0) {
    throw ConfigError("stride: it must be at least 1.");
  }
  const std::size_t count = first < end ? (end - first + stride - 1) / stride : 0;
  std::vector<StudyTrial> trials(count);
  std::mutex mutex;  // of what follows
  std::size_t done = 0;
  parallelFor(count, threads, [&](unsigned /*worker*/, std::size_t n) {
    trials[n] = runTrial(options, first + n * stride);
    const std::lock_guard<std::mutex> lock(mutex);
    ++done;
    if (progress) {
      progress(static_cast<double>(done) / static_cast<double>(count));
    }
  });
  return trials;
}

StageSummary summarizeSequence(std::vector<StudyTrial> trials) {
  return summarize(trials, &StudyTrial::sequence_converged, &StudyTrial::sequence);
}

StageSummary summarizeRefinement(std::vector<StudyTrial> trials) {
  return summarize(trials, &StudyTrial::refine_converged, &StudyTrial::refined);
}

}  // namespace sac
