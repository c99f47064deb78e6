#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

#include <numeric>
#include <utility>

#include "spherical_actuator_calibration/base/cholesky.hpp"

namespace sac {

ChosenCoordinates::ChosenCoordinates(Eigen::Index all, const std::vector<Eigen::Index>& chosen)
    : places_(static_cast<std::size_t>(all), -1), size_(static_cast<Eigen::Index>(chosen.size())) {
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    places_[static_cast<std::size_t>(chosen[k])] = static_cast<Eigen::Index>(k);
  }
}

ChosenCoordinates ChosenCoordinates::all(Eigen::Index size) {
  std::vector<Eigen::Index> every(static_cast<std::size_t>(size));
  std::iota(every.begin(), every.end(), 0);
  return {size, every};
}

std::vector<bool> ChosenCoordinates::others() const {
  std::vector<bool> others;
  others.reserve(places_.size());
  for (const Eigen::Index place : places_) {
    others.push_back(place < 0);
  }
  return others;
}

Eigen::Matrix3d whiteningOf(const Eigen::Matrix3d& covariance) {
  return Cholesky3(covariance).half(Eigen::Matrix3d::Identity());
}

Eigen::Matrix<double, Eigen::Dynamic, 3> WhitenedObservation::timesTransposed(
    const Eigen::MatrixXd& M) const {
  Eigen::Matrix<double, Eigen::Dynamic, 3> product(M.rows(), 3);
  product.setZero();
  for (std::size_t k = 0; k < columns.size(); ++k) {
    product.noalias() += M.col(columns[k]) * jacobian.col(static_cast<Eigen::Index>(k)).transpose();
  }
  return product;
}

Eigen::Matrix3d WhitenedObservation::times(
    const Eigen::Matrix<double, Eigen::Dynamic, 3>& M) const {
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < columns.size(); ++k) {
    product.noalias() += jacobian.col(static_cast<Eigen::Index>(k)) * M.row(columns[k]);
  }
  return product;
}

void whiten(const LinearizedObservation& linear,
            const Eigen::Matrix3d& whitening,
            const ChosenCoordinates& chosen,
            WhitenedObservation& out) {
  out.residual = whitening * linear.residual;
  out.columns.clear();
  if (out.jacobian.cols() < static_cast<Eigen::Index>(linear.columns.size())) {
    out.jacobian.resize(3, static_cast<Eigen::Index>(linear.columns.size()));
  }
  for (const Eigen::Index p : linear.columns) {
    const Eigen::Index place = chosen.place(p);
    if (place >= 0) {
      out.jacobian.col(static_cast<Eigen::Index>(out.columns.size())) =
          whitening * linear.jacobian.col(p);
      out.columns.push_back(place);
    }
  }
}

InformationSum::InformationSum(Eigen::Index size)
    : InformationSum(Eigen::MatrixXd(Eigen::MatrixXd::Zero(size, size))) {}

InformationSum::InformationSum(Eigen::MatrixXd known)
    : upper_(std::move(known)), gradient_(Eigen::VectorXd::Zero(upper_.rows())) {}

void InformationSum::addLeading(const WhitenedObservation& observation,
                                std::size_t count,
                                double weight) {
  const std::vector<Eigen::Index>& columns = observation.columns;
  squared_misfit_ += weight * observation.residual.squaredNorm();
  const double* const J = observation.jacobian.data();
  for (std::size_t b = 0; b < count; ++b) {
    const Eigen::Vector3d column = weight * observation.jacobian.col(static_cast<Eigen::Index>(b));
    gradient_[columns[b]] += column.dot(observation.residual);
    double* const sums = upper_.col(columns[b]).data();
    for (std::size_t a = 0; a <= b; ++a) {
      const double* const other = J + 3 * a;
      sums[columns[a]] += other[0] * column[0] + other[1] * column[1] + other[2] * column[2];
    }
  }
}

void InformationSum::addAt(const std::vector<Eigen::Index>& places, const InformationSum& other) {
  for (std::size_t b = 0; b < places.size(); ++b) {
    for (std::size_t a = 0; a <= b; ++a) {
      upper_(places[a], places[b]) +=
          other.upper_(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
    }
  }
  gradient_(places) += other.gradient_;
  squared_misfit_ += other.squared_misfit_;
}

void InformationSum::moveBy(const Eigen::VectorXd& step) {
  const Eigen::VectorXd change = upper_.selfadjointView<Eigen::Upper>() * step;
  squared_misfit_ += step.dot(2.0 * gradient_ + change);
  gradient_ += change;
}

InformationSum InformationSum::at(const std::vector<Eigen::Index>& places) const {
  InformationSum chosen(upper_(places, places));
  chosen.gradient_ = gradient_(places);
  chosen.squared_misfit_ = squared_misfit_;
  return chosen;
}

Eigen::MatrixXd InformationSum::information() const {
  return upper_.selfadjointView<Eigen::Upper>();
}

Eigen::MatrixXd InformationSum::information(const std::vector<Eigen::Index>& rows) const {
  Eigen::MatrixXd chosen(static_cast<Eigen::Index>(rows.size()), upper_.cols());
  for (Eigen::Index n = 0; n < chosen.rows(); ++n) {
    const Eigen::Index row = rows[static_cast<std::size_t>(n)];
    chosen.row(n).head(row) = upper_.col(row).head(row).transpose();
    chosen.row(n).tail(upper_.cols() - row) = upper_.row(row).tail(upper_.cols() - row);
  }
  return chosen;
}

}  // namespace sac
