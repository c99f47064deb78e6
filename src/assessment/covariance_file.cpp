#include "spherical_actuator_calibration/assessment/covariance_file.hpp"

#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "spherical_actuator_calibration/base/yaml_writer.hpp"

namespace sac {
namespace {

const CycleReport* lastSuccess(const CalibrationSession& session) {
  const CycleReport* last = nullptr;
  for (const CycleReport& report : session.reports()) {
    last = report.success ? &report : last;
  }
  return last;
}

/// ∂reported/∂coordinates, by central differences: axes turn smoothly into their angles.
Eigen::MatrixXd reportedJacobian(const ParameterSpace& space, const Eigen::VectorXd& x) {
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd jacobian(space.size(), space.size());
  for (Eigen::Index p = 0; p < space.size(); ++p) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(space.size(), p);
    jacobian.col(p) =
        (space.reportedValues(x + step) - space.reportedValues(x - step)) / (2.0 * kStep);
  }
  return jacobian;
}

}  // namespace

Eigen::MatrixXd reportedCovariance(const CalibrationSession& session) {
  const ParameterBelief& belief = session.state().belief;
  const Eigen::MatrixXd jacobian = reportedJacobian(session.model().space(), belief.x);
  return jacobian * belief.covariance * jacobian.transpose();
}

double coverageFactor(const CalibrationSession& session) {
  constexpr double kUpper = 0.975;
  constexpr double kWidened = 1.0;
  const CycleReport* last = lastSuccess(session);
  if (last == nullptr || last->degrees_of_freedom <= 0 || last->reduced_chi_square <= kWidened) {
    return boost::math::quantile(boost::math::normal_distribution<double>(), kUpper);
  }
  const boost::math::students_t_distribution<double> student(last->degrees_of_freedom);
  return boost::math::quantile(student, kUpper);
}

std::string renderCovariance(const CalibrationSession& session) {
  std::vector<std::string> names;
  std::vector<std::string> units;
  std::vector<double> values;
  for (const ParameterEstimate& parameter : session.parameters()) {
    names.push_back(yamlText(parameter.name));
    units.push_back(yamlText(parameter.unit));
    values.push_back(parameter.value);
  }
  const Eigen::MatrixXd covariance = reportedCovariance(session);
  std::vector<std::string> rows;
  for (Eigen::Index p = 0; p < covariance.rows(); ++p) {
    const Eigen::RowVectorXd row = covariance.row(p);
    rows.push_back(yamlNumbers(row));
  }
  const CycleReport* last = lastSuccess(session);
  YamlWriter writer;
  writer.map(0, "covariance");
  writer.entry(1, "actuator", yamlText(session.start().actuator.name));
  writer.entry(1, "serial", yamlText(session.start().actuator.serial));
  writer.line(1, "# entry (a, b) of the matrix: in the unit of a times that of b");
  writer.entry(1, "names", yamlList(names));
  writer.entry(1, "units", yamlList(units));
  writer.entry(1, "values", yamlNumbers(values));
  writer.list(1, "matrix", rows);
  writer.line(1, "# value +- coverage_factor times standard deviation holds 95 %");
  writer.entry(1, "coverage_factor", yamlNumber(coverageFactor(session)));
  writer.entry(
      1, "degrees_of_freedom", std::to_string(last == nullptr ? 0 : last->degrees_of_freedom));
  return writer.text();
}

}  // namespace sac
