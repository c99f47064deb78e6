#include "coverage_bars.hpp"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <utility>

namespace sac {
namespace {

// Sizes [px].
constexpr int kTitleWidth = 44;
constexpr int kBarHeight = 22;
constexpr int kNumberHeight = 16;  // below bars that have one
constexpr int kSpacing = 4;
constexpr double kGap = 2.0;
constexpr double kWidestBar = 60.0;

constexpr QRgb kEmpty = qRgb(225, 227, 231);
constexpr QRgb kFew = qRgb(240, 150, 40);
constexpr QRgb kEnough = qRgb(60, 120, 200);
constexpr QRgb kDone = qRgb(40, 150, 70);

QRgb colorOf(const CoverageBar& bar) {
  if (bar.coverage.identified != 0) {
    return kDone;
  }
  return bar.coverage.seen_well != 0 ? kEnough : kFew;
}

/// The number of "coil_7", or nothing.
QString labelOf(const CoverageBar& bar) {
  const std::size_t underline = bar.name.find_last_of('_');
  return underline == std::string::npos ? QString()
                                        : QString::fromStdString(bar.name.substr(underline + 1));
}

int heightOf(const CoverageGroup& group) {
  const bool is_numbered = std::any_of(group.bars.begin(), group.bars.end(), [](const auto& bar) {
    return !labelOf(bar).isEmpty();
  });
  return kBarHeight + (is_numbered ? kNumberHeight : kSpacing);
}

QString describe(const CoverageBar& bar) {
  return QString("%1: %2 of %3 samples%4")
      .arg(QString::fromStdString(bar.name))
      .arg(bar.coverage.samples)
      .arg(bar.coverage.wanted)
      .arg(bar.coverage.identified != 0 ? ", identified" : "");
}

}  // namespace

CoverageBars::CoverageBars(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void CoverageBars::setGroups(std::vector<CoverageGroup> groups) {
  groups_ = std::move(groups);
  updateGeometry();
  update();
}

QSize CoverageBars::sizeHint() const {
  int height = 0;
  for (const CoverageGroup& group : groups_) {
    height += heightOf(group);
  }
  return {300, height};
}

std::vector<CoverageBars::Place> CoverageBars::places() const {
  std::vector<Place> places;
  double top = 0.0;
  for (const CoverageGroup& group : groups_) {
    const double pitch = std::min(
        kWidestBar,
        (width() - kTitleWidth) / static_cast<double>(std::max<std::size_t>(1, group.bars.size())));
    double left = kTitleWidth;
    for (const CoverageBar& bar : group.bars) {
      places.push_back({QRectF(left, top, std::max(1.0, pitch - kGap), kBarHeight), &bar});
      left += pitch;
    }
    top += heightOf(group);
  }
  return places;
}

void CoverageBars::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  QFont small = font();
  small.setPointSizeF(0.75 * small.pointSizeF());
  double top = 0.0;
  for (const CoverageGroup& group : groups_) {
    painter.drawText(QRectF(0.0, top, kTitleWidth, kBarHeight),
                     Qt::AlignVCenter | Qt::AlignLeft,
                     QString::fromStdString(group.title));
    top += heightOf(group);
  }
  painter.setFont(small);
  for (const Place& place : places()) {
    const msg::Coverage& coverage = place.bar->coverage;
    const double share =
        std::min(1.0, coverage.samples / static_cast<double>(std::max(1U, coverage.wanted)));
    QRectF filled = place.area;
    filled.setTop(place.area.bottom() - share * place.area.height());
    painter.fillRect(place.area, QColor(kEmpty));
    painter.fillRect(filled, QColor(colorOf(*place.bar)));
    painter.drawText(QRectF(place.area.left() - kGap,
                            place.area.bottom(),
                            place.area.width() + 2.0 * kGap,
                            kNumberHeight - 2),
                     Qt::AlignTop | Qt::AlignHCenter,
                     labelOf(*place.bar));
  }
}

bool CoverageBars::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) {
    return QWidget::event(event);
  }
  const auto* help = static_cast<QHelpEvent*>(event);
  for (const Place& place : places()) {
    if (place.area.contains(help->pos())) {
      QToolTip::showText(help->globalPos(), describe(*place.bar), this);
      return true;
    }
  }
  QToolTip::hideText();
  return true;
}

}  // namespace sac
