#include "hand_guide.hpp"

#include <QHBoxLayout>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <utility>

#include <xmlrpcpp/XmlRpcValue.h>

#include "spherical_actuator_calibration/Capture.h"
#include "spherical_actuator_calibration/CapturePlanned.h"
#include "spherical_actuator_calibration/PlanPoses.h"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"

namespace sac {
namespace {

constexpr int kMostPoses = 100;
constexpr double kLargestCurrent = 100.0;  // [A]; the coil driver has its own limits
/// Beside the capture: for currents to come, and for the node to answer [s].
constexpr double kLongestBeside = 15.0;

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

CaptureOutcome::Flaw flawOf(const ServiceAnswer& answer) {
  using Flaw = CaptureOutcome::Flaw;
  if (answer.flaw == msg::CapturePlannedResponse::EXCITATION) {
    return Flaw::kExcitation;
  }
  if (answer.flaw == msg::CapturePlannedResponse::REST) {
    return Flaw::kRestInterrupted;
  }
  return answer.flaw.empty() ? Flaw::kNone : Flaw::kOther;
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
      exciter_(node),
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
  layout->addWidget(advice_);
  auto* row = new QHBoxLayout;
  plan_ = new QPushButton("Plan");
  plan_->setToolTip("Choose the poses that tell most, given the samples held (F2)");
  plan_->setShortcut(QKeySequence("F2"));
  connect(plan_, &QPushButton::clicked, this, [this] { plan(); });
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
  subscribers_.push_back(subscribeChecked<msg::CalibrationSample>(
      node_,
      "samples",
      kAll,
      [this](const msg::CalibrationSample::ConstPtr& message) { guide_.receive(*message); },
      tellRefusal("samples")));
}

void HandGuide::refresh() {
  guide_.judgeBy(model_.poseTolerance(), model_.currentThreshold());
  measurement_.requireAtLeast(model_.leastCurrent());
  if (const std::optional<ServiceAnswer> answer = caller_.takeAnswer()) {
    take(*answer);
  }
  if (measurement_.isRunning()) {
    goOn();
  } else if (exciter_.coil() != 0) {
    finish();
  }
  tellTarget();
  showAdvice();
}

void HandGuide::take(const ServiceAnswer& answer) {
  const double now = ros::SteadyTime::now().toSec();
  switch (asked_) {
    case Asked::kPlan:
      takePlan(answer);
      break;
    case Asked::kCapture:
      measurement_.captured({answer.success, answer.message, flawOf(answer)}, now);
      break;
  }
}

void HandGuide::plan() {
  if (caller_.isBusy()) {
    return;
  }
  msg::PlanPoses::Request request;
  request.cycle = "refine";
  request.max_poses = static_cast<std::uint32_t>(poses_->value());
  asked_ = Asked::kPlan;
  outcome_->setText("Planning …");
  caller_.call<msg::PlanPoses>(node_.resolveName("calibration/plan_poses"), request);
}

void HandGuide::takePlan(const ServiceAnswer& answer) {
  if (answer.success) {
    guide_.nameJoints(jointNames(node_, guide_.jointNames()));
    guide_.take(answer.poses);
  }
  outcome_->setText(QString::fromStdString(answer.message));
}

void HandGuide::measureOrStop() {
  if (measurement_.isRunning()) {
    measurement_.end("Stopped; the currents are zero.");
    finish();
    return;
  }
  measure();
}

// Without a plan, or between its poses: the pose as it is, without current.
void HandGuide::measure() {
  if (caller_.isBusy()) {
    return;
  }
  std::vector<std::uint32_t> patterns = {0};
  pose_.reset();
  if (const std::optional<std::size_t> here = guide_.here()) {
    patterns = guide_.missing(*here);
    pose_ = guide_.joints(*here);
  }
  if (patterns.empty()) {
    outcome_->setText("This pose is measured already.");
    return;
  }
  measurement_.begin(std::move(patterns), current_->value(), ros::SteadyTime::now().toSec());
  goOn();
}

void HandGuide::goOn() {
  const double seconds = duration_() + kLongestBeside;
  if (measurement_.coil() != exciter_.coil()) {
    exciter_.excite(measurement_.coil(), model_.coils(), measurement_.current(), seconds);
  }
  switch (measurement_.step(ros::SteadyTime::now().toSec())) {
    case PoseMeasurement::Action::kCapture:
      askForCapture();
      break;
    case PoseMeasurement::Action::kEnd:
      finish();
      break;
    case PoseMeasurement::Action::kNothing:
      outcome_->setText(measurement_.coil() == 0
                            ? QString("Measuring without current …")
                            : QString("Measuring with coil %1 …").arg(measurement_.coil()));
      break;
  }
}

void HandGuide::askForCapture() {
  asked_ = Asked::kCapture;
  const auto validation = static_cast<std::uint8_t>(hold_out_());
  if (!pose_) {
    msg::Capture::Request request;
    request.duration = duration_();
    request.validation = validation;
    caller_.call<msg::Capture>(node_.resolveName("calibration/capture"), request);
    return;
  }
  msg::CapturePlanned::Request request;
  std::copy(pose_->begin(), pose_->end(), request.joint_position.begin());
  if (measurement_.coil() != 0) {
    const auto coil = static_cast<std::int32_t>(measurement_.coil());
    request.coils = {measurement_.current() < 0.0 ? -coil : coil};
    request.current = std::abs(measurement_.current());
  }
  request.duration = duration_();
  request.validation = validation;
  caller_.call<msg::CapturePlanned>(node_.resolveName("calibration/capture_planned"), request);
}

void HandGuide::finish() {
  exciter_.stop();
  outcome_->setText(QString::fromStdString(measurement_.outcome()));
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
  // A new text takes the shortcut away.
  const char* what = measurement_.isRunning() ? "Stop" : "Measure pose";
  if (measure_->text() != what) {
    measure_->setText(what);
    measure_->setShortcut(QKeySequence("F3"));
  }
  plan_->setEnabled(!caller_.isBusy() && !measurement_.isRunning());
}

}  // namespace sac
