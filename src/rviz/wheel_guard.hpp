#pragma once

#include <QAbstractSpinBox>
#include <QEvent>
#include <QObject>
#include <QTabBar>
#include <QWidget>

namespace sac {

/// Keeps the wheel of the mouse from numbers and tabs: who scrolls a small screen would change the
/// current of the next measurement without a word. The wheel goes on to what scrolls.
class WheelGuard : public QObject {
 public:
  /// Of all that is within `area` by now; the guard is its child.
  static void protect(QWidget& area) {
    auto* guard = new WheelGuard(area);
    for (QWidget* box : area.findChildren<QAbstractSpinBox*>()) {
      box->installEventFilter(guard);
    }
    for (QWidget* bar : area.findChildren<QTabBar*>()) {
      bar->installEventFilter(guard);
    }
  }

  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() != QEvent::Wheel) {
      return QObject::eventFilter(watched, event);
    }
    event->ignore();
    return true;
  }

 private:
  explicit WheelGuard(QWidget& area) : QObject(&area) {}
};

}  // namespace sac
