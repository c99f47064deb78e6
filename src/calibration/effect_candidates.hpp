#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "score_sums.hpp"

namespace sac {

/// A sum of columns, each times a factor.
using ColumnSum = std::vector<std::pair<Eigen::Index, double>>;

/// Columns that are tried together, as one thing that an estimate may lack.
struct EffectCandidate {
  std::string name;
  std::string unit;                ///< of its values
  std::string advice;              ///< what to do where it is found, to follow a colon
  std::vector<ColumnSum> columns;  ///< of each of its coordinates
  std::vector<double> scales;      ///< of each value per coordinate
};

/// All that may be there during a whole session: each vector, pole, coil and joint by itself. Of
/// what is modelled already, what is beyond its stated size.
std::vector<EffectCandidate> effectCandidates(const FurtherColumns& columns);

/// What may step in the middle of a session.
struct StepCandidate {
  std::string name;
  Eigen::Index first;  ///< column
  Eigen::Index count;
};

/// Registrations and offsets of joints.
std::vector<StepCandidate> stepCandidates(const FurtherColumns& columns);

}  // namespace sac
