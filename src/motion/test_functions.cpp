#include "test_functions.hpp"

#include <array>

namespace sac {
namespace {

constexpr int kMostFunctions = 24;
using Polynomials = std::array<double, kMostFunctions + 4>;

}  // namespace

TestFunctions::TestFunctions(double begin, double end, int count)
    : middle_(0.5 * (begin + end)), half_(0.5 * (end - begin)), count_(count) {}

void TestFunctions::evaluate(double time, TestFunctionValues& out) const {
  const double s = (time - middle_) / half_;
  const auto last = static_cast<std::size_t>(count_) + 3;
  Polynomials P{1.0, s};
  Polynomials slopes{0.0, 1.0};
  for (std::size_t n = 1; n < last; ++n) {
    const auto k = static_cast<double>(n);
    P[n + 1] = ((2.0 * k + 1.0) * s * P[n] - k * P[n - 1]) / (k + 1.0);
    slopes[n + 1] = slopes[n - 1] + (2.0 * k + 1.0) * P[n];
  }
  out.value.resize(count_);
  out.first.resize(count_);
  out.second.resize(count_);
  out.third.resize(count_);
  for (int i = 0; i < count_; ++i) {
    const auto n = static_cast<std::size_t>(i) + 2;
    const auto k = static_cast<double>(n);
    // ∫P_k = (P_{k+1} − P_{k−1})/(2k+1) from −1, and once more.
    const double once = (P[n + 1] - P[n - 1]) / (2.0 * k + 1.0);
    const double twice =
        ((P[n + 2] - P[n]) / (2.0 * k + 3.0) - (P[n] - P[n - 2]) / (2.0 * k - 1.0)) /
        (2.0 * k + 1.0);
    out.value[i] = twice;
    out.first[i] = once / half_;
    out.second[i] = P[n] / (half_ * half_);
    out.third[i] = slopes[n] / (half_ * half_ * half_);
  }
}

double TestFunctions::integralOfFirst() const {
  // φ_2 = (1 − s²)²/8, whose integral over s from −1 to 1 is 2/15.
  return half_ * 2.0 / 15.0;
}

}  // namespace sac
