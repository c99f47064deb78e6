#include "motion_summary_table.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "row_access.hpp"

namespace sac::motion_summary_table {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::optional<CommandResponse> responseFrom(RowReader& row) {
  CommandResponse response;
  response.delay = row.number();
  response.lag = row.number();
  response.lateness_stddev = row.number();
  return std::isnan(response.delay) ? std::nullopt : std::optional(response);
}

void readLeftOut(const SQLite::Database& database, std::int64_t cycle, MotionSummary& summary) {
  RowReader row(database,
                "SELECT reason, windows FROM cycle_windows_left_out WHERE cycle = ? "
                "ORDER BY position",
                cycle);
  while (row.next()) {
    WindowsLeftOut left_out;
    left_out.reason = row.text();
    left_out.count = row.count();
    summary.left_out.push_back(std::move(left_out));
  }
}

void insertHeldOut(const SQLite::Database& database,
                   std::int64_t cycle,
                   const std::vector<ObservationResidual>& residuals) {
  RowWriter row(database,
                "INSERT INTO cycle_windows_held_out (cycle, position, window, error_x, error_y, "
                "error_z, standardized, rejected) VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  for (std::size_t n = 0; n < residuals.size(); ++n) {
    row.put(cycle).put(n).put(residuals[n].observation.sample);
    for (const double torque : residuals[n].residual) {
      row.put(torque);
    }
    row.put(residuals[n].standardized).put(residuals[n].rejected).write();
  }
}

void readHeldOut(const SQLite::Database& database,
                 std::int64_t cycle,
                 std::vector<ObservationResidual>& residuals) {
  RowReader row(database,
                "SELECT window, error_x, error_y, error_z, standardized, rejected "
                "FROM cycle_windows_held_out WHERE cycle = ? ORDER BY position",
                cycle);
  while (row.next()) {
    ObservationResidual residual;
    residual.observation = {row.count(), Quantity::kTorque};
    for (double& torque : residual.residual) {
      torque = row.number();
    }
    residual.standardized = row.number();
    residual.rejected = row.flag();
    residuals.push_back(residual);
  }
}

}  // namespace

void insert(const SQLite::Database& database, std::int64_t cycle, const MotionSummary& summary) {
  RowWriter row(
      database,
      "INSERT INTO cycle_motions (cycle, duration, windows, used, window_values, "
      "orientations, orientations_rejected, joint_1_stddev, joint_2_stddev, "
      "joint_3_stddev, current_stddev, orientation_stddev, response_delay, response_lag, "
      "response_delay_stddev, held_out_windows, held_out_rejected, held_out_orientations, "
      "held_out_orientation_rms, held_out_torque_rms, held_out_reduced_chi_square, "
      "held_out_probability, window_chi_square, orientation_chi_square) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  row.put(cycle).put(summary.duration).put(summary.windows).put(summary.used).put(summary.values);
  row.put(summary.orientations).put(summary.orientations_rejected);
  for (const double stddev : summary.joint_stddev) {
    row.put(stddev);
  }
  row.put(summary.current_stddev).put(summary.orientation_stddev);
  const CommandResponse response = summary.response.value_or(CommandResponse{kNone, kNone, kNone});
  row.put(response.delay).put(response.lag).put(response.lateness_stddev);
  const HeldOutMotion& held_out = summary.held_out;
  row.put(held_out.windows).put(held_out.rejected).put(held_out.orientations);
  row.put(held_out.orientation_rms).put(held_out.torque_rms);
  row.put(held_out.reduced_chi_square).put(held_out.probability);
  row.put(summary.window_chi_square).put(summary.orientation_chi_square).write();
  RowWriter left_out(database,
                     "INSERT INTO cycle_windows_left_out (cycle, position, reason, windows) "
                     "VALUES (?, ?, ?, ?)");
  for (std::size_t n = 0; n < summary.left_out.size(); ++n) {
    left_out.put(cycle).put(n).put(summary.left_out[n].reason).put(summary.left_out[n].count);
    left_out.write();
  }
  insertHeldOut(database, cycle, held_out.residuals);
}

std::optional<MotionSummary> find(const SQLite::Database& database, std::int64_t cycle) {
  RowReader row(database,
                "SELECT duration, windows, used, window_values, orientations, "
                "orientations_rejected, joint_1_stddev, joint_2_stddev, joint_3_stddev, "
                "current_stddev, orientation_stddev, response_delay, response_lag, "
                "response_delay_stddev, held_out_windows, held_out_rejected, "
                "held_out_orientations, held_out_orientation_rms, held_out_torque_rms, "
                "held_out_reduced_chi_square, held_out_probability, window_chi_square, "
                "orientation_chi_square FROM cycle_motions WHERE cycle = ?",
                cycle);
  if (!row.next()) {
    return std::nullopt;
  }
  MotionSummary summary;
  summary.duration = row.number();
  summary.windows = row.count();
  summary.used = row.count();
  summary.values = row.count();
  summary.orientations = row.count();
  summary.orientations_rejected = row.count();
  for (double& stddev : summary.joint_stddev) {
    stddev = row.number();
  }
  summary.current_stddev = row.number();
  summary.orientation_stddev = row.number();
  summary.response = responseFrom(row);
  HeldOutMotion& held_out = summary.held_out;
  held_out.windows = row.count();
  held_out.rejected = row.count();
  held_out.orientations = row.count();
  held_out.orientation_rms = row.number();
  held_out.torque_rms = row.number();
  held_out.reduced_chi_square = row.number();
  held_out.probability = row.number();
  summary.window_chi_square = row.number();
  summary.orientation_chi_square = row.number();
  readLeftOut(database, cycle, summary);
  readHeldOut(database, cycle, held_out.residuals);
  return summary;
}

}  // namespace sac::motion_summary_table
