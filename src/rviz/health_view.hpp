#pragma once

#include <QLabel>
#include <QWidget>
#include <vector>

#include "panel_model.hpp"

namespace sac {

/// A light for each stream of measurements, and the most serious trouble in words.
class HealthView : public QWidget {
 public:
  HealthView();

  /// Of the four streams, in the order of PanelModel::streams(); troubles most serious first.
  void fill(const std::vector<HealthLine>& streams, const std::vector<HealthLine>& troubles);

 private:
  std::vector<QLabel*> streams_;
  QLabel* trouble_;
};

}  // namespace sac
