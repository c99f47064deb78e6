#include "wiring_case.hpp"

#include <algorithm>

namespace sac {

std::multiset<std::string> family(const Candidate& parts) {
  std::multiset<std::string> families;
  for (const Hypothesis& part : parts) {
    families.insert(part.family);
  }
  return families;
}

std::string causes(const Candidate& parts) {
  std::string text;
  for (const Hypothesis& part : parts) {
    text += (text.empty() ? "" : " with ") + part.cause;
  }
  return text;
}

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

std::vector<ScreenedCandidate> simplerOnes(const std::vector<ScreenedCandidate>& all) {
  std::vector<ScreenedCandidate> simpler;
  for (const ScreenedCandidate& candidate : all) {
    if (candidate.parts.size() == 1) {
      for (const Hypothesis& one : candidate.parts.front().simpler) {
        simpler.push_back({{one}, candidate.gain});
      }
    }
  }
  return simpler;
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
