#include "score_sums.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "spherical_actuator_calibration/estimation/linearization.hpp"
#include "spherical_actuator_calibration/estimation/shared_errors.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

/// The effects that an actuator can have and the problem does not model.
EffectSelection missingEffects(const ParameterSpace& space) {
  EffectSelection missing;
  for (const std::string& effect : effectNames()) {
    const std::vector<PlacedEffect>& own = space.effects().effects();
    const bool is_modelled = std::any_of(
        own.begin(), own.end(), [&](const PlacedEffect& one) { return one.name == effect; });
    if (!is_modelled && canHaveEffect(space.nominal(), effect)) {
      missing[effect] = true;
    }
  }
  return missing;
}

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

EstimationProblem withModel(EstimationProblem problem, const CalibrationModel& model) {
  problem.model = &model;
  return problem;
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
        without_effects_(has_effects_ ? EstimationProblem() : withModel(problem, columns.model())),
        evaluator_(has_effects_ ? problem : without_effects_, options),
        shared_(groupByDwell(problem, options)),
        further_point_(columns.model(), furtherCoordinates()),
        point_(has_effects_ ? evaluator_.at(estimate.belief.x) : further_point_),
        every_(ChosenCoordinates::all(columns.size())),
        dwell_(columns.size()) {}

  std::vector<Unit> units() const { return unitsOf(problem_, shared_); }

  /// Id of the last sample of a unit.
  std::uint32_t last(const Unit& unit) const { return sampleOf(problem_, unit.end - 1).id; }

  void add(const Unit& unit, InformationSum& sum) {
    const bool is_shared = shared_.shares[unit.begin];
    dwell_.begin();
    for (std::size_t n = unit.begin; n < unit.end; ++n) {
      if (estimate_.residuals[n].rejected) {
        continue;
      }
      linearize(n);
      if (!is_shared) {
        whiten(all_, whiteningOf(evaluator_.noise(n, linear_)), every_, whitened_);
        sum.add(whitened_);
        continue;
      }
      const Eigen::Matrix3d whitening = whiteningOf(evaluator_.ownNoise(n, linear_));
      whiten(all_, whitening, every_, whitened_);
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

  void linearize(std::size_t n) {
    evaluator_.linearize(n, point_, linear_);
    const Sample& sample = sampleOf(problem_, n);
    const ParameterSpace& space = columns_.space();
    all_.residual = linear_.residual;
    all_.columns = linear_.columns;
    all_.jacobian.resize(3, columns_.size());
    all_.jacobian.leftCols(linear_.jacobian.cols()) = linear_.jacobian;
    if (has_effects_) {
      addFurther(n, sample);
    }
    for (std::size_t k = 0; k < space.joints(); ++k) {
      const Eigen::Index column = columns_.scale(k);
      all_.jacobian.col(column) = sample.joint_position[static_cast<Eigen::Index>(k)] *
                                  linear_.jacobian.col(space.joint(k));
      all_.columns.push_back(column);
    }
  }

  void addFurther(std::size_t n, const Sample& sample) {
    if (problem_.observations[n].quantity == Quantity::kOrientation) {
      further_point_.orientationResidual(sample, &further_);
    } else {
      further_point_.torqueResidual(sample, evaluator_.excitations(n), &further_);
    }
    const Eigen::Index effects = columns_.model().space().effects().size();
    all_.jacobian.middleCols(columns_.effect(0), effects) = further_.rightCols(effects);
    for (Eigen::Index p = columns_.effect(0); p < columns_.scale(0); ++p) {
      if (!all_.jacobian.col(p).isZero(0.0)) {
        all_.columns.push_back(p);
      }
    }
  }

  const EstimationProblem& problem_;
  const Estimate& estimate_;
  const FurtherColumns& columns_;
  bool has_effects_;  ///< of its own
  /// With the further columns in its model; where it has no effects that is the problem itself.
  EstimationProblem without_effects_;
  ObservationEvaluator evaluator_;
  SharedErrorModel shared_;
  ModelPoint further_point_;
  ModelPoint point_;
  ChosenCoordinates every_;
  DwellSum dwell_;
  // Storage that is reused.
  LinearizedObservation linear_;  ///< in the coordinates of the problem
  LinearizedObservation all_;     ///< in all columns
  WhitenedObservation whitened_;
  ResidualJacobian further_;
};

}  // namespace

FurtherColumns::FurtherColumns(const EstimationProblem& problem)
    : own_(problem.model->space()), model_(ParameterSpace(own_.nominal(), missingEffects(own_))) {}

Eigen::Index FurtherColumns::first(const std::string& effect) const {
  for (const PlacedEffect& placed : own_.effects().effects()) {
    if (placed.name == effect) {
      return own_.effect() + placed.first;
    }
  }
  for (const PlacedEffect& placed : model_.space().effects().effects()) {
    if (placed.name == effect) {
      return this->effect(placed.first);
    }
  }
  return -1;
}

ScoreSums scoreSums(const EstimationProblem& problem,
                    const Estimate& estimate,
                    const EstimationOptions& options,
                    const FurtherColumns& columns,
                    std::vector<Eigen::Index> stepped) {
  // More times would cost more than what they find: between two of them little is lost.
  constexpr std::size_t kMostParts = 48;
  Summation summation(problem, estimate, options, columns);
  const std::vector<Unit> units = summation.units();
  const std::size_t parts = std::min(kMostParts, units.size());
  const Eigen::Index P = columns.space().size();
  InformationSum sum(columns.size());
  ScoreSums sums;
  sums.stepped = std::move(stepped);
  // From the end, so that what is summed up so far is what is later.
  for (std::size_t part = parts; part-- > 0;) {
    const std::size_t begin = part * units.size() / parts;
    const std::size_t end = (part + 1) * units.size() / parts;
    for (std::size_t u = begin; u < end; ++u) {
      summation.add(units[u], sum);
    }
    if (part > 0) {  // from the beginning on nothing is a step
      const Eigen::MatrixXd rows = sum.information(sums.stepped);
      sums.later.push_back({summation.last(units[begin - 1]),
                            rows.leftCols(P),
                            rows(Eigen::all, sums.stepped),
                            sum.gradient()(sums.stepped)});
    }
  }
  std::reverse(sums.later.begin(), sums.later.end());
  sums.information = sum.information();
  sums.gradient = sum.gradient();
  return sums;
}

}  // namespace sac
