#pragma once

#include <QLabel>

namespace sac {

/// Keeps room for so many lines, so that buttons below stay where they are while texts change.
inline void reserveLines(QLabel& label, int lines) {
  constexpr int kLeading = 2;  // [px] that a label of several lines is higher
  label.setMinimumHeight(lines * label.fontMetrics().lineSpacing() + kLeading);
  label.setAlignment(Qt::AlignLeft | Qt::AlignTop);
}

}  // namespace sac
