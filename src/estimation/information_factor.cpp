#include "spherical_actuator_calibration/estimation/information_factor.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace sac {
namespace {

/// Below, a whole factorisation costs less than to look for islands.
constexpr Eigen::Index kFewCoordinates = 128;
/// Coordinates that meet more than this share of all are of the border.
constexpr double kManyMet = 0.125;
constexpr std::size_t kLargestIsland = 16;

// Of a coordinate, while islands are found.
enum State { kOpen, kBorder, kTaken };

/// Whether columns have something at some places.
bool touches(const Eigen::MatrixXd& columns, const std::vector<Eigen::Index>& places) {
  return std::any_of(places.begin(), places.end(), [&](Eigen::Index p) {
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      if (columns(p, k) != 0.0) {
        return true;
      }
    }
    return false;
  });
}

}  // namespace

InformationFactor::InformationFactor(const Eigen::MatrixXd& information,
                                     const Eigen::VectorXd& more) {
  if (!findIslands(information) || !factorise(information, more)) {
    islands_.clear();
    border_.resize(static_cast<std::size_t>(information.rows()));
    std::iota(border_.begin(), border_.end(), 0);
    factorise(information, more);
  }
}

/// False: an island is not positive definite, and there is no factor.
bool InformationFactor::factorise(const Eigen::MatrixXd& information, const Eigen::VectorXd& more) {
  Eigen::MatrixXd rest = information(border_, border_);
  rest.diagonal() += more(border_);
  for (Island& island : islands_) {
    const auto size = static_cast<Eigen::Index>(island.places.size());
    Eigen::MatrixXd block = information(island.places, island.places);
    block.diagonal() += more(island.places);
    const Cholesky factor(block);
    if (!factor.isPositive()) {
      return false;
    }
    const Eigen::MatrixXd crossed = information(island.places, border_);
    island.half = factor.half(Eigen::MatrixXd::Identity(size, size));
    island.inverse = factor.inverse();
    island.to_border = factor.solve(crossed);
    rest.noalias() -= crossed.transpose() * island.to_border;
  }
  rest_ = Cholesky(rest);
  return true;
}

/// False: there are none worth it.
bool InformationFactor::findIslands(const Eigen::MatrixXd& information) {
  const Eigen::Index size = information.rows();
  if (size < kFewCoordinates) {
    return false;
  }
  state_.assign(static_cast<std::size_t>(size), kOpen);
  const double many = kManyMet * static_cast<double>(size);
  for (Eigen::Index p = 0; p < size; ++p) {
    const auto met = (information.col(p).array() != 0.0).count();
    if (static_cast<double>(met) > many) {
      state_[static_cast<std::size_t>(p)] = kBorder;
      border_.push_back(p);
    }
  }
  if (2 * border_.size() > static_cast<std::size_t>(size)) {
    return false;
  }
  for (std::size_t p = 0; p < state_.size(); ++p) {
    if (state_[p] == kOpen) {
      takeIsland(information, p);
      if (islands_.back().places.size() > kLargestIsland) {
        return false;
      }
    }
  }
  return true;
}

/// All that is connected with a coordinate other than by the border.
void InformationFactor::takeIsland(const Eigen::MatrixXd& information, std::size_t first) {
  std::vector<Eigen::Index> places{static_cast<Eigen::Index>(first)};
  state_[first] = kTaken;
  for (std::size_t n = 0; n < places.size() && places.size() <= kLargestIsland; ++n) {
    const Eigen::Index from = places[n];
    for (std::size_t p = 0; p < state_.size(); ++p) {
      const auto place = static_cast<Eigen::Index>(p);
      if (state_[p] == kOpen && information(place, from) != 0.0) {
        state_[p] = kTaken;
        places.push_back(place);
      }
    }
  }
  islands_.push_back({std::move(places), {}, {}, {}});
}

Eigen::VectorXd InformationFactor::solve(const Eigen::VectorXd& right) const {
  Eigen::VectorXd of_border = right(border_);
  for (const Island& island : islands_) {
    of_border.noalias() -= island.to_border.transpose() * right(island.places);
  }
  of_border = rest_.solve(of_border);
  Eigen::VectorXd result(right.size());
  result(border_) = of_border;
  for (const Island& island : islands_) {
    result(island.places) = island.inverse * right(island.places) - island.to_border * of_border;
  }
  return result;
}

Eigen::MatrixXd InformationFactor::half(const Eigen::MatrixXd& columns) const {
  if (islands_.empty()) {
    return rest_.half(columns);
  }
  Eigen::MatrixXd of_border = columns(border_, Eigen::all);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  for (const Island& island : islands_) {
    if (touches(columns, island.places)) {
      const Eigen::MatrixXd own = columns(island.places, Eigen::all);
      of_border.noalias() -= island.to_border.transpose() * own;
      result(island.places, Eigen::all) = island.half * own;
    }
  }
  result(border_, Eigen::all) = rest_.half(of_border);
  return result;
}

Eigen::MatrixXd InformationFactor::inverse() const {
  const auto of_border = static_cast<Eigen::Index>(border_.size());
  Eigen::MatrixXd rest = rest_.inverse();
  if (islands_.empty()) {
    return rest;
  }
  std::vector<Eigen::Index> places;
  for (const Island& island : islands_) {
    places.insert(places.end(), island.places.begin(), island.places.end());
  }
  const auto of_islands = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd to_border(of_islands, of_border);
  Eigen::Index row = 0;
  for (const Island& island : islands_) {
    to_border.middleRows(row, island.to_border.rows()) = island.to_border;
    row += island.to_border.rows();
  }
  const Eigen::MatrixXd crossed = to_border * rest;
  Eigen::MatrixXd own = crossed * to_border.transpose();
  row = 0;
  for (const Island& island : islands_) {
    const Eigen::Index size = island.inverse.rows();
    own.block(row, row, size, size) += island.inverse;
    row += size;
  }
  Eigen::MatrixXd result(of_border + of_islands, of_border + of_islands);
  result(border_, border_) = rest;
  result(places, border_) = -crossed;
  result(border_, places) = -crossed.transpose();
  result(places, places) = own;
  return result;
}

}  // namespace sac
