#pragma once

#include <QElapsedTimer>
#include <QLabel>

namespace sac {

/// The one place of the panel that tells how what was asked for goes, and how it ended. An end has
/// its time of day; it turns grey after a minute, and goes when it tells nothing of now any more.
class OutcomeLabel : public QLabel {
 public:
  enum class Ending { kGood, kBad };

  OutcomeLabel();

  void showCourse(const QString& text);
  void showEnd(const QString& text, Ending ending);
  /// To be called again and again.
  void age();

 private:
  QElapsedTimer ended_;  ///< not valid while something runs
};

}  // namespace sac
