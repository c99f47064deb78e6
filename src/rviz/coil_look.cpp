#include "coil_look.hpp"

#include <QHBoxLayout>
#include <QHideEvent>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <string>

#include "excitation_limits.hpp"
#include "named_button.hpp"

namespace sac {
namespace {

constexpr double kExcitation = 10.0;  // [s]

QDoubleSpinBox* spinBox(double least, double most, double value, const QString& unit) {
  auto* box = new QDoubleSpinBox;
  box->setRange(least, most);
  box->setSingleStep(0.5);
  box->setDecimals(1);
  box->setValue(value);
  box->setSuffix(" " + unit);
  return box;
}

}  // namespace

CoilLook::CoilLook(const ros::NodeHandle& node, OutcomeLabel& outcome)
    : excitation_(node,
                  "calibration/excite",
                  [this](const msg::ExciteFeedback& feedback) { words_.receive(feedback); }),
      outcome_(outcome) {
  build();
  showExcitation();
}

void CoilLook::build() {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* row = new QHBoxLayout;
  excite_ = new QPushButton;
  excite_->setToolTip("Let a coil carry current for a while, and show what it carries (F12)");
  connect(excite_, &QPushButton::clicked, this, [this] { exciteOrStop(); });
  row->addWidget(excite_);
  coil_ = new QSpinBox;
  coil_->setRange(1, 1);
  coil_->setPrefix("coil ");
  row->addWidget(coil_);
  current_ = spinBox(-kLargestCurrent, kLargestCurrent, kOfferedCurrent, "A");
  row->addWidget(current_);
  duration_ = spinBox(kShortestExcitation, msg::ExciteGoal::LONGEST_DURATION, kExcitation, "s");
  row->addWidget(duration_);
  layout->addLayout(row);
}

void CoilLook::refresh(int coils, Bench bench) {
  coil_->setRange(1, std::max(1, coils));
  excite_->setEnabled(bench == Bench::kFree || excitation_.isRunning());
  showExcitation();
}

void CoilLook::exciteOrStop() {
  if (excitation_.isRunning()) {
    excitation_.cancel();
    return;
  }
  if (current_->value() == 0.0) {
    outcome_.showEnd("Choose a current first.", OutcomeLabel::Ending::kBad);
    return;
  }
  msg::ExciteGoal goal;
  goal.coils = {current_->value() < 0.0 ? -coil_->value() : coil_->value()};
  goal.current = std::abs(current_->value());
  goal.duration = duration_->value();
  words_ = ExcitationWords();
  excitation_.begin(goal);
}

void CoilLook::showExcitation() {
  if (const auto end = excitation_.takeEnd()) {
    outcome_.showEnd(QString::fromStdString(
                         end->message + (words_.carried().empty() ? "" : "\n" + words_.carried())),
                     end->success ? OutcomeLabel::Ending::kGood : OutcomeLabel::Ending::kBad);
  } else if (excitation_.isRunning()) {
    outcome_.showCourse(QString::fromStdString(words_.text()));
  }
  nameButton(*excite_, excitation_.isRunning() ? "Stop" : "Excite", "F12");
}

// A window that is made small on the screen hides spontaneously.
void CoilLook::hideEvent(QHideEvent* event) {
  if (!event->spontaneous()) {
    excitation_.cancel();
  }
  QWidget::hideEvent(event);
}

}  // namespace sac
