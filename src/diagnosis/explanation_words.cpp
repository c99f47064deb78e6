#include "explanation_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "spherical_actuator_calibration/base/normal_distribution.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/text_format.hpp"

namespace sac {
namespace {

double apart(const ParameterEstimate& estimate) {
  return std::abs(estimate.value - estimate.nominal);
}

std::string valueInWords(const ParameterEstimate& estimate) {
  if (estimate.unit == "1") {
    constexpr double kFewest = 2.0;
    constexpr double kMost = 6.0;
    const double to_first_digit = std::ceil(-std::log10(1e2 * estimate.stddev));
    const auto decimals = static_cast<int>(std::min(std::max(to_first_digit, kFewest), kMost));
    return format("%s = %.*f %% ± %.*f %%",
                  estimate.name.c_str(),
                  decimals,
                  1e2 * estimate.value,
                  decimals,
                  1e2 * estimate.stddev);
  }
  return format("%s = %.3g ± %.2g %s",
                estimate.name.c_str(),
                estimate.value,
                estimate.stddev,
                estimate.unit.c_str());
}

}  // namespace

std::string numberText(std::size_t index) {
  return std::to_string(numberOf(index));
}

bool isSignificant(const ParameterEstimate& estimate) {
  return estimate.stddev > 0.0 && apart(estimate) > kSignificant * estimate.stddev;
}

std::string valuesInWords(std::vector<ParameterEstimate> estimates) {
  std::stable_sort(estimates.begin(),
                   estimates.end(),
                   [](const ParameterEstimate& a, const ParameterEstimate& b) {
                     return apart(a) * b.stddev > apart(b) * a.stddev;
                   });
  constexpr std::size_t kMostShown = 3;
  std::string text;
  for (std::size_t n = 0; n < std::min(estimates.size(), kMostShown); ++n) {
    text += (n == 0 ? "" : ", ") + valueInWords(estimates[n]);
  }
  return estimates.size() > kMostShown ? text + ", …" : text;
}

std::string explainsInWords(double reduced_chi_square_before, double reduced_chi_square_with) {
  return format(
      " explains it: chi-square %.3g → %.3g.", reduced_chi_square_before, reduced_chi_square_with);
}

}  // namespace sac
