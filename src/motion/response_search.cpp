#include "response_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "spherical_actuator_calibration/estimation/damped_descent.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {
namespace {

// Samples.
constexpr std::size_t kQuick = 2400;
constexpr std::size_t kThorough = 12000;

constexpr double kLeastLag = 1e-5;  // [s]

}  // namespace

void ResponseSearch::run() {
  Descent best;
  std::vector<Descent> ends;
  for (const Place& start : starts()) {
    ends.push_back(descend(start, shareOf(kQuick), Moves::kBoth));
    if (ends.back().square < best.square) {
      best = ends.back();
    }
  }
  best_ = descend(best.place, shareOf(kThorough), Moves::kBoth);
  findSpread(ends);
}

/// How far delay and lag together may be beside what was found, with a misfit as likely as that of
/// √3 standard deviations: of noise alone it gives its standard deviation, of a stretch over which
/// nothing tells that of what is anywhere in it. There the middle is taken.
void ResponseSearch::findSpread(const std::vector<Descent>& ends) {
  const Share share = shareOf(kQuick);
  const Share thorough = shareOf(kThorough);
  const Descent here = descend(best_.place, share, Moves::kBoth);
  const double limit = here.square + 3.0 * here.variance * static_cast<double>(share.samples) /
                                         static_cast<double>(thorough.samples);
  constexpr double kLeastStep = 1e-6;  // [s]
  constexpr double kMostStep = 1e-4;   // [s]
  const double local = best_.lateness_stddev;
  const double step = std::isfinite(local) ? std::clamp(local, kLeastStep, kMostStep) : kMostStep;
  Place low = farthest(here, limit, -step);
  const Place high = farthest(here, limit, step);
  // Where a lag is too short to be seen it may as well be none.
  const Place at_once{low.delay, kLeastLag};
  if (leftAt(at_once, share).square().sum() <= limit) {
    low = at_once;
  }
  double most = 0.5 * std::abs(high.lateness() - low.lateness());
  const auto include = [&](const Place& place) {
    most = std::max(most, std::abs(place.lateness() - best_.place.lateness()));
  };
  if (!(most < 3.0 * local)) {
    const Place middle{0.5 * (low.delay + high.delay), here.place.lag};
    best_.place = descend(middle, share, Moves::kLag).place;
    include(low);
    include(high);
  }
  for (const Descent& end : ends) {
    if (end.square <= limit) {
      include(end.place);
    }
  }
  lateness_stddev_ = most / std::sqrt(3.0);
}

/// With later or earlier delays, and the lag that suits each, the last one below a misfit.
ResponseSearch::Place ResponseSearch::farthest(const Descent& from,
                                               double limit,
                                               double step) const {
  constexpr int kBisections = 5;
  constexpr double kEnd = 0.1;  // [s]
  Place reached = from.place;
  const auto goes = [&] {
    const Place start{reached.delay + step, reached.lag};
    const Descent next = descend(start, shareOf(kQuick), Moves::kLag);
    if (!(next.square <= limit) || std::abs(next.place.delay) > kEnd) {
      return false;
    }
    reached = next.place;
    return true;
  };
  while (goes()) {
    step *= 2.0;
  }
  for (int n = 0; n < kBisections; ++n) {
    step *= 0.5;
    goes();
  }
  return reached;
}

ResponseSearch::Share ResponseSearch::shareOf(std::size_t samples) const {
  constexpr std::size_t kStretches = 6;
  return {kStretches, std::min(samples, comparison_.commanded().count()) / kStretches};
}

/// The best few of a grid, no neighbours, by a stretch in the middle.
std::vector<ResponseSearch::Place> ResponseSearch::starts() const {
  constexpr double kLargest = 0.07;                                  // [s]
  constexpr double kStep = 1e-3;                                     // [s]
  constexpr std::array<double, 4> kLags{0.5e-3, 2e-3, 6e-3, 20e-3};  // [s]
  constexpr std::size_t kSamples = 400;
  constexpr std::size_t kMost = 5;
  const Share share{1, std::min(kSamples, comparison_.commanded().count())};
  std::vector<Descent> all;
  for (const double lag : kLags) {
    for (double delay = -kLargest; delay <= kLargest; delay += kStep) {
      Descent one;
      one.place = {delay, lag};
      one.square = leftAt(one.place, share).square().sum();
      all.push_back(one);
    }
  }
  std::sort(all.begin(), all.end(), [](const Descent& one, const Descent& other) {
    return one.square < other.square;
  });
  std::vector<Place> chosen;
  for (auto one = all.begin(); one != all.end() && chosen.size() < kMost; ++one) {
    const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const Place& other) {
      return std::abs(one->place.delay - other.delay) < 1.5 * kStep;
    });
    if (is_new) {
      chosen.push_back(one->place);
    }
  }
  for (Place& place : chosen) {
    place = bestBeside(place, kStep, share);
  }
  return chosen;
}

