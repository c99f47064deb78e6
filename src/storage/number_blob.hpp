#pragma once

#include <string>

#include <Eigen/Core>

namespace sac {

/// Bytes of 8 per number: IEEE 754 doubles, lowest byte first on every machine, matrices row by
/// row. Keeps every bit.
std::string blobOf(const Eigen::MatrixXd& matrix);

/// Inverse of blobOf(). Throws DataError when the size of the blob is another.
Eigen::MatrixXd matrixOf(const std::string& blob, Eigen::Index rows, Eigen::Index columns);

}  // namespace sac
