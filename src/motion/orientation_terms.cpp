#include "orientation_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "spherical_actuator_calibration/base/parallel_for.hpp"

namespace sac {
namespace {

/// The one that a stamp is in, or none.
const HeldOutStretch* stretchAt(const std::vector<HeldOutStretch>& stretches,
                                std::size_t span,
                                double time) {
  // Ascending: the first that does not end before.
  const auto place = std::lower_bound(
      stretches.begin(), stretches.end(), time, [&](const HeldOutStretch& stretch, double at) {
        return stretch.span < span || (stretch.span == span && stretch.end < at);
      });
  const bool is_in = place != stretches.end() && place->span == span && time >= place->begin;
  return is_in ? &*place : nullptr;
}

/// The mean of a cell, of which white noise has the same variance as of any other.
struct CellMean {
  std::size_t span;
  std::size_t cell;
  Eigen::Vector3d residual;
};

constexpr std::size_t kMostLag = 6;  // 1.5 s: what a model lacks comes and goes with the motion

/// Of means that are so many cells apart.
double correlation(const std::vector<CellMean>& cells, std::size_t lag) {
  double products = 0.0;
  double squares = 0.0;
  std::size_t before = 0;
  for (std::size_t n = 0; n < cells.size(); ++n) {
    while (cells[before].cell + lag < cells[n].cell) {
      ++before;
    }
    if (cells[before].cell + lag == cells[n].cell && cells[before].span == cells[n].span) {
      products += cells[n].residual.dot(cells[before].residual);
      squares += 0.5 * (cells[n].residual.squaredNorm() + cells[before].residual.squaredNorm());
    }
  }
  return squares > 0.0 ? products / squares : 0.0;
}

}  // namespace

double robustWeight(double s) {
  constexpr double kTransition = 4.0;
  return s <= kTransition ? 1.0 : std::sqrt(kTransition / s);
}

std::vector<Eigen::Index> orientingCoordinates(const ParameterSpace& space,
                                               const MotionPlaces& places) {
  std::vector<Eigen::Index> coordinates;
  for (Eigen::Index p = 0; p < space.pole(0); ++p) {
    coordinates.push_back(p);
  }
  for (const PlacedEffect& placed : space.effects().effects()) {
    const bool turns = placed.acts_on == LaboratoryEffect::ActsOn::kOrientations ||
                       placed.acts_on == LaboratoryEffect::ActsOn::kEverything;
    const Eigen::Index first = space.effect() + placed.first;
    for (Eigen::Index n = 0; n < placed.size(); ++n) {
      if (turns || first + n == places.tracker_delay) {
        coordinates.push_back(first + n);
      }
    }
  }
  return coordinates;
}

void OrientationMean::add(const OrientationMean& other) {
  if (jacobian.size() == 0) {
    *this = other;
    return;
  }
  residual += other.residual;
  jacobian += other.jacobian;
  count += other.count;
}

OrientationTerms::OrientationTerms(const CalibrationModel& model,
                                   const MotionPlaces& places,
                                   const std::vector<MotionSpan>& spans,
                                   const MotionOptions& options,
                                   const std::vector<HeldOutStretch>& held_out)
    : model_(model),
      places_(places),
      spans_(spans),
      coordinates_(orientingCoordinates(model.space(), places)) {
  for (std::size_t s = 0; s < spans.size(); ++s) {
    group(s, options, held_out);
  }
}

void OrientationTerms::group(std::size_t span,
                             const MotionOptions& options,
                             const std::vector<HeldOutStretch>& held_out) {
  const StampTimes& times = spans_[span].orientation_times;
  double begin = -std::numeric_limits<double>::infinity();  // of a cell
  bool moved = false;                                       // since the orientation before
  for (std::size_t n = 0; n < times.size(); ++n) {
    const bool moved_before =
        std::exchange(moved, !restsAt(spans_[span], times[n], options.least_speed));
    if (!moved) {
      continue;
    }
    const HeldOutStretch* const stretch = stretchAt(held_out, span, times[n]);
    const std::size_t window = stretch == nullptr ? 0 : stretch->window;
    const bool begins = times[n] - begin > options.window;
    if (begins) {
      begin = times[n];
    }
    const std::size_t cell = groups_.empty() ? 0 : groups_.back().cell + (begins ? 1 : 0);
    if (begins || !moved_before || groups_.back().held_out != (stretch != nullptr) ||
        groups_.back().window != window) {
      OrientationGroup next;
      next.span = span;
      next.first = n;
      next.term = terms_.size();
      next.cell = cell;
      next.held_out = stretch != nullptr;
      next.window = window;
      groups_.push_back(std::move(next));
    }
    ++groups_.back().count;
    terms_.emplace_back();
  }
}

void OrientationTerms::sumUp(TrackerTerm& tracker, OrientationGroup& group) {
  const auto size = static_cast<Eigen::Index>(coordinates_.size());
  const MotionSpan& span = spans_[group.span];
  Eigen::MatrixXd jacobian(3 * static_cast<Eigen::Index>(group.count), size);
  Eigen::VectorXd residual(jacobian.rows());
  Eigen::Index rows = 0;
  group.mean.residual.setZero();
  group.mean.jacobian.setZero(3, size);
  group.mean.count = 0.0;
  group.squares = 0.0;
  for (std::size_t n = 0; n < group.count; ++n) {
    OrientationTerm& term = terms_[group.term + n];
    term.was_active = term.active;
    term.is_known = tracker.evaluate(span, group.first + n);
    if (!term.is_known) {
      continue;
    }
    const Eigen::Vector3d whitened = whitening_ * tracker.residual();
    const double square = whitened.squaredNorm() / 3.0;
    term.square = static_cast<float>(square);
    if (!term.active) {
      continue;
    }
    const double root = std::sqrt(robustWeight(square / scale_));
    for (Eigen::Index c = 0; c < size; ++c) {
      const Eigen::Vector3d column =
          whitening_ * tracker.jacobian().col(coordinates_[static_cast<std::size_t>(c)]);
      jacobian.block<3, 1>(rows, c) = root * column;
      group.mean.jacobian.col(c) += column;
    }
    residual.segment<3>(rows) = root * whitened;
    group.mean.residual += whitened;
    group.mean.count += 1.0;
    group.squares += whitened.squaredNorm();
    rows += 3;
  }
  group.sum = InformationSum(size);
  group.sum.addDense(jacobian.topRows(rows), residual.head(rows));
}

void OrientationTerms::linearize(const Eigen::VectorXd& x, double stddev, unsigned threads) {
  linearized_at_ = x;
  whitening_ = 1.0 / stddev;
  threads_ = threads;
  summed_scale_ = scale_;
  std::vector<std::unique_ptr<TrackerTerm>> trackers(threads);
  parallelFor(groups_.size(), threads, [&](unsigned worker, std::size_t n) {
    if (!trackers[worker]) {
      trackers[worker] = std::make_unique<TrackerTerm>(model_, places_, x);
    }
    sumUp(*trackers[worker], groups_[n]);
  });
}

/// Groups whose orientations serve now and did not, or the other way round; all of them, where the
/// scale is another one.
void OrientationTerms::sumUpWhatChanged() {
  constexpr double kSame = 0.01;
  if (std::abs(scale_ - summed_scale_) > kSame * summed_scale_) {
    linearize(Eigen::VectorXd(linearized_at_), 1.0 / whitening_, threads_);
    return;
  }
  std::unique_ptr<TrackerTerm> tracker;
  for (OrientationGroup& group : groups_) {
    const auto first = terms_.begin() + static_cast<std::ptrdiff_t>(group.term);
    const auto last = first + static_cast<std::ptrdiff_t>(group.count);
    const bool has_changed = std::any_of(first, last, [](const OrientationTerm& term) {
      return term.is_known && term.active != term.was_active;
    });
    if (has_changed) {
      if (!tracker) {
        tracker = std::make_unique<TrackerTerm>(model_, places_, linearized_at_);
      }
      sumUp(*tracker, group);
    }
  }
}

InformationSum OrientationTerms::sum(const Eigen::VectorXd& x) {
  sumUpWhatChanged();
  InformationSum sum(static_cast<Eigen::Index>(coordinates_.size()));
  std::vector<Eigen::Index> all(coordinates_.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n] = static_cast<Eigen::Index>(n);
  }
  for (const OrientationGroup& group : groups_) {
    if (!group.held_out) {
      sum.addAt(all, group.sum);
    }
  }
  sum.moveBy(apart(x));
  return sum;
}

