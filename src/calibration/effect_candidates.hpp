#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "further_columns.hpp"

namespace sac {

/// Columns that are tried together, as one thing that an estimate may lack.
struct EffectCandidate {
  std::string name;
  std::string unit;            ///< of its values
  std::string advice;          ///< what to do where it is found, to follow a colon
  Eigen::Index first = 0;      ///< of its columns, which follow each other
  std::vector<double> scales;  ///< of each column's value per coordinate

  Eigen::Index size() const { return static_cast<Eigen::Index>(scales.size()); }
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
