#pragma once

#include <string>

#include <Eigen/Core>

namespace sac {

/// Bytes of 8 per number: IEEE 754 doubles, lowest byte first on every machine, matrices row by
/// row. Keeps every bit.
std::string blobOf(const Eigen::MatrixXd& matrix);

/// Inverse of blobOf(). Throws DataError when the size of the blob is another.
Eigen::MatrixXd matrixOf(const std::string& blob, Eigen::Index rows, Eigen::Index columns);

/// The same for a symmetric matrix: its lower triangle, row by row; all of it where it is not
/// symmetric to the last bit.
std::string symmetricBlobOf(const Eigen::MatrixXd& matrix);
/// The n × n matrix of such bytes. Throws DataError when their number fits neither form.
Eigen::MatrixXd symmetricOf(const std::string& blob, Eigen::Index n);

}  // namespace sac