std::map<std::size_t, OrientationMean> OrientationTerms::heldOut(const Eigen::VectorXd& x) {
  sumUpWhatChanged();
  std::map<std::size_t, OrientationMean> means;
  for (const OrientationGroup& group : groups_) {
    if (group.held_out && group.mean.count > 0.0) {
      means[group.window].add(group.mean);
    }
  }
  for (auto& [window, mean] : means) {
    mean.residual = residualAt(x, mean);
  }
  return means;
}

WindowMeansMisfit OrientationTerms::misfit(const Eigen::VectorXd& x, double coordinates) const {
  WindowMeansMisfit misfit;
  std::vector<CellMean> cells;
  for (std::size_t n = 0; n < groups_.size();) {
    OrientationMean mean;
    const std::size_t cell = groups_[n].cell;
    const std::size_t span = groups_[n].span;
    for (; n < groups_.size() && groups_[n].cell == cell; ++n) {
      if (!groups_[n].held_out && groups_[n].mean.count > 0.0) {
        mean.add(groups_[n].mean);
      }
    }
    if (mean.count > 0.0) {
      cells.push_back({span, cell, residualAt(x, mean) / std::sqrt(mean.count)});
      misfit.squares += cells.back().residual.squaredNorm();
      misfit.freedom += 3.0;
    }
  }
  if (misfit.freedom <= 2.0 * coordinates) {
    return {};
  }
  misfit.freedom -= coordinates;
  misfit.next_alike = correlation(cells, 1);
  for (std::size_t lag = 1; lag <= kMostLag; ++lag) {
    misfit.alike = std::max(misfit.alike, std::abs(correlation(cells, lag)));
  }
  return misfit;
}

void OrientationTerms::admitHeldOut() {
  for (OrientationGroup& group : groups_) {
    group.held_out = false;
  }
}

}  // namespace sac
