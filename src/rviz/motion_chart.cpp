#include "motion_chart.hpp"

#include <QPen>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <QtCharts/QChart>
#include <QtCharts/QLegend>
#include <QtCharts/QLegendMarker>

namespace sac {
namespace {

constexpr double kShortest = 5.0;  // [s] of an axis, so that its whole numbers differ
constexpr const char* kColours[] = {"#1565c0", "#8e24aa", "#ef6c00"};

void paint(QLineSeries& line, const char* colour, Qt::PenStyle dashes) {
  QPen pen{QColor(colour)};
  pen.setWidth(2);
  pen.setStyle(dashes);
  line.setPen(pen);
}

}  // namespace

MotionChart::MotionChart(QWidget* parent)
    : QChartView(parent),
      wanted_(new QLineSeries),
      seconds_(new QValueAxis),
      stddevs_(new LogAxis) {
  seconds_->setLabelFormat("%.0f");
  seconds_->setTitleText("motion [s]");
  seconds_->setRange(0.0, kShortest);
  stddevs_->setTitleText("std [mrad]");
  stddevs_->cover(0.1, 1.0);
  // The chart owns lines and axes.
  chart()->addAxis(seconds_, Qt::AlignBottom);
  chart()->addAxis(stddevs_, Qt::AlignLeft);
  for (const char* colour : kColours) {
    lines_.push_back(new QLineSeries);
    paint(*lines_.back(), colour, Qt::SolidLine);
  }
  paint(*wanted_, "#707070", Qt::DashLine);
  wanted_->setName("wanted");
  for (QLineSeries* line : lines_) {
    chart()->addSeries(line);
  }
  chart()->addSeries(wanted_);
  for (QLineSeries* line : {lines_[0], lines_[1], lines_[2], wanted_}) {
    line->attachAxis(seconds_);
    line->attachAxis(stddevs_);
  }
  chart()->legend()->setAlignment(Qt::AlignTop);
  chart()->setMargins(QMargins(0, 0, 0, 0));
  setRenderHint(QPainter::Antialiasing);
}

void MotionChart::setCurves(const std::vector<UncertaintyCurve>& curves, double wanted_stddev) {
  double last = 0.0;
  double least = wanted_stddev > 0.0 ? kMilli * wanted_stddev : 1.0;
  double most = least;
  for (std::size_t n = 0; n < lines_.size(); ++n) {
    QList<QPointF> points;
    if (n < curves.size()) {
      const UncertaintyCurve& curve = curves[n];
      lines_[n]->setName(QString::fromStdString(curve.group));
      for (std::size_t k = 0; k < curve.seconds.size(); ++k) {
        const double stddev = kMilli * curve.stddevs[k];
        points.append(QPointF(curve.seconds[k], LogAxis::place(stddev)));
        last = std::max(last, curve.seconds[k]);
        least = std::min(least, stddev);
        most = std::max(most, stddev);
      }
    }
    lines_[n]->replace(points);
    // A rotor without joints has a curve less.
    chart()->legend()->markers(lines_[n]).front()->setVisible(!lines_[n]->name().isEmpty());
  }
  last = std::max(last, kShortest);
  seconds_->setRange(0.0, last);
  seconds_->applyNiceNumbers();
  stddevs_->cover(least, most);
  wanted_->clear();
  if (wanted_stddev > 0.0) {
    wanted_->append(0.0, LogAxis::place(kMilli * wanted_stddev));
    wanted_->append(seconds_->max(), LogAxis::place(kMilli * wanted_stddev));
  }
}

}  // namespace sac
