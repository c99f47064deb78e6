#include "score_sums.hpp"

#include <algorithm>
#include <numeric>

#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

/// Observations [begin, end) that nothing separates in time: those of a dwell that share errors, or
/// of a sample.
struct Unit {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

const Sample& sampleOf(const EstimationProblem& problem, std::size_t observation) {
  return (*problem.samples)[problem.observations[observation].sample];
}

/// All, in the order of their stamps.
std::vector<Unit> unitsOf(const EstimationProblem& problem, const SharedErrorModel& shared) {
  const std::size_t count = problem.observations.size();
  std::vector<Unit> units;
  auto dwell = shared.dwells.begin();
  for (std::size_t n = 0; n < count; n = units.back().end) {
    std::size_t end = n + 1;
    if (shared.shares[n]) {
      end = dwell->back() + 1;
      ++dwell;
    } else {
      while (end < count && !shared.shares[end] &&
             problem.observations[end].sample == problem.observations[n].sample) {
        ++end;
      }
    }
    units.push_back({static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(end)});
  }
  const auto is_earlier = [&](const Unit& a, const Unit& b) {
    return sampleOf(problem, a.begin).stamp < sampleOf(problem, b.begin).stamp;
  };
  if (!std::is_sorted(units.begin(), units.end(), is_earlier)) {
    std::stable_sort(units.begin(), units.end(), is_earlier);
  }
  return units;
}

/// Per further column the first one of those that are tried with it, counted from 0.
std::vector<Eigen::Index> groupsOf(const FurtherColumns& columns,
                                   const std::vector<EffectCandidate>& effects) {
  const Eigen::Index P = columns.space().size();
  std::vector<Eigen::Index> groups(static_cast<std::size_t>(columns.size() - P));
  std::iota(groups.begin(), groups.end(), 0);
  for (const EffectCandidate& effect : effects) {
    for (Eigen::Index n = std::max(effect.first, P); n < effect.first + effect.size(); ++n) {
      groups[static_cast<std::size_t>(n - P)] = effect.first - P;
    }
  }
  return groups;
}

/// Linearises and whitens observations in all columns at the solution.
class Summation {
 public:
  Summation(const EstimationProblem& problem,
            const Estimate& estimate,
            const EstimationOptions& options,
            const FurtherColumns& columns)
      : problem_(problem),
        estimate_(estimate),
        columns_(columns),
        has_effects_(columns.space().effects().size() > 0),
        evaluator_(problem, has_effects_ ? *problem.model : columns.model(), options),
        shared_(groupByDwell(problem, options)),
        further_point_(columns.model(), furtherCoordinates()),
        point_(has_effects_ ? evaluator_.at(estimate.belief.x) : further_point_),
        every_(ChosenCoordinates::all(has_effects_ ? columns.space().size() : columns.scale(0))),
        dwell_(columns.size()) {
    whitened_.jacobian.resize(3, columns.size());
  }

  std::vector<Unit> units() const { return unitsOf(problem_, shared_); }

  /// Id of the last sample of a unit.
  std::uint32_t last(const Unit& unit) const { return sampleOf(problem_, unit.end - 1).id; }

  void add(const Unit& unit, ScoreSum& sum) {
    const bool is_shared = shared_.shares[unit.begin];
    dwell_.begin();
    for (std::size_t n = unit.begin; n < unit.end; ++n) {
      if (estimate_.residuals[n].rejected) {
        continue;
      }
      evaluator_.linearize(n, point_, linear_);
      if (!is_shared) {
        whitenAll(n, whiteningOf(evaluator_.noise(n, linear_)));
        sum.add(whitened_);
        continue;
      }
      const Eigen::Matrix3d whitening = whiteningOf(evaluator_.ownNoise(n, linear_));
      whitenAll(n, whitening);
      dwell_.add(whitened_, whitening * evaluator_.sharedErrors(n, linear_));
    }
    if (is_shared) {
      dwell_.addTo(sum);
    }
  }

 private:
  /// Geometry at the solution, no effect. That effects are left out, which the problem models,
  /// makes the further columns a little weaker, not wrong: any column is a sound question.
  Eigen::VectorXd furtherCoordinates() const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(columns_.model().space().size());
    const Eigen::Index geometry = columns_.space().effect();
    x.head(geometry) = estimate_.belief.x.head(geometry);
    return x;
  }

