#include "number_blob.hpp"

#include <cstddef>

#include "number_bytes.hpp"
#include "row_access.hpp"

namespace sac {
namespace {

constexpr std::size_t kBytes = sizeof(double);

}  // namespace

std::string blobOf(const Eigen::MatrixXd& matrix) {
  std::string blob;
  blob.reserve(static_cast<std::size_t>(matrix.size()) * kBytes);
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      appendNumber(blob, matrix(row, column));
    }
  }
  return blob;
}

Eigen::MatrixXd matrixOf(const std::string& blob, Eigen::Index rows, Eigen::Index columns) {
  if (blob.size() != static_cast<std::size_t>(rows * columns) * kBytes) {
    throw RowDefect("a stored matrix has not the size of its parameters");
  }
  Eigen::MatrixXd matrix(rows, columns);
  std::size_t offset = 0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index column = 0; column < columns; ++column) {
      matrix(row, column) = numberAt<double>(blob, offset);
      offset += kBytes;
    }
  }
  return matrix;
}

std::string symmetricBlobOf(const Eigen::MatrixXd& matrix) {
  std::string whole = blobOf(matrix);
  if (whole != blobOf(matrix.transpose())) {
    return whole;
  }
  std::string blob;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column <= row; ++column) {
      appendNumber(blob, matrix(row, column));
    }
  }
  return blob;
}

Eigen::MatrixXd symmetricOf(const std::string& blob, Eigen::Index n) {
  if (blob.size() != static_cast<std::size_t>(n * (n + 1) / 2) * kBytes) {
    return matrixOf(blob, n, n);
  }
  Eigen::MatrixXd matrix(n, n);
  std::size_t offset = 0;
  for (Eigen::Index row = 0; row < n; ++row) {
    for (Eigen::Index column = 0; column <= row; ++column) {
      matrix(row, column) = numberAt<double>(blob, offset);
      matrix(column, row) = matrix(row, column);
      offset += kBytes;
    }
  }
  return matrix;
}

}  // namespace sac
