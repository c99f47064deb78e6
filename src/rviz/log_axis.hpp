#pragma once

#include <QtCharts/QCategoryAxis>

namespace sac {

#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
using QtCharts::QCategoryAxis;
#endif

/// A logarithmic axis whose labels are numbers also where its range is less than a decade, which
/// QLogValueAxis leaves without. Its series hold place() of their values.
class LogAxis : public QCategoryAxis {
 public:
  LogAxis();

  static double place(double value);
  /// From the smaller to the larger one, which are above zero, with a margin.
  void cover(double least, double most);
};

}  // namespace sac
