#pragma once

#include <vector>

#include <QtCharts/QChartView>

QT_CHARTS_BEGIN_NAMESPACE
class QLineSeries;
class QLogValueAxis;
class QValueAxis;
QT_CHARTS_END_NAMESPACE

namespace sac {

/// Error over the iterations of a cycle, on a logarithmic scale.
class ConvergenceChart : public QtCharts::QChartView {
  Q_OBJECT

 public:
  explicit ConvergenceChart(QWidget* parent = nullptr);

  /// `errors`: before the first and after each iteration, in the unit that the title names.
  void setHistory(const QString& title, const std::vector<double>& errors);

 private:
  QtCharts::QLineSeries* line_;
  QtCharts::QValueAxis* iterations_;
  QtCharts::QLogValueAxis* errors_;
};

}  // namespace sac
