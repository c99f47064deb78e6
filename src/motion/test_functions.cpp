#include "spherical_actuator_calibration/motion/test_functions.hpp"

#include <array>

namespace sac {
namespace {

constexpr std::size_t kMostPolynomials = 28;
using Polynomials = std::array<double, kMostPolynomials>;

/// Of P_{n+1} = grow s P_n − fade P_{n−1}, and of ∫P_n from −1, which is (P_{n+1} − P_{n−1}) width:
/// made once, as divisions would take most of the time.
struct Recursion {
  Polynomials grow{};
  Polynomials fade{};
  Polynomials width{};
};

constexpr Recursion kRecursion = [] {
  Recursion recursion;
  for (std::size_t n = 0; n < kMostPolynomials; ++n) {
    const auto k = static_cast<double>(n);
    recursion.grow[n] = (2.0 * k + 1.0) / (k + 1.0);
    recursion.fade[n] = k / (k + 1.0);
    recursion.width[n] = 1.0 / (2.0 * k + 1.0);
  }
  return recursion;
}();

/// P_0…P_last at s.
Polynomials legendre(double s, std::size_t last) {
  Polynomials P{1.0, s};
  for (std::size_t n = 1; n < last; ++n) {
    P[n + 1] = kRecursion.grow[n] * s * P[n] - kRecursion.fade[n] * P[n - 1];
  }
  return P;
}

}  // namespace

TestFunctions::TestFunctions(double begin, double end, int count)
    : middle_(0.5 * (begin + end)), half_(0.5 * (end - begin)), count_(count) {}

void TestFunctions::evaluate(double time, TestFunctionValues& out) const {
  const double s = (time - middle_) / half_;
  const Polynomials P = legendre(s, static_cast<std::size_t>(count_) + 3);
  const Polynomials& width = kRecursion.width;
  const double per_time = 1.0 / half_;
  out.value.resize(count_);
  out.first.resize(count_);
  for (int i = 0; i < count_; ++i) {
    const auto n = static_cast<std::size_t>(i) + 2;
    // The integral from −1, and once more.
    out.first[i] = per_time * width[n] * (P[n + 1] - P[n - 1]);
    out.value[i] = width[n] * (width[n + 1] * (P[n + 2] - P[n]) - width[n - 1] * (P[n] - P[n - 2]));
  }
}

void TestFunctions::evaluate(double time, TestFunctionBends& out) const {
  const double s = (time - middle_) / half_;
  const auto last = static_cast<std::size_t>(count_) + 1;
  const Polynomials P = legendre(s, last);
  Polynomials slopes{0.0, 1.0};
  for (std::size_t n = 1; n < last; ++n) {
    slopes[n + 1] = slopes[n - 1] + (2.0 * static_cast<double>(n) + 1.0) * P[n];
  }
  const double per_time = 1.0 / half_;
  out.second.resize(count_);
  out.third.resize(count_);
  for (int i = 0; i < count_; ++i) {
    const auto n = static_cast<std::size_t>(i) + 2;
    out.second[i] = per_time * per_time * P[n];
    out.third[i] = per_time * per_time * per_time * slopes[n];
  }
}

double TestFunctions::integralOfFirst() const {
  // φ_2 = (1 − s²)²/8, whose integral over s from −1 to 1 is 2/15.
  return half_ * 2.0 / 15.0;
}

}  // namespace sac
