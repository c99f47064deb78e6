#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "spherical_actuator_calibration/calibration/calibration_report.hpp"
#include "spherical_actuator_calibration/estimation/calibration_state.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "spherical_actuator_calibration/storage/session_database.hpp"

/// Content for session databases. Numbers are random in every bit but follow from the arguments, so
/// that what is read can be compared with what was written.
namespace sac::database_examples {

inline constexpr char kDate[] = "2024-05-31T12:00:00Z";

/// The paper's actuator as drawn, serial SA-001.
SessionIdentity identity();
inline constexpr Eigen::Index kCoils = 24;       ///< of it
inline constexpr Eigen::Index kParameters = 73;  ///< of it
/// The same without poles and coils.
SessionIdentity jointIdentity();
inline constexpr Eigen::Index kJointParameters = 9;  ///< of it

/// A sample with orientation, torque and as many currents.
Sample sample(std::uint32_t id, Eigen::Index coils);
/// A window of a motion with as many coils. `seed`: later ones have later stamps.
MotionSlice window(unsigned seed, Eigen::Index coils);
/// State with as many parameters.
CalibrationState state(unsigned seed, Eigen::Index parameters);
/// A successful cycle of coil 3 with infinities where reports can hold them; its residuals are of
/// samples 1 to `samples`, its estimates of as many parameters.
CycleReport report(unsigned seed, std::uint32_t samples, Eigen::Index parameters);

/// What a motion told.
MotionSummary summary();

/// Equal in every bit of every number.
bool isSame(const Sample& a, const Sample& b);
bool isSame(const MotionSlice& a, const MotionSlice& b);
bool isSame(const CalibrationState& a, const CalibrationState& b);
bool isSame(const CycleReport& a, const CycleReport& b);
bool isSame(const MotionSummary& a, const MotionSummary& b);

/// Answer of SQLite to one query, as a program of its own would see it: first column, a line per
/// row.
std::string query(const std::string& path, const std::string& sql);
/// Runs SQL that changes the file.
void change(const std::string& path, const std::string& sql);

}  // namespace sac::database_examples