/// Where a command comes to a sample the misfit has a kink, and a descent may stay on one side.
ResponseSearch::Place ResponseSearch::bestBeside(const Place& place,
                                                 double reach,
                                                 const Share& share) const {
  constexpr int kSteps = 4;
  constexpr std::array<double, 7> kFactors{0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8};
  Place best = place;
  double least = std::numeric_limits<double>::infinity();
  for (int n = -kSteps; n <= kSteps; ++n) {
    for (const double factor : kFactors) {
      const Place beside{place.delay + n * reach / kSteps, factor * place.lag};
      const double square = leftAt(beside, share).square().sum();
      if (square < least) {
        least = square;
        best = beside;
      }
    }
  }
  return best;
}

Eigen::Index ResponseSearch::changesIn(const Share& share) const {
  return comparison_.coils() * static_cast<Eigen::Index>(share.stretches * (share.samples - 1));
}

Eigen::ArrayXd ResponseSearch::leftAt(const Place& place, const Share& share) const {
  const Eigen::Index coils = comparison_.coils();
  Eigen::ArrayXd all(changesIn(share));
  Eigen::Index next = 0;
  const SampleRange all_samples = comparison_.commanded();
  const std::size_t rest = all_samples.count() - share.samples;
  for (std::size_t n = 0; n < share.stretches; ++n) {
    const std::size_t begin =
        all_samples.begin + (share.stretches == 1 ? rest / 2 : rest * n / (share.stretches - 1));
    comparison_.visit(place.delay,
                      place.lag,
                      {begin, begin + share.samples},
                      [&](const Eigen::ArrayXd& change, const Eigen::ArrayXd& expected) {
                        all.segment(next, coils) = change - expected;
                        next += coils;
                      });
  }
  return all;
}

/// Squares of what is left of the changes, by delay and lag or by the lag alone.
class ResponseSearch::Objective {
 public:
  using Point = Place;

  Objective(const ResponseSearch& search, const Share& share, Moves moves)
      : search_(search), share_(share), moves_(moves) {}

  double cost(const Place& at) const { return search_.leftAt(at, share_).square().sum(); }

  NormalEquations normalEquations(const Place& at) const {
    constexpr double kDifference = 1e-6;  // [s]
    const Eigen::VectorXd left = search_.leftAt(at, share_);
    const auto by = [&](double delay, double lag) -> Eigen::VectorXd {
      const Place aside{at.delay + delay, at.lag + lag};
      return (search_.leftAt(aside, share_).matrix() - left) / kDifference;
    };
    Eigen::MatrixXd jacobian(left.size(), moves_ == Moves::kBoth ? 2 : 1);
    jacobian.col(0) = by(0.0, kDifference);
    if (moves_ == Moves::kBoth) {
      jacobian.col(1) = by(kDifference, 0.0);
    }
    InformationSum sum(jacobian.cols());
    sum.addDense(jacobian, left);
    return {sum.squaredMisfit(), sum.gradient(), sum.information()};
  }

  Place moved(const Place& from, const Eigen::VectorXd& step) const {
    return {from.delay + (moves_ == Moves::kBoth ? step[1] : 0.0),
            std::max(kLeastLag, from.lag + step[0])};
  }

  static double nothing(const Place& /*at*/) {
    return 1e-7;  // [s]
  }

 private:
  const ResponseSearch& search_;
  const Share share_;
  const Moves moves_;
};

ResponseSearch::Descent ResponseSearch::descend(const Place& start,
                                                const Share& share,
                                                Moves moves) const {
  DescentOptions options;
  options.max_iterations = 25;
  options.first_damping = 1e-2;
  std::vector<Place> path{start};
  Objective objective(*this, share, moves);
  sac::descend(objective, options, path);
  const NormalEquations end = objective.normalEquations(path.back());
  Descent descent;
  descent.place = path.back();
  descent.square = end.cost;
  descent.variance = end.cost / static_cast<double>(changesIn(share));
  descent.lateness_stddev = std::sqrt(descent.variance * end.information.inverse().sum());
  return descent;
}

}  // namespace sac
