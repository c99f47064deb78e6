#include "wiring_case.hpp"

#include <algorithm>

namespace sac {

Eigen::VectorXd startOf(const Candidate& candidate) {
  Eigen::Index size = 0;
  for (const Hypothesis& part : candidate) {
    size += part.start.size();
  }
  Eigen::VectorXd values(size);
  Eigen::Index at = 0;
  for (const Hypothesis& part : candidate) {
    values.segment(at, part.start.size()) = part.start;
    at += part.start.size();
  }
  return values;
}

WiringCase corrected(const WiringCase& described,
                     const Candidate& candidate,
                     const Eigen::VectorXd& values) {
  WiringCase result = described;
  Eigen::Index at = 0;
  for (const Hypothesis& part : candidate) {
    part.correct(result, values.segment(at, part.start.size()));
    at += part.start.size();
  }
  return result;
}

double torqueFactor(const Candidate& candidate, const Eigen::VectorXd& values) {
  double factor = 1.0;
  Eigen::Index at = 0;
  for (const Hypothesis& part : candidate) {
    if (part.torque_factor) {
      factor *= part.torque_factor(values.segment(at, part.start.size()));
    }
    at += part.start.size();
  }
  return factor;
}

void keepBest(std::vector<ScreenedCandidate>& candidates, std::size_t most) {
  std::stable_sort(
      candidates.begin(),
      candidates.end(),
      [](const ScreenedCandidate& a, const ScreenedCandidate& b) { return a.gain > b.gain; });
  if (candidates.size() > most) {
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(most), candidates.end());
  }
}

}  // namespace sac
