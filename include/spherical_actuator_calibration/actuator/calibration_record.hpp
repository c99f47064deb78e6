#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/actuator.hpp"

namespace sac {

/// Standard deviations [rad] of one joint's parameters; absent where not identified.
struct JointStddev {
  std::optional<double> offset;
  std::optional<double> axis_u;  ///< along e_u of AxisChart::aroundAxis(nominal axis)
  std::optional<double> axis_v;  ///< along e_v
  /// Of the reading's correction, entry by entry [1], [rad]; zero for entries that are not
  /// modelled.
  std::optional<std::array<double, kJoints>> linear = std::nullopt;
  std::optional<std::array<double, 4>> harmonics = std::nullopt;
};

/// Standard deviations of one pole or coil; absent where not identified.
struct AxisStddev {
  std::optional<double> polar;                ///< [rad]
  std::optional<double> azimuth;              ///< [rad]
  std::optional<double> gain = std::nullopt;  ///< [1]
};

/// How well a torque curve is known: its standard deviation at some angles.
struct TorqueCurveStddev {
  std::vector<double> angles;   ///< ascending, in the angle_unit of the curve
  std::vector<double> torques;  ///< [N·m/A]
};

/// Standard deviations of an actuator's parameters, entry by entry as in the Actuator.
struct ParameterStddevs {
  std::array<JointStddev, kJoints> joints;
  std::vector<AxisStddev> poles;
  std::vector<AxisStddev> coils;
  std::optional<Eigen::Vector3d> unbalance = std::nullopt;  ///< [N·m]
  std::optional<TorqueCurveStddev> torque_curve = std::nullopt;
};

/// A recording that a calibration rests on.
struct RecordingSource {
  std::string recording;  ///< file name
  std::string checksum;   ///< with its kind: "sha256:…"
};

/// One cycle of a calibration, in short (message CalibrationReport).
struct CycleRecord {
  std::string cycle;                               ///< see cycleName()
  std::optional<std::size_t> coil = std::nullopt;  ///< excited coil; none where the cycle has none
  std::uint32_t samples_used = 0;
  std::uint32_t samples_rejected = 0;
  double error_before = 0.0;  ///< ε₁ or ε₂ before the first iteration, in `unit`
  double error_after = 0.0;   ///< after the last one
  std::string unit;           ///< of the two errors
  double reduced_chi_square = 0.0;
};

/// A laboratory effect that was identified beside the geometry. Gains and torque curve are in the
/// actuator as well.
struct EffectRecord {
  std::string name;     ///< see EffectLayout
  double value = 0.0;   ///< in its own unit
  double stddev = 0.0;  ///< the same
};

/// What is known of all parameters together, also of those that are not identified: what they leave
/// uncertain is common to all samples, and in the others.
struct CovarianceRecord {
  std::vector<std::string> effects;  ///< laboratory effects that were modelled
  std::vector<std::string> names;    ///< of parameters, see ParameterEstimate
  /// Lower triangle, row by row: entry (a, b) in the unit of a times that of b. Azimuths count as
  /// arcs: times cos(polar).
  std::vector<double> lower;
};

/// How an orientation map was chosen: what it is worth where it has not seen the poses.
struct MapRecord {
  std::uint32_t regions = 0;  ///< of the workspace, each predicted from the others
  double axes_rms = 0.0;      ///< of the rotation error without the map, held out [rad]
  double map_rms = 0.0;       ///< with it [rad]
  double inside = 0.0;        ///< share of the components within their 95 % intervals
};

/// Residuals of the samples that were held out.
struct ValidationRecord {
  std::uint32_t samples = 0;
  std::optional<double> orientation_rms;  ///< [rad]
  std::optional<double> torque_rms;       ///< [N·m]
  bool contradicted = false;              ///< they misfit beyond chance
};

/// Where a calibration comes from and how good it is.
struct CalibrationRecord {
  std::string date;  ///< ISO 8601, with time: 2024-05-31T12:00:00Z
  std::uint32_t revision = 0;
  std::vector<RecordingSource> source;
  std::string software;  ///< version of this package
  std::vector<CycleRecord> cycles;
  std::vector<EffectRecord> effects;      ///< none where none was modelled
  std::vector<std::string> unidentified;  ///< names of parameters that the data leave open
  std::optional<ValidationRecord> validation;
  std::optional<double> orientation_uncertainty;  ///< see workspace_uncertainty.hpp [rad]
  std::optional<double> torque_uncertainty;       ///< [N·m/A]
  std::optional<CovarianceRecord> covariance = std::nullopt;
  std::optional<MapRecord> orientation_map = std::nullopt;
};

}  // namespace sac
