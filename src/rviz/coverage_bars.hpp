#pragma once

#include <QWidget>
#include <vector>

#include "panel_model.hpp"

namespace sac {

/// One small bar per joint, pole and coil: grey when empty, filling up with samples, orange until
/// it is seen well enough, then blue, green when identified; its number stands below, name and
/// count are its tool tip.
class CoverageBars : public QWidget {
  Q_OBJECT

 public:
  explicit CoverageBars(QWidget* parent = nullptr);

  void setGroups(std::vector<CoverageGroup> groups);

  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;

 private:
  /// Where a bar stands.
  struct Place {
    QRectF area;
    const CoverageBar* bar = nullptr;
  };
  std::vector<Place> places() const;

  std::vector<CoverageGroup> groups_;
};

}  // namespace sac
