#pragma once

#include <QKeySequence>
#include <QPushButton>
#include <QString>

namespace sac {

/// Another text, with the shortcut that a new text takes away.
inline void nameButton(QPushButton& button, const QString& text, const char* key) {
  if (button.text() != text) {
    button.setText(text);
    button.setShortcut(QKeySequence(key));
  }
}

}  // namespace sac
