#include "torque_curve_change.hpp"

#include <algorithm>
#include <cmath>

#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "strength_reference.hpp"

namespace sac::effects {
namespace {

/// As many as the curve has coefficients; a table takes as many as the paper's curve has.
std::size_t shapeCount(const TorqueCurveDescription& curve) {
  constexpr std::size_t kOfTable = 7;
  return curve.table.empty() ? curve.coefficients.size()
                             : std::max(kOfTable, curve.coefficients.size());
}

/// Numbers of the polynomials that make a change. Beside a scale there is no constant one, or the
/// curve times a number would be a change; but one whose uncertainty is stated is known.
std::vector<Eigen::Index> shapeNumbers(const Actuator& nominal, const EffectSelection& selection) {
  const bool is_relative =
      hasStrengthScale(selection) && relativeTableStddev(nominal.torque_curve->table) == 0.0;
  const auto count = static_cast<Eigen::Index>(shapeCount(*nominal.torque_curve));
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index n = is_relative ? 1 : 0; n < count; ++n) {
    numbers.push_back(n);
  }
  return numbers;
}

std::vector<std::string> shapeNames(const std::vector<Eigen::Index>& numbers) {
  std::vector<std::string> names;
  names.reserve(numbers.size());
  for (const Eigen::Index n : numbers) {
    names.push_back("torque_curve/t" + std::to_string(n));
  }
  return names;
}

/// Largest torque below the edge of the support [N·m/A].
double peakOf(const TorqueCurve& curve) {
  constexpr int kSteps = 200;
  double peak = 0.0;
  for (int n = 0; n <= kSteps; ++n) {
    peak = std::max(peak, std::abs(curve.value(curve.supportBegin() * n / kSteps)));
  }
  return peak;
}

/// T_{n+1} = 2 t T_n − T_{n−1} with t = 2ψ/ψ_end − 1.
Eigen::MatrixXd chebyshevShapes(const TorqueCurveDescription& curve) {
  const auto count = static_cast<Eigen::Index>(shapeCount(curve));
  const double slope = 2.0 / curve.support_begin;
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(count, count);
  const auto times_t = [&](Eigen::Index n) {
    Eigen::VectorXd product = -shapes.col(n);
    product.tail(count - 1) += slope * shapes.col(n).head(count - 1);
    return product;
  };
  shapes(0, 0) = 1.0;
  if (count > 1) {
    shapes.col(1) = times_t(0);
  }
  for (Eigen::Index n = 1; n + 1 < count; ++n) {
    shapes.col(n + 1) = 2.0 * times_t(n) - shapes.col(n - 1);
  }
  return peakOf(TorqueCurve(curve)) * shapes;
}

}  // namespace

TorqueCurveChange::TorqueCurveChange(const Actuator& nominal, const EffectSelection& selection)
    : LaboratoryEffect(shapeNames(shapeNumbers(nominal, selection)), 1.0),
      shapes_(chebyshevShapes(*nominal.torque_curve)(Eigen::all, shapeNumbers(nominal, selection))),
      // Each shape has a mean square of one half over the range.
      prior_stddev_(
          relativeTableStddev(nominal.torque_curve->table) *
          std::sqrt(2.0 / static_cast<double>(std::max<Eigen::Index>(shapes_.cols(), 1)))) {
  for (Eigen::Index n = 0; n < shapes_.cols(); ++n) {
    TorqueCurveDescription single = *nominal.torque_curve;
    const Eigen::VectorXd shape = shapes_.col(n);
    single.coefficients.assign(shape.data(), shape.data() + shape.size());
    single.table = {};
    basis_.emplace_back(single);
  }
}

void TorqueCurveChange::addPairColumns(const Eigen::Vector3d& pole_rotor,
                                       const Eigen::Vector3d& coil_rotor,
                                       Columns columns) const {
  for (std::size_t n = 0; n < basis_.size(); ++n) {
    columns.col(static_cast<Eigen::Index>(n)) = pairTorque(basis_[n], pole_rotor, coil_rotor);
  }
}

void TorqueCurveChange::applyTo(Actuator& actuator, const Values& values) const {
  std::vector<double>& coefficients = actuator.torque_curve->coefficients;
  coefficients.resize(static_cast<std::size_t>(shapes_.rows()), 0.0);
  Eigen::Map<Eigen::VectorXd>(coefficients.data(), shapes_.rows()) += shapes_ * values;
}

}  // namespace sac::effects
