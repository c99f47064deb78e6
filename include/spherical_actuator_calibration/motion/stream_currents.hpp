#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "spherical_actuator_calibration/base/long_series.hpp"

namespace sac {

/// Currents per stamp and coil [A], used like a matrix of which rows are asked for; it grows by
/// them. Single precision: fine to a millionth of an ampere, half the memory.
class StreamCurrents {
 public:
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Row = Eigen::Map<Eigen::RowVectorXf>;
  using ConstRow = Eigen::Map<const Eigen::RowVectorXf>;

  StreamCurrents() = default;
  /// All zero.
  StreamCurrents(Eigen::Index rows, Eigen::Index coils)
      : rows_(rows), coils_(coils), values_(static_cast<std::size_t>(rows * coils), 0.0F) {}
  explicit StreamCurrents(const Matrix& rows) : StreamCurrents(rows.rows(), rows.cols()) {
    matrix() = rows;
  }

  Eigen::Index rows() const { return rows_; }
  Eigen::Index cols() const { return coils_; }
  ConstRow row(Eigen::Index n) const { return {begin(n), coils_}; }
  Row row(Eigen::Index n) { return {begin(n), coils_}; }
  float operator()(Eigen::Index n, Eigen::Index coil) const { return values_[place(n, coil)]; }
  float& operator()(Eigen::Index n, Eigen::Index coil) { return values_[place(n, coil)]; }
  // All rows at once, of few: all of it comes into the memory.
  Eigen::Map<const Matrix> matrix() const { return {values_.begin(), rows_, coils_}; }
  Eigen::Map<Matrix> matrix() { return {values_.begin(), rows_, coils_}; }

  /// Precondition: as many coils as in the rows before.
  template <typename Currents>
  void addRow(const Currents& current) {
    ++rows_;
    coils_ = current.size();
    for (Eigen::Index coil = 0; coil < coils_; ++coil) {
      values_.push_back(static_cast<float>(current[coil]));
    }
  }

  friend bool operator==(const StreamCurrents& one, const StreamCurrents& other) {
    return one.rows_ == other.rows_ && one.coils_ == other.coils_ && one.values_ == other.values_;
  }
  friend bool operator!=(const StreamCurrents& one, const StreamCurrents& other) {
    return !(one == other);
  }

 private:
  const float* begin(Eigen::Index n) const { return coils_ == 0 ? nullptr : &values_[place(n)]; }
  float* begin(Eigen::Index n) { return coils_ == 0 ? nullptr : &values_[place(n)]; }
  std::size_t place(Eigen::Index n, Eigen::Index coil = 0) const {
    return static_cast<std::size_t>(n * coils_ + coil);
  }

  Eigen::Index rows_ = 0;
  Eigen::Index coils_ = 0;
  LongSeries<float> values_;
};

}  // namespace sac
