#include "motion_view.hpp"

#include <QHBoxLayout>
#include <QVBoxLayout>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <std_srvs/Trigger.h>

#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"

namespace sac {

MotionView::MotionView(const ros::NodeHandle& node,
                       std::function<void()> calibrate,
                       std::function<void()> forget)
    : node_(node),
      calibrate_(new QPushButton("Cali&brate by motion")),
      end_(new QPushButton("E&nd motion")),
      forget_(new QPushButton("Forget motion")),
      words_(new QLabel),
      trouble_(new QLabel),
      chart_(new MotionChart),
      dynamics_(new QLabel) {
  calibrate_->setToolTip("All parameters from the motion until now (calibration/calibrate_motion)");
  end_->setToolTip("The rotor slows down to the end of its motion, and the currents are zero");
  forget_->setToolTip("The next motion begins anew (calibration/forget_motion)");
  auto* row = new QHBoxLayout;
  for (QPushButton* button : {calibrate_, end_, forget_}) {
    row->addWidget(button);
  }
  constexpr int kLowest = 220;  // [px]
  chart_->setMinimumHeight(kLowest);
  trouble_->setStyleSheet("color: #c62828;");
  trouble_->hide();
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addLayout(row);
  for (QLabel* label : {words_, trouble_, dynamics_}) {
    label->setWordWrap(true);
    layout->addWidget(label);
  }
  layout->insertWidget(layout->count() - 1, chart_, 1);
  connect(calibrate_, &QPushButton::clicked, this, std::move(calibrate));
  connect(forget_, &QPushButton::clicked, this, std::move(forget));
  connect(end_, &QPushButton::clicked, this, [this] { endMotion(); });
  constexpr std::uint32_t kQueueLength = 1000;
  subscriber_ = subscribeChecked<msg::MotionProgress>(
      node_,
      "motion_progress",
      kQueueLength,
      [this](const msg::MotionProgress::ConstPtr& message) {
        history_.receive(*message);
        changed_ = true;
      },
      tellRefusal("motion_progress"));
}

void MotionView::endMotion() {
  if (!caller_.isBusy()) {
    caller_.call<std_srvs::Trigger>(node_.resolveName("orientation_controller/end_motion"),
                                    std_srvs::Trigger::Request());
  }
}

void MotionView::refresh() {
  if (const std::optional<ServiceAnswer> answer = caller_.takeAnswer()) {
    trouble_->setText(QString::fromStdString(answer->message));
    trouble_->setVisible(!answer->success);
  }
  // A hidden picture is drawn when somebody looks.
  if (changed_ && isVisible()) {
    changed_ = false;
    showMotion();
  }
}

void MotionView::showMotion() {
  words_->setText(QString::fromStdString(history_.words()));
  chart_->setCurves(history_.curves(), history_.wantedStddev());
  std::string lines;
  for (const std::string& line : history_.dynamics()) {
    lines += (lines.empty() ? "" : "; ") + line;
  }
  dynamics_->setText("<small>" + QString::fromStdString(lines).toHtmlEscaped() + "</small>");
}

}  // namespace sac
