#pragma once

#include <vector>

#include "convergence_chart.hpp"
#include "motion_history.hpp"

namespace sac {

/// Standard deviation of the least known joint, pole and coil over the seconds of a motion, on a
/// logarithmic scale, with the one that is wanted.
class MotionChart : public QChartView {
  Q_OBJECT

 public:
  explicit MotionChart(QWidget* parent = nullptr);

  void setCurves(const std::vector<UncertaintyCurve>& curves, double wanted_stddev);

 private:
  std::vector<QLineSeries*> lines_;
  QLineSeries* wanted_;
  QValueAxis* seconds_;
  LogAxis* stddevs_;
};

}  // namespace sac