  /// Of what was linearised last.
  void whitenAll(std::size_t n, const Eigen::Matrix3d& whitening) {
    whiten(linear_, whitening, every_, whitened_);
    const Sample& sample = sampleOf(problem_, n);
    if (has_effects_) {
      addFurther(n, sample, whitening);
    }
    for (std::size_t k = 0; k < columns_.space().joints(); ++k) {
      const double reading = sample.joint_position[static_cast<Eigen::Index>(k)];
      append(columns_.scale(k),
             reading * (whitening * linear_.jacobian.col(columns_.space().joint(k))));
    }
  }

  void append(Eigen::Index column, const Eigen::Vector3d& whitened) {
    whitened_.jacobian.col(static_cast<Eigen::Index>(whitened_.columns.size())) = whitened;
    whitened_.columns.push_back(column);
  }

  void addFurther(std::size_t n, const Sample& sample, const Eigen::Matrix3d& whitening) {
    if (problem_.observations[n].quantity == Quantity::kOrientation) {
      further_point_.orientationResidual(sample, &further_);
    } else {
      further_point_.torqueResidual(sample, evaluator_.excitations(n), &further_);
    }
    const Eigen::Index first = columns_.model().space().effect();
    for (Eigen::Index e = 0; e < columns_.model().space().effects().size(); ++e) {
      if (!further_.col(first + e).isZero(0.0)) {
        append(columns_.effect(e), whitening * further_.col(first + e));
      }
    }
  }

  const EstimationProblem& problem_;
  const Estimate& estimate_;
  const FurtherColumns& columns_;
  bool has_effects_;  ///< of its own
  /// With the further columns in its model where the problem models no effects.
  ObservationEvaluator evaluator_;
  SharedErrorModel shared_;
  ModelPoint further_point_;
  ModelPoint point_;
  ChosenCoordinates every_;
  DwellSum dwell_;
  // Storage that is reused.
  LinearizedObservation linear_;  ///< as the evaluator does
  WhitenedObservation whitened_;  ///< in all columns
  ResidualJacobian further_;
};

ScoreSums::Later laterPart(const ScoreSum& sum, const std::vector<StepCandidate>& steps) {
  Eigen::Index size = 0;
  for (const StepCandidate& step : steps) {
    size += step.count;
  }
  ScoreSums::Later later;
  later.crossed.resize(sum.coordinates(), size);
  later.information.setZero(size, size);
  later.gradient.resize(size);
  Eigen::Index first = 0;
  for (const StepCandidate& step : steps) {
    for (Eigen::Index a = 0; a < step.count; ++a) {
      later.crossed.col(first + a) = sum.crossed(step.first + a);
      later.gradient[first + a] = sum.gradient(step.first + a);
      for (Eigen::Index b = 0; b < step.count; ++b) {
        later.information(first + a, first + b) = sum.between(step.first + a, step.first + b);
      }
    }
    first += step.count;
  }
  return later;
}

}  // namespace

ScoreSums scoreSums(const EstimationProblem& problem,
                    const Estimate& estimate,
                    const EstimationOptions& options,
                    const FurtherColumns& columns,
                    const std::vector<EffectCandidate>& effects,
                    const std::vector<StepCandidate>& steps) {
  // More times would cost more than what they find: between two of them little is lost.
  constexpr std::size_t kMostParts = 48;
  Summation summation(problem, estimate, options, columns);
  const std::vector<Unit> units = summation.units();
  const std::size_t parts = std::min(kMostParts, units.size());
  ScoreSums sums{ScoreSum(columns.space().size(), groupsOf(columns, effects)), {}};
  // From the end, so that what is summed up so far is what is later.
  for (std::size_t part = parts; part-- > 0;) {
    const std::size_t begin = part * units.size() / parts;
    const std::size_t end = (part + 1) * units.size() / parts;
    for (std::size_t u = begin; u < end; ++u) {
      summation.add(units[u], sums.all);
    }
    if (part > 0) {  // from the beginning on nothing is a step
      sums.later.push_back(laterPart(sums.all, steps));
      sums.later.back().after = summation.last(units[begin - 1]);
    }
  }
  return sums;
}

}  // namespace sac
