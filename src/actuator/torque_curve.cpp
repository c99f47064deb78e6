#include "spherical_actuator_calibration/actuator/torque_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pi.hpp"

namespace sac {
namespace {

double radiansPerUnit(AngleUnit unit) {
  return unit == AngleUnit::kDegree ? kOneDegree : 1.0;
}

bool areFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// Whether the curve goes through zero as an odd function does.
bool isOddAtZero(const TorqueTable& table) {
  return table.angles.front() == 0.0 && table.torques.front() == 0.0;
}

void validateTable(const TorqueTable& table) {
  const std::size_t points = table.angles.size();
  if (table.torques.size() != points ||
      (!table.stddevs.empty() && table.stddevs.size() != points)) {
    throw ConfigError(
        "torque_curve.table: each point needs an angle and a torque, and all or none "
        "a standard deviation.");
  }
  if (points < kFewestTablePoints || points > kMostTablePoints) {
    throw ConfigError("torque_curve.table: " + std::to_string(points) + " points; from " +
                      std::to_string(kFewestTablePoints) + " to " +
                      std::to_string(kMostTablePoints) + " are needed.");
  }
  const bool ascends =
      std::adjacent_find(table.angles.begin(), table.angles.end(), std::greater_equal<>()) ==
      table.angles.end();
  if (!areFinite(table.angles) || !areFinite(table.torques) || !areFinite(table.stddevs) ||
      !ascends || table.angles.front() < 0.0) {
    throw ConfigError(
        "torque_curve.table: numbers must be finite, angles ascend from 0 or more, each once.");
  }
  if (std::any_of(
          table.stddevs.begin(), table.stddevs.end(), [](double stddev) { return stddev < 0.0; })) {
    throw ConfigError("torque_curve.table: standard deviations must not be negative.");
  }
}

/// Points of a table that a spline goes through.
struct Knots {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// Those between blend_start and support_begin, as far as they suffice: beyond, the curve is not
/// theirs, and it may bend there as no spline does. The zero next to a blend_start that is the
/// second point, and the zero next to a support_begin that is the last but one, belong to the
/// curve.
Knots knotsOf(const TorqueCurveDescription& description) {
  const std::vector<double>& angles = description.table.angles;
  const std::size_t count = angles.size();
  Knots knots{0, count};
  if (!isOddAtZero(description.table) || description.blend_start > angles[1]) {
    knots.first = static_cast<std::size_t>(
        std::lower_bound(angles.begin(), angles.end(), description.blend_start) - angles.begin());
  }
  if (description.support_begin < angles[count - 2]) {
    knots.end = static_cast<std::size_t>(
        std::upper_bound(angles.begin(), angles.end(), description.support_begin) - angles.begin());
  }
  return knots.end >= knots.first + kFewestTablePoints ? knots : Knots{0, count};
}

/// Second derivatives of the cubic spline through the points knotsOf(), zero at the others. Its
/// third derivative goes through the knots next to the ends ("not a knot"); at the zero of an odd
/// curve its second derivative is zero. `angles` of the table [rad].
std::vector<double> splineBendings(const std::vector<double>& angles,
                                   const TorqueCurveDescription& description) {
  const Knots knots = knotsOf(description);
  const bool is_odd = knots.first == 0 && isOddAtZero(description.table);
  const double* const x = angles.data() + knots.first;
  const double* const y = description.table.torques.data() + knots.first;
  const std::size_t count = knots.end - knots.first;
  const std::size_t last = count - 1;
  std::vector<double> below(last);
  std::vector<double> diagonal(last);
  std::vector<double> above(last);
  std::vector<double> m(count, 0.0);
  const auto step = [&](std::size_t i) { return x[i + 1] - x[i]; };
  for (std::size_t i = 1; i < last; ++i) {
    below[i] = step(i - 1);
    diagonal[i] = 2.0 * (step(i - 1) + step(i));
    above[i] = step(i);
    m[i] = 6.0 * ((y[i + 1] - y[i]) / step(i) - (y[i] - y[i - 1]) / step(i - 1));
  }
  const double at_begin = step(0) / step(1);
  const double at_end = step(last - 1) / step(last - 2);
  if (!is_odd) {
    diagonal[1] += step(0) * (1.0 + at_begin);
    above[1] -= step(0) * at_begin;
  }
  diagonal[last - 1] += step(last - 1) * (1.0 + at_end);
  below[last - 1] -= step(last - 1) * at_end;
  for (std::size_t i = 2; i < last; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    m[i] -= factor * m[i - 1];
  }
  m[last - 1] /= diagonal[last - 1];
  for (std::size_t i = last - 2; i > 0; --i) {
    m[i] = (m[i] - above[i] * m[i + 1]) / diagonal[i];
  }
  m[0] = is_odd ? 0.0 : m[1] + at_begin * (m[1] - m[2]);
  m[last] = m[last - 1] + at_end * (m[last - 1] - m[last - 2]);
  std::vector<double> bendings(angles.size(), 0.0);
  std::copy(m.begin(), m.end(), bendings.begin() + static_cast<std::ptrdiff_t>(knots.first));
  return bendings;
}

/// ψ/sin ψ = arcsin(u)/(u √(1 − u²)) with u² = (1 − κ)/2 as its power series in u²: full precision
/// for κ from kSeriesCosine on, at a fifth of the time of atan2.
double angleOverSine(double kappa) {
  // c₀ = 1, cₙ = cₙ₋₁ 2n/(2n + 1)
  constexpr std::size_t kTerms = 16;
  constexpr auto kCoefficients = [] {
    std::array<double, kTerms> c{1.0};
    for (std::size_t n = 1; n < kTerms; ++n) {
      c[n] = c[n - 1] * static_cast<double>(2 * n) / static_cast<double>(2 * n + 1);
    }
    return c;
  }();
  // By halves, whose sums do not wait for each other (Estrin).
  const double z = 0.5 * (1.0 - kappa);
  std::array<double, kTerms> sums = kCoefficients;
  double power = z;
  for (std::size_t count = kTerms / 2; count > 0; count /= 2) {
    for (std::size_t n = 0; n < count; ++n) {
      sums[n] = sums[2 * n] + power * sums[2 * n + 1];
    }
    power *= power;
  }
  return sums[0];
}

/// Of an angle of 38°: what the series leaves out is below 1e-16 up to there.
constexpr double kSeriesCosine = 0.788;

}  // namespace

void completeFromTable(TorqueCurveDescription& description) {
  constexpr double kEnded = 1e-3;        // of the largest torque
  constexpr double kBeyond = 1.0 / 7.0;  // as the paper's curve ends 4° beyond 28°
  const TorqueTable& table = description.table;
  if (table.angles.size() < kFewestTablePoints || table.torques.size() != table.angles.size()) {
    return;  // for validate()
  }
  if (description.blend_start == 0.0) {
    description.blend_start = table.angles[table.angles.front() > 0.0 ? 0 : 1];
  }
  if (description.support_begin == 0.0) {
    double largest = 0.0;
    for (const double torque : table.torques) {
      largest = std::max(largest, std::abs(torque));
    }
    const double end = table.angles.back();
    const bool has_ended = std::abs(table.torques.back()) <= kEnded * largest;
    description.support_begin = has_ended ? table.angles[table.angles.size() - 2] : end;
    description.support_end = has_ended ? end : (1.0 + kBeyond) * end;
  }
}

double relativeTableStddev(const TorqueTable& table) {
  double largest = 0.0;
  double squares = 0.0;
  for (const double torque : table.torques) {
    largest = std::max(largest, std::abs(torque));
  }
  for (const double stddev : table.stddevs) {
    squares += stddev * stddev;
  }
  return table.stddevs.empty() || largest == 0.0
             ? 0.0
             : std::sqrt(squares / static_cast<double>(table.stddevs.size())) / largest;
}

void validate(const TorqueCurveDescription& description) {
  if (description.coefficients.empty() && description.table.empty()) {
    throw ConfigError("torque_curve.coefficients: at least one coefficient is needed.");
  }
  if (!areFinite(description.coefficients)) {
    throw ConfigError("torque_curve.coefficients: every coefficient must be finite.");
  }
  // First, as the angles below may be those of the table.
  const TorqueTable& table = description.table;
  if (!table.empty()) {
    validateTable(table);
  }
  const double scale = radiansPerUnit(description.angle_unit);
  const bool ordered =
      0.0 < description.blend_start && description.blend_start < description.support_begin &&
      description.support_begin < description.support_end && description.support_end * scale < kPi;
  if (!ordered) {
    throw ConfigError(
        "torque_curve: angles must satisfy 0 < blend_start < support[0] < support[1] < 180 deg.");
  }
  if (!table.empty() && (description.blend_start < table.angles.front() ||
                         description.support_begin > table.angles.back())) {
    throw ConfigError("torque_curve.table: its angles must reach from blend_start to support[0].");
  }
}

TorqueCurve::TorqueCurve(const TorqueCurveDescription& description) : description_(description) {
  validate(description);
  const double scale = radiansPerUnit(description.angle_unit);
  blend_start_ = description.blend_start * scale;
  support_begin_ = description.support_begin * scale;
  support_end_ = description.support_end * scale;
  cos_support_end_ = std::cos(support_end_);
  coefficients_ = description.coefficients;
  double unit_power = 1.0;
  for (double& coefficient : coefficients_) {
    coefficient /= unit_power;
    unit_power *= scale;
  }
  if (!description.table.empty()) {
    for (const double angle : description.table.angles) {
      knots_.push_back(angle * scale);
    }
    bendings_ = splineBendings(knots_, description);
  }
  // k₁ψ + k₃ψ³ meets value and slope of the described curve at the blend angle b.
  const double b = blend_start_;
  const Point blend = described(b);
  k3_ = (blend.slope * b - blend.value) / (2.0 * b * b * b);
  k1_ = blend.value / b - k3_ * b * b;
  const Point edge = described(support_begin_);
  edge_value_ = edge.value;
  edge_slope_ = edge.slope;
}

TorqueCurve::Point TorqueCurve::described(double psi) const {
  Point point = knots_.empty() ? Point{} : spline(psi);
  // Even and odd powers by themselves, whose sums do not wait for each other.
  const double square = psi * psi;
  std::size_t n = coefficients_.size();
  double even = n % 2 == 1 ? coefficients_[--n] : 0.0;
  double odd = 0.0;
  double d_even = 0.0;
  double d_odd = 0.0;
  for (; n > 0; n -= 2) {
    d_even = d_even * square + even;
    d_odd = d_odd * square + odd;
    even = even * square + coefficients_[n - 2];
    odd = odd * square + coefficients_[n - 1];
  }
  point.value += even + psi * odd;
  point.slope += odd + 2.0 * psi * (d_even + psi * d_odd);
  return point;
}

TorqueCurve::Point TorqueCurve::spline(double psi) const {
  const Knots knots = knotsOf(description_);
  const auto begin = knots_.begin() + static_cast<std::ptrdiff_t>(knots.first) + 1;
  const auto end = knots_.begin() + static_cast<std::ptrdiff_t>(knots.end) - 1;
  const auto above = std::upper_bound(begin, end, psi);
  const auto i = static_cast<std::size_t>(above - knots_.begin()) - 1;
  const std::vector<double>& f = description_.table.torques;
  const double h = knots_[i + 1] - knots_[i];
  const double from = psi - knots_[i];
  const double to = knots_[i + 1] - psi;
  const double at = bendings_[i];
  const double next = bendings_[i + 1];
  Point point;
  point.value = (at * to * to * to + next * from * from * from) / (6.0 * h) +
                (f[i] / h - at * h / 6.0) * to + (f[i + 1] / h - next * h / 6.0) * from;
  point.slope = (next * from * from - at * to * to) / (2.0 * h) + (f[i + 1] - f[i]) / h -
                h * (next - at) / 6.0;
  return point;
}

double TorqueCurve::value(double psi) const {
  if (psi < blend_start_) {
    return psi * (k1_ + k3_ * psi * psi);
  }
  if (psi <= support_begin_) {
    return described(psi).value;
  }
  if (psi >= support_end_) {
    return 0.0;
  }
  const double width = support_end_ - support_begin_;
  const double t = (psi - support_begin_) / width;
  return (1.0 - t) * (1.0 - t) * (edge_value_ * (1.0 + 2.0 * t) + edge_slope_ * width * t);
}

double TorqueCurve::derivative(double psi) const {
  if (psi < blend_start_) {
    return k1_ + 3.0 * k3_ * psi * psi;
  }
  if (psi <= support_begin_) {
    return described(psi).slope;
  }
  if (psi >= support_end_) {
    return 0.0;
  }
  const double width = support_end_ - support_begin_;
  const double t = (psi - support_begin_) / width;
  return (1.0 - t) * (edge_slope_ * (1.0 - 3.0 * t) - 6.0 * edge_value_ * t / width);
}

TorqueCurve::Safe TorqueCurve::safe(double kappa, double sin_psi) const {
  if (kappa <= cos_support_end_) {
    return {};
  }
  // By the sine, as acos(κ) has lost half of the digits at small angles.
  const double psi =
      kappa >= kSeriesCosine ? sin_psi * angleOverSine(kappa) : std::atan2(sin_psi, kappa);
  constexpr double kSeriesAngle = 1e-3;
  if (psi < std::min(kSeriesAngle, blend_start_)) {
    // Series of (k₁ψ + k₃ψ³)/sin ψ and of its derivative by κ = cos ψ in ψ²; error below 1e-12.
    const double p2 = psi * psi;
    const double order_2 = k3_ + k1_ / 6.0;
    const double order_4 = k3_ / 6.0 + 7.0 * k1_ / 360.0;
    return {k1_ + p2 * (order_2 + p2 * order_4),
            -2.0 * order_2 - p2 * (order_2 / 3.0 + 4.0 * order_4)};
  }
  const bool is_described = psi >= blend_start_ && psi <= support_begin_;
  const auto [f, df] = is_described ? described(psi) : Point{value(psi), derivative(psi)};
  const double inverse_sine = 1.0 / sin_psi;
  return {f * inverse_sine,
          -(df * sin_psi - f * kappa) * inverse_sine * inverse_sine * inverse_sine};
}

}  // namespace sac
