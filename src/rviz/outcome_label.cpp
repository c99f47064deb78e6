#include "outcome_label.hpp"

#include <QTime>

#include "steady_label.hpp"

namespace sac {
namespace {

constexpr qint64 kFresh = 60'000;       // [ms] in which an end is of now
constexpr qint64 kForgotten = 600'000;  // [ms] after which it goes

}  // namespace

OutcomeLabel::OutcomeLabel() {
  setWordWrap(true);
  setTextInteractionFlags(Qt::TextSelectableByMouse);
  constexpr int kLines = 2;
  reserveLines(*this, kLines);
}

void OutcomeLabel::showCourse(const QString& text) {
  ended_.invalidate();
  setStyleSheet("");
  setText(text);
}

void OutcomeLabel::showEnd(const QString& text, Ending ending) {
  ended_.start();
  setStyleSheet(ending == Ending::kGood ? "color: #1b7f3b;" : "color: #c62828;");
  setText(QTime::currentTime().toString("hh:mm:ss, ") + text);
}

void OutcomeLabel::age() {
  if (!ended_.isValid() || ended_.elapsed() < kFresh) {
    return;
  }
  setStyleSheet("color: #80868d;");
  if (ended_.elapsed() > kForgotten) {
    ended_.invalidate();
    clear();
  }
}

}  // namespace sac
