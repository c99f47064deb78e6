#include "log_axis.hpp"

#include <QStringList>
#include <algorithm>
#include <cmath>

#include "log_ticks.hpp"

namespace sac {

LogAxis::LogAxis() {
  setLabelsPosition(AxisLabelsPositionOnValue);
}

double LogAxis::place(double value) {
  return std::log10(value);
}

void LogAxis::cover(double least, double most) {
  const QStringList old = categoriesLabels();
  for (const QString& label : old) {
    remove(label);
  }
  constexpr double kShare = 0.08;   // of the range, on both sides
  constexpr double kNarrow = 0.02;  // [decades] where all values are alike
  const double margin = std::max(kNarrow, kShare * (place(most) - place(least)));
  setRange(place(least) - margin, place(most) + margin);
  setStartValue(min());
  for (const double tick : logTicks(least, most)) {
    append(QString::number(tick, 'g', 3), place(tick));
  }
}

}  // namespace sac
