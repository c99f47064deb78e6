#include "convergence_chart.hpp"

#include <algorithm>
#include <cmath>

#include <QtCharts/QChart>
#include <QtCharts/QLegend>

namespace sac {
namespace {

/// A logarithm needs something above zero: an error below is drawn there.
constexpr double kSmallestError = 1e-9;

}  // namespace

ConvergenceChart::ConvergenceChart(QWidget* parent)
    : QChartView(parent),
      line_(new QLineSeries),
      iterations_(new QValueAxis),
      errors_(new LogAxis) {
  line_->setPointsVisible(true);
  iterations_->setLabelFormat("%d");
  iterations_->setTitleText("iteration");
  // Without an interval, dynamic ticks are without end.
  iterations_->setRange(0.0, 1.0);
  iterations_->setTickInterval(1.0);
  iterations_->setTickType(QValueAxis::TicksDynamic);
  // The chart owns line and axes.
  chart()->legend()->hide();
  chart()->addSeries(line_);
  chart()->addAxis(iterations_, Qt::AlignBottom);
  chart()->addAxis(errors_, Qt::AlignLeft);
  line_->attachAxis(iterations_);
  line_->attachAxis(errors_);
  chart()->setMargins(QMargins(0, 0, 0, 0));
  setRenderHint(QPainter::Antialiasing);
}

void ConvergenceChart::setHistory(const QString& title, const std::vector<double>& errors) {
  chart()->setTitle(title);
  line_->clear();
  if (errors.empty()) {
    return;
  }
  double smallest = std::max(kSmallestError, errors.front());
  double largest = smallest;
  for (std::size_t n = 0; n < errors.size(); ++n) {
    const double error = std::max(kSmallestError, errors[n]);
    line_->append(static_cast<double>(n), LogAxis::place(error));
    smallest = std::min(smallest, error);
    largest = std::max(largest, error);
  }
  const auto last = static_cast<double>(std::max<std::size_t>(1, errors.size() - 1));
  constexpr double kMostTicks = 10.0;
  iterations_->setTickInterval(std::ceil(last / kMostTicks));
  iterations_->setRange(0.0, last);
  errors_->cover(smallest, largest);
}

}  // namespace sac
