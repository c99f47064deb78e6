#include "hand_guide.hpp"

#include <QApplication>
#include <QHBoxLayout>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <xmlrpcpp/XmlRpcValue.h>

#include "excitation_limits.hpp"
#include "named_button.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "steady_label.hpp"

namespace sac {
namespace {

constexpr int kMostPoses = 100;

/// Names of the joints in the description that the nodes read; `otherwise` where there is none.
std::array<std::string, 3> jointNames(const ros::NodeHandle& node,
                                      const std::array<std::string, 3>& otherwise) {
  using XmlRpc::XmlRpcValue;
  XmlRpcValue joints;
  if (!node.getParam("actuator/joints", joints) || joints.getType() != XmlRpcValue::TypeArray ||
      joints.size() != static_cast<int>(otherwise.size())) {
    return otherwise;
  }
  std::array<std::string, 3> names;
  for (std::size_t k = 0; k < names.size(); ++k) {
    XmlRpcValue& joint = joints[static_cast<int>(k)];
    if (joint.getType() != XmlRpcValue::TypeStruct || !joint.hasMember("name") ||
        joint["name"].getType() != XmlRpcValue::TypeString) {
      return otherwise;
    }
    names[k] = printable(static_cast<std::string>(joint["name"]));
  }
  return names;
}

}  // namespace

HandGuide::HandGuide(const ros::NodeHandle& node,
                     const PanelModel& model,
                     std::function<bool()> hold_out,
                     std::function<double()> duration)
    : node_(node),
      model_(model),
      hold_out_(std::move(hold_out)),
      duration_(std::move(duration)),
      capture_(node,
               "calibration/capture",
               [this](const msg::CaptureFeedback& feedback) { words_.receive(feedback.progress); }),
      planning_(node,
                "calibration/plan",
                [this](const msg::PlanFeedback& feedback) {
                  planned_ = "Planning, " + std::to_string(std::lround(feedback.elapsed)) + " s …";
                }),
      wanted_pose_(node_.advertise<sensor_msgs::JointState>("wanted_pose", 1, true)) {
  build();
  listen();
  showAdvice();
}

void HandGuide::build() {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  advice_ = new QLabel;
  advice_->setWordWrap(true);
  reserveLines(*advice_, 2);
  layout->addWidget(advice_);
  auto* row = new QHBoxLayout;
  plan_ = new QPushButton;
  plan_->setToolTip("Choose the poses that tell most, given the samples held (F2)");
  connect(plan_, &QPushButton::clicked, this, [this] { planOrStop(); });
  row->addWidget(plan_);
  poses_ = new QSpinBox;
  poses_->setRange(1, kMostPoses);
  poses_->setValue(8);
  poses_->setSuffix(" poses");
  row->addWidget(poses_);
  measure_ = new QPushButton;
  measure_->setToolTip(
      "Capture here without current, then with each planned coil excited in turn (F3)");
  connect(measure_, &QPushButton::clicked, this, [this] { measureOrStop(); });
  row->addWidget(measure_);
  current_ = new QDoubleSpinBox;
  current_->setRange(-kLargestCurrent, kLargestCurrent);
  current_->setSingleStep(0.5);
  current_->setDecimals(1);
  current_->setValue(2.0);
  current_->setSuffix(" A");
  row->addWidget(current_);
  layout->addLayout(row);
  outcome_ = new QLabel;
  outcome_->setWordWrap(true);
  reserveLines(*outcome_, 2);
  layout->addWidget(outcome_);
}

// The newest message counts; rviz delivers it in the thread of the windows.
void HandGuide::listen() {
  constexpr std::uint32_t kNewest = 1;
  constexpr std::uint32_t kAll = 1000;
  subscribers_.push_back(subscribeChecked<sensor_msgs::JointState>(
      node_,
      "joint_states",
      kNewest,
      [this](const sensor_msgs::JointState::ConstPtr& message) { guide_.receive(*message); },
      tellRefusal("joint_states")));
  subscribers_.push_back(subscribeChecked<geometry_msgs::QuaternionStamped>(
      node_,
      "measured_orientation",
      kNewest,
      [this](const geometry_msgs::QuaternionStamped::ConstPtr& message) {
        guide_.receive(*message);
      },
      tellRefusal("measured_orientation")));
  subscribers_.push_back(subscribeChecked<msg::CalibrationSample>(
      node_,
      "samples",
      kAll,
      [this](const msg::CalibrationSample::ConstPtr& message) { guide_.receive(*message); },
      tellRefusal("samples")));
}

void HandGuide::refresh() {
  guide_.judgeBy(model_.poseTolerance(), model_.currentThreshold());
  showPlan();
  showMeasurement();
  tellTarget();
  showAdvice();
}

void HandGuide::planOrStop() {
  if (planning_.isRunning()) {
    // The second click of a double click wants what the first one did.
    if (planning_since_.elapsed() > QApplication::doubleClickInterval()) {
      planning_.cancel();
    }
    return;
  }
  planning_since_.start();
  msg::PlanGoal goal;
  goal.max_poses = static_cast<std::uint32_t>(poses_->value());
  planned_ = "Planning …";
  planning_.begin(goal);
}

void HandGuide::showPlan() {
  if (const auto end = planning_.takeEnd()) {
    if (end->success) {
      if (model_.hasJoints()) {
        guide_.nameJoints(jointNames(node_, guide_.jointNames()));
      } else {
        guide_.followOrientations();
      }
      guide_.take(end->result.poses);
    }
    outcome_->setText(QString::fromStdString(end->message));
  } else if (planning_.isRunning()) {
    outcome_->setText(QString::fromStdString(planned_));
  }
}

void HandGuide::measureOrStop() {
  if (capture_.isRunning()) {
    capture_.cancel();
    return;
  }
  measure();
}

// Without a plan, or between its poses: the pose as it is, without current.
void HandGuide::measure() {
  msg::CaptureGoal goal;
  goal.current = current_->value();
  goal.duration = duration_();
  goal.validation = static_cast<std::uint8_t>(hold_out_());
  pose_ = guide_.here();
  goal.here = static_cast<std::uint8_t>(!pose_);
  if (pose_) {
    const std::vector<std::uint32_t> missing = guide_.missing(*pose_);
    if (missing.empty()) {
      outcome_->setText("This pose is measured already.");
      return;
    }
    const std::array<double, 3>& joints = guide_.joints(*pose_);
    std::copy(joints.begin(), joints.end(), goal.pose.joint_position.begin());
    std::copy_if(
        missing.begin(), missing.end(), std::back_inserter(goal.pose.coils), [](auto coil) {
          return coil != 0;
        });
  }
  if (!goal.pose.coils.empty() && goal.current == 0.0) {
    outcome_->setText("Choose the current of the planned coils first.");
    return;
  }
  words_ = ProgressWords();
  capture_.begin(goal);
}

void HandGuide::showMeasurement() {
  if (const auto end = capture_.takeEnd()) {
    if (end->success && pose_) {
      guide_.noteMeasured(*pose_);
    }
    outcome_->setText(QString::fromStdString(end->message));
  } else if (capture_.isRunning()) {
    outcome_->setText(QString::fromStdString(words_.text()));
  }
}

void HandGuide::tellTarget() {
  const std::optional<std::array<double, 3>> target = guide_.target();
  if (target == told_target_) {
    return;
  }
  told_target_ = target;
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time::now();
  if (target) {
    message.name.assign(guide_.jointNames().begin(), guide_.jointNames().end());
    message.position.assign(target->begin(), target->end());
  }
  wanted_pose_.publish(message);
}

void HandGuide::showAdvice() {
  const QString advice = QString::fromStdString(guide_.advice());
  if (advice != advice_->text()) {
    advice_->setText(advice);
  }
  nameButton(*measure_, capture_.isRunning() ? "Stop" : "Measure pose", "F3");
  nameButton(*plan_, planning_.isRunning() ? "Stop" : "Plan", "F2");
  measure_->setEnabled(!planning_.isRunning());
  plan_->setEnabled(!capture_.isRunning());
}

}  // namespace sac
