#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "command_comparison.hpp"

namespace sac {

/// Delay and lag by which measured currents change as what follows the commands, by stretches from
/// begin to end of a span. Where currents are sampled at the same places between two commands each
/// time, there are valleys beside the one that is looked for.
class ResponseSearch {
 public:
  explicit ResponseSearch(const CommandComparison& comparison) : comparison_(comparison) {}

  void run();
  double delay() const { return best_.place.delay; }
  double lag() const { return best_.place.lag; }
  /// Of delay and lag together, which is by how much the currents come late, by their noise and by
  /// all that fits as well: where none is sampled soon after a step nobody knows when it came.
  double latenessStddev() const { return lateness_stddev_; }

 private:
  class Objective;
  struct Place {
    double delay = 0.0;
    double lag = 0.0;

    double lateness() const { return delay + lag; }
  };
  enum class Moves { kBoth, kLag };
  struct Descent {
    Place place;
    double square = std::numeric_limits<double>::infinity();
    double variance = 0.0;  ///< of a change
    double lateness_stddev = std::numeric_limits<double>::infinity();
  };
  /// Samples that count: so many in each of some stretches.
  struct Share {
    std::size_t stretches;
    std::size_t samples;
  };

  Share shareOf(std::size_t samples) const;
  std::vector<Place> starts() const;
  Place bestBeside(const Place& place, double reach, const Share& share) const;
  Eigen::Index changesIn(const Share& share) const;
  Eigen::ArrayXd leftAt(const Place& place, const Share& share) const;
  Descent descend(const Place& start, const Share& share, Moves moves) const;
  void findSpread(const std::vector<Descent>& ends);
  Place farthest(const Descent& from, double limit, double step) const;

  const CommandComparison& comparison_;
  Descent best_;
  double lateness_stddev_ = std::numeric_limits<double>::infinity();
};

}  // namespace sac
