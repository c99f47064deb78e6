#include "score_sum.hpp"

#include <algorithm>
#include <utility>

namespace sac {
namespace {

/// The most columns that a group has.
Eigen::Index largestGroup(const std::vector<Eigen::Index>& groups) {
  Eigen::Index most = 0;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    most = std::max(most, static_cast<Eigen::Index>(k) - groups[k] + 1);
  }
  return most;
}

}  // namespace

ScoreSum::ScoreSum(Eigen::Index coordinates, std::vector<Eigen::Index> groups)
    : own_(coordinates),
      groups_(std::move(groups)),
      crossed_(Eigen::MatrixXd::Zero(coordinates, static_cast<Eigen::Index>(groups_.size()))),
      within_(Eigen::MatrixXd::Zero(largestGroup(groups_), crossed_.cols())),
      gradient_(Eigen::VectorXd::Zero(crossed_.cols())) {}

std::size_t ScoreSum::leading(const std::vector<Eigen::Index>& columns) const {
  return static_cast<std::size_t>(std::lower_bound(columns.begin(), columns.end(), coordinates()) -
                                  columns.begin());
}

/// Adds `product`(a) to what columns[b], a further one, has in common with each columns[a] before
/// it and with itself.
template <typename Product>
void ScoreSum::addFurther(const std::vector<Eigen::Index>& columns,
                          std::size_t own,
                          std::size_t b,
                          const Product& product) {
  const Eigen::Index column = columns[b] - coordinates();
  double* const sums = crossed_.col(column).data();
  for (std::size_t a = 0; a < own; ++a) {
    sums[columns[a]] += product(a);
  }
  const Eigen::Index group = groups_[static_cast<std::size_t>(column)];
  for (std::size_t a = b + 1; a-- > own;) {
    const Eigen::Index place = columns[a] - coordinates() - group;
    if (place < 0) {
      break;
    }
    within_(place, column) += product(a);
  }
}

void ScoreSum::add(const WhitenedObservation& observation, double weight) {
  const std::size_t own = leading(observation.columns);
  own_.addLeading(observation, own, weight);
  const double* const J = observation.jacobian.data();
  for (std::size_t b = own; b < observation.columns.size(); ++b) {
    const Eigen::Vector3d column = weight * observation.jacobian.col(static_cast<Eigen::Index>(b));
    gradient_[observation.columns[b] - coordinates()] += column.dot(observation.residual);
    addFurther(observation.columns, own, b, [&](std::size_t a) {
      const double* const other = J + 3 * a;
      return other[0] * column[0] + other[1] * column[1] + other[2] * column[2];
    });
  }
}

void ScoreSum::takeOff(const Eigen::Matrix<double, kSharedErrors, Eigen::Dynamic>& crossed,
                       const std::vector<Eigen::Index>& columns,
                       const Eigen::Matrix<double, kSharedErrors, kSharedErrors>& covariance,
                       double misfit) {
  const std::size_t own = leading(columns);
  const auto end = columns.begin() + static_cast<std::ptrdiff_t>(own);
  own_.takeOff(crossed, {columns.begin(), end}, covariance, misfit);
  for (std::size_t b = own; b < columns.size(); ++b) {
    const SharedErrors spent = covariance * crossed.col(columns[b]);
    addFurther(columns, own, b, [&](std::size_t a) { return -crossed.col(columns[a]).dot(spent); });
  }
}

Eigen::VectorXd ScoreSum::crossed(Eigen::Index column) const {
  return column < coordinates()
             ? Eigen::VectorXd(own_.information(std::vector<Eigen::Index>{column}).transpose())
             : Eigen::VectorXd(crossed_.col(column - coordinates()));
}

double ScoreSum::between(Eigen::Index a, Eigen::Index b) const {
  if (std::max(a, b) < coordinates()) {
    return own_.information(a, b);
  }
  const Eigen::Index later = std::max(a, b) - coordinates();
  const Eigen::Index place =
      std::min(a, b) - coordinates() - groups_[static_cast<std::size_t>(later)];
  return within_(place, later);
}

double ScoreSum::gradient(Eigen::Index column) const {
  return column < coordinates() ? own_.gradient()[column] : gradient_[column - coordinates()];
}

}  // namespace sac
