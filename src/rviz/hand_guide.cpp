#include "hand_guide.hpp"

#include <QApplication>
#include <QHBoxLayout>
#include <QVBoxLayout>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include <xmlrpcpp/XmlRpcValue.h>

#include "excitation_limits.hpp"
#include "named_button.hpp"
#include "spherical_actuator_calibration/base/numbering.hpp"
#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "steady_label.hpp"

namespace sac {
namespace {

constexpr int kMostPoses = 100;
constexpr int kSilenceOfEngine = 2000;  // [ms] after which it has gone: it tells its goals at 5 Hz

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

template <typename End>
OutcomeLabel::Ending endingOf(const End& end) {
  return end.success ? OutcomeLabel::Ending::kGood : OutcomeLabel::Ending::kBad;
}

}  // namespace

HandGuide::HandGuide(const ros::NodeHandle& node,
                     const PanelModel& model,
                     std::function<bool()> hold_out,
                     std::function<double()> duration,
                     OutcomeLabel& outcome)
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
      wanted_pose_(node_.advertise<sensor_msgs::JointState>("wanted_pose", 1, true)),
      outcome_(outcome) {
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
  current_->setValue(kOfferedCurrent);
  current_->setSuffix(" A");
  row->addWidget(current_);
  layout->addLayout(row);
}

// The newest message counts; rviz delivers it in the thread of the windows.
void HandGuide::listen() {
  constexpr std::uint32_t kNewest = 1;
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
  subscribers_.push_back(subscribeChecked<msg::PlanProgress>(
      node_,
      "plan_progress",
      kNewest,
      [this](const msg::PlanProgress::ConstPtr& message) {
        if (!guide_.hasPlan() && !message->poses.empty()) {
          guide_.nameJoints(jointNames(node_, guide_.jointNames()));
        }
        guide_.receive(*message);
      },
      tellRefusal("plan_progress")));
  subscribers_.push_back(subscribeChecked<actionlib_msgs::GoalStatusArray>(
      node_,
      "calibration/session/status",
      kNewest,
      [this](const actionlib_msgs::GoalStatusArray::ConstPtr& message) {
        session_heard_.start();
        guide_.receive(*message);
      },
      tellRefusal("calibration/session/status")));
  subscribers_.push_back(subscribeChecked<msg::SessionActionFeedback>(
      node_,
      "calibration/session/feedback",
      kNewest,
      [this](const msg::SessionActionFeedback::ConstPtr& message) {
        session_ = sessionInWords(message->feedback.progress);
      },
      tellRefusal("calibration/session/feedback")));
}

void HandGuide::refresh() {
  guide_.judgeBy(model_.poseTolerance());
  if (session_heard_.hasExpired(kSilenceOfEngine)) {
    guide_.receive(actionlib_msgs::GoalStatusArray());
  }
  if (!model_.hasJoints()) {
    guide_.followOrientations();
  }
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
  goal.validation = static_cast<std::uint8_t>(hold_out_());
  planned_ = "Planning …";
  planning_.begin(goal);
}

void HandGuide::showPlan() {
  if (const auto end = planning_.takeEnd()) {
    outcome_.showEnd(QString::fromStdString(end->message), endingOf(*end));
  } else if (planning_.isRunning()) {
    outcome_.showCourse(QString::fromStdString(planned_));
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
  const std::optional<std::size_t> here = guide_.here();
  goal.here = static_cast<std::uint8_t>(!here);
  const std::string refusal = here ? askFor(guide_.pose(*here), goal) : "";
  if (!refusal.empty()) {
    outcome_.showEnd(QString::fromStdString(refusal), OutcomeLabel::Ending::kBad);
    return;
  }
  words_ = ProgressWords();
  capture_.begin(goal);
}

std::string HandGuide::askFor(const msg::PoseProgress& pose, msg::CaptureGoal& goal) const {
  if (pose.is_measured != 0) {
    return "This pose is measured already.";
  }
  if ((pose.pose.validation != 0) != (goal.validation != 0)) {
    return pose.pose.validation != 0
               ? "This pose is planned to judge by: tick \"hold out\", or plan anew."
               : "This pose is planned to calibrate by: untick \"hold out\", or plan anew.";
  }
  if (!pose.missing.empty() && goal.current == 0.0) {
    return "Choose the current of the planned coils first.";
  }
  goal.pose.joint_position = pose.pose.joint_position;
  for (const msg::CoilPattern& pattern : pose.missing) {
    std::vector<double>& currents = goal.pose.patterns.emplace_back().current;
    currents.assign(model_.coils(), 0.0);
    for (const std::int32_t coil : pattern.coils) {
      const auto index =
          indexOf(static_cast<std::size_t>(std::abs(static_cast<std::int64_t>(coil))));
      if (!index || *index >= currents.size()) {
        return "The plan is of another actuator: plan anew.";
      }
      // The goal's sign is that of the pattern as a whole.
      currents[*index] = std::copysign(goal.current, static_cast<double>(coil));
    }
  }
  return "";
}

void HandGuide::showMeasurement() {
  if (const auto end = capture_.takeEnd()) {
    outcome_.showEnd(QString::fromStdString(end->message), endingOf(*end));
  } else if (capture_.isRunning()) {
    outcome_.showCourse(QString::fromStdString(words_.text()));
  }
}

// What a session showed it takes back at its end: then this is told anew.
void HandGuide::tellTarget() {
  if (guide_.bench() == Bench::kInSession) {
    told_target_.reset();
    return;
  }
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
  const bool is_free = guide_.bench() == Bench::kFree;
  const QString advice = QString::fromStdString(is_free ? guide_.advice() : session_);
  if (advice != advice_->text()) {
    advice_->setText(advice);
  }
  nameButton(*measure_, capture_.isRunning() ? "Stop" : "Measure pose", "F3");
  nameButton(*plan_, planning_.isRunning() ? "Stop" : "Plan", "F2");
  measure_->setEnabled(capture_.isRunning() || (is_free && !planning_.isRunning()));
  plan_->setEnabled(planning_.isRunning() || (is_free && !capture_.isRunning()));
}

}  // namespace sac
