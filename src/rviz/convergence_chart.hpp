#pragma once

#include <vector>

#include <QtCharts/QChartView>
#include <QtCharts/QLineSeries>
#include <QtCharts/QValueAxis>

#include "log_axis.hpp"

namespace sac {

#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
using QtCharts::QChartView;
using QtCharts::QLineSeries;
using QtCharts::QValueAxis;
#endif

/// Error over the iterations of a cycle, on a logarithmic scale.
class ConvergenceChart : public QChartView {
  Q_OBJECT

 public:
  explicit ConvergenceChart(QWidget* parent = nullptr);

  /// `errors`: before the first and after each iteration, in the unit that the title names.
  void setHistory(const QString& title, const std::vector<double>& errors);

 private:
  QLineSeries* line_;
  QValueAxis* iterations_;
  LogAxis* errors_;
};

}  // namespace sac
