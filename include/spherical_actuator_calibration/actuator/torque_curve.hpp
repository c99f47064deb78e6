#pragma once

#include <cstddef>
#include <vector>

namespace sac {

/// Of the angles of a torque curve.
enum class AngleUnit { kDegree, kRadian };

/// A torque curve by points, from a measurement or a field computation. Angles are in the unit of
/// the description, ascending; between them is a cubic spline (C²).
struct TorqueTable {
  std::vector<double> angles;
  std::vector<double> torques;       ///< f at the angles [N·m/A]
  std::vector<double> stddevs = {};  ///< of them [N·m/A]; empty where none is stated

  bool empty() const { return angles.empty() && torques.empty(); }
};

/// What an actuator description says of the torque curve. Angles are in `angle_unit`.
struct TorqueCurveDescription {
  AngleUnit angle_unit = AngleUnit::kDegree;
  /// Polynomial coefficients c_n of f(ψ) = Σ c_n ψⁿ [N·m/A per unit of ψⁿ], paper (23). Beside a
  /// table they are added to it.
  std::vector<double> coefficients;
  /// Below this angle the polynomial gives way to k₁ψ + k₃ψ³. In angle_unit, > 0.
  double blend_start = 0.0;
  /// Between these two angles a cubic leads the polynomial to zero value and slope; beyond, f = 0.
  double support_begin = 0.0;
  double support_end = 0.0;
  TorqueTable table = {};
};

/// Fewest and most points of a table.
inline constexpr std::size_t kFewestTablePoints = 4;
inline constexpr std::size_t kMostTablePoints = 2000;

/// Fills in blend_start and support where they are zero, from the points of the table. The odd
/// cubic reaches to the first point beside ψ = 0. Where the last torque is (nearly) zero, the curve
/// ends there; else it ends a seventh beyond the last point.
void completeFromTable(TorqueCurveDescription& description);

/// Standard deviation of the table's torques, root mean square over its points, over the largest
/// torque; 0 where none is stated.
double relativeTableStddev(const TorqueTable& table);

/// Throws ConfigError when the description is not finite, out of order
/// (0 < blend_start < support_begin < support_end < 180°), without coefficients and table, or its
/// table does not ascend from blend_start or below to support_begin or beyond.
void validate(const TorqueCurveDescription& description);

/// Torque per ampere between one pole and one coil as a function of the angle ψ between their axes,
/// continuous with its first derivative everywhere (doc/method.md, Torque curve):
/// odd cubic near zero, polynomial or spline on the support, cubic Hermite to zero, zero beyond.
class TorqueCurve {
 public:
  /// f/sin ψ as a function of κ = cos ψ, and its derivative: what the torque model needs.
  struct Safe {
    double h = 0.0;   ///< f(ψ)/sin ψ [N·m/A]
    double dh = 0.0;  ///< dh/dκ [N·m/A]
  };

  explicit TorqueCurve(const TorqueCurveDescription& description);

  /// f(ψ) [N·m/A], ψ in [0, π] rad.
  double value(double psi) const;
  /// df/dψ [N·m/(A·rad)], ψ in [0, π] rad.
  double derivative(double psi) const;
  /// h and dh/dκ for two unit axes with κ = r·s and sin ψ = ‖r×s‖. Finite for every pair, also ψ =
  /// 0.
  Safe safe(double kappa, double sin_psi) const;

  /// Angles [rad] between which the curve is polynomial and table, and beyond which it is zero.
  double blendStart() const { return blend_start_; }
  double supportBegin() const { return support_begin_; }
  double supportEnd() const { return support_end_; }
  /// cos(supportEnd()): pairs with κ at or below it exert no torque.
  double cosSupportEnd() const { return cos_support_end_; }
  /// Coefficients of the odd cubic near zero [N·m/(A·rad)], [N·m/(A·rad³)].
  double linearCoefficient() const { return k1_; }
  double cubicCoefficient() const { return k3_; }
  /// Coefficients of the polynomial for ψ in rad.
  const std::vector<double>& coefficientsInRadians() const { return coefficients_; }

  const TorqueCurveDescription& description() const { return description_; }

 private:
  /// A value and its derivative by ψ.
  struct Point {
    double value = 0.0;
    double slope = 0.0;
  };

  /// Polynomial and table together, as described.
  Point described(double psi) const;
  Point spline(double psi) const;

  TorqueCurveDescription description_;
  std::vector<double> coefficients_;
  std::vector<double> knots_;     ///< angles of the table [rad]
  std::vector<double> bendings_;  ///< second derivatives of the spline there [N·m/(A·rad²)]
  double blend_start_;
  double support_begin_;
  double support_end_;
  double cos_support_end_;
  double k1_ = 0.0;
  double k3_ = 0.0;
  double edge_value_ = 0.0;
  double edge_slope_ = 0.0;
};

}  // namespace sac
