#pragma once

#include <QLabel>

namespace sac {

/// Keeps room for so many lines, so that buttons below stay where they are while texts change.
inline void reserveLines(QLabel& label, int lines) {
  label.setMinimumHeight(lines * label.fontMetrics().lineSpacing());
  label.setAlignment(Qt::AlignLeft | Qt::AlignTop);
}

}  // namespace sac
