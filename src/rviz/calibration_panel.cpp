#include "calibration_panel.hpp"

#include <QHBoxLayout>
#include <QMessageBox>
#include <QScrollArea>
#include <QTabWidget>
#include <QVBoxLayout>
#include <optional>

#include <pluginlib/class_list_macros.hpp>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "spherical_actuator_calibration/Calibrate.h"
#include "spherical_actuator_calibration/Capture.h"
#include "spherical_actuator_calibration/RemoveSample.h"
#include "spherical_actuator_calibration/Restore.h"
#include "spherical_actuator_calibration/ros/conversion/checked_subscriber.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"
#include "steady_label.hpp"
#include "wheel_guard.hpp"

namespace sac {
namespace {

constexpr int kPeriod = 100;       // [ms] between two looks at what has come
constexpr int kTicksOfHealth = 5;  // looks between two pictures of the health
constexpr int kNarrowest = 380;    // [px]
constexpr const char* kLegend =
    "<small>streams: <span style='color:#1b9e4b'>●</span> good <span "
    "style='color:#d98200'>●</span> "
    "look at it <span style='color:#c62828'>●</span> fault <span style='color:#9a9fa6'>●</span> "
    "silent; samples: <span style='color:#f09628'>■</span> too few "
    "<span style='color:#3c78c8'>■</span> enough <span style='color:#289646'>■</span> identified"
    "</small>";
constexpr int kMostCoils = 999;

constexpr const char* kPrimaryStyle =
    "QPushButton { background: #1b7f3b; color: white; font-weight: bold; padding: 4px 10px; }"
    "QPushButton:disabled { background: #b5c9bb; }";

QLabel* wrappingLabel() {
  auto* label = new QLabel;
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

}  // namespace

CalibrationPanel::CalibrationPanel(QWidget* parent)
    : rviz::Panel(parent), model_(node_.getNamespace()) {
  build();
  listen();
  connect(&timer_, &QTimer::timeout, this, &CalibrationPanel::refresh);
  timer_.start(kPeriod);
}

void CalibrationPanel::build() {
  setMinimumWidth(kNarrowest);
  // A small screen gets a scroll bar; without it, rows would lose their lower halves.
  auto* content = new QWidget;
  auto* area = new QScrollArea;
  area->setWidgetResizable(true);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setFrameShape(QFrame::NoFrame);
  area->setWidget(content);
  auto* outside = new QVBoxLayout(this);
  outside->setContentsMargins(0, 0, 0, 0);
  outside->addWidget(area);
  auto* layout = new QVBoxLayout(content);
  layout->setSpacing(4);
  next_step_ = wrappingLabel();
  next_step_->setStyleSheet("font-weight: bold;");
  reserveLines(*next_step_, 3);
  layout->addWidget(next_step_);
  health_ = new HealthView;
  layout->addWidget(health_);
  bars_ = new CoverageBars;
  layout->addWidget(bars_);
  auto* legend = wrappingLabel();
  legend->setText(kLegend);
  layout->addWidget(legend);
  layout->addLayout(makeCaptureRow());
  // One place for what the engine says: there is little room.
  outcome_ = new OutcomeLabel;
  hand_guide_ = new HandGuide(
      node_,
      model_,
      [this] { return validation_->isChecked(); },
      [this] { return duration_->value(); },
      *outcome_);
  layout->addWidget(hand_guide_);
  coil_look_ = new CoilLook(node_, *outcome_);
  layout->addWidget(coil_look_);
  layout->addWidget(outcome_);
  layout->addLayout(makeCycleRow());
  layout->addLayout(makeFileRow());
  grade_ = wrappingLabel();
  reserveLines(*grade_, 3);
  layout->addWidget(grade_);
  layout->addWidget(makeResults(), 1);
  WheelGuard::protect(*content);
}

QPushButton* CalibrationPanel::addButton(QLayout* row,
                                         const QString& text,
                                         const QString& help,
                                         const QString& key) {
  auto* button = new QPushButton(text);
  button->setToolTip(key.isEmpty() ? help : help + " (" + key + ")");
  button->setShortcut(QKeySequence(key));
  row->addWidget(button);
  buttons_.push_back(button);
  return button;
}

QLayout* CalibrationPanel::makeCaptureRow() {
  auto* row = new QHBoxLayout;
  QPushButton* button =
      addButton(row, "Capture", "Average the present dwell into one sample", "F4");
  button->setStyleSheet(kPrimaryStyle);
  connect(button, &QPushButton::clicked, this, &CalibrationPanel::capture);
  duration_ = new QDoubleSpinBox;
  duration_->setSingleStep(0.1);
  duration_->setDecimals(1);
  duration_->setValue(1.0);
  duration_->setSuffix(" s");
  row->addWidget(duration_);
  validation_ = new QCheckBox("hold out");
  validation_->setToolTip("Never use the sample to estimate, only to judge (F5)");
  validation_->setShortcut(QKeySequence("F5"));
  row->addWidget(validation_);
  auto_capture_ = new QCheckBox("every dwell");
  auto_capture_->setToolTip("Capture every dwell by itself");
  connect(auto_capture_, &QCheckBox::clicked, this, &CalibrationPanel::setAutoCapture);
  row->addWidget(auto_capture_);
  return row;
}

QLayout* CalibrationPanel::makeCycleRow() {
  auto* row = new QHBoxLayout;
  const auto add = [&](const QString& text,
                       const std::string& service,
                       bool has_coil,
                       const QString& key = QString()) {
    QPushButton* button =
        addButton(row, text, QString::fromStdString("calibration/" + service), key);
    connect(button, &QPushButton::clicked, this, [this, service, has_coil] {
      calibrate(service, has_coil ? static_cast<std::uint32_t>(coil_->value()) : 0U);
    });
    return button;
  };
  coil_ = new QSpinBox;
  coil_->setRange(1, kMostCoils);
  coil_->setPrefix("coil ");
  joint_cycle_ = add("Joint", "calibrate_joint", false, "F6");
  joint_cycle_help_ = joint_cycle_->toolTip();
  add("Poles", "calibrate_poles", true);
  add("Coil", "calibrate_coil", true);
  row->addWidget(coil_);
  add("Refine", "refine", false, "F7");
  add("Validate", "validate", false, "F8");
  return row;
}

QLayout* CalibrationPanel::makeFileRow() {
  auto* row = new QHBoxLayout;
  connect(addButton(row, "Save", "Write the calibrated description, URDF and report", "F9"),
          &QPushButton::clicked,
          this,
          [this] { trigger("save"); });
  const auto add =
      [&](const char* text, const char* help, const char* service, const char* question) {
        connect(addButton(row, text, help), &QPushButton::clicked, this, [=] {
          triggerIfMeant(service, text, question);
        });
      };
  add("Forget samples",
      "Take all samples out of use; they stay in the database",
      "clear_samples",
      "Take all samples out of use? Only the session database keeps them.");
  add("Reset",
      "Put the description as it is drawn in force again, as a new revision",
      "reset",
      "Put the description as it is drawn in force again? Samples stay in use.");
  return row;
}

QWidget* CalibrationPanel::makeResults() {
  parameters_ = new ParameterTable;
  estimates_ = new ParameterTable;
  samples_ = new SampleTable([this](std::uint32_t id) { removeSample(id); });
  buttons_.push_back(samples_->removeButton());
  revisions_ = new RevisionTable(node_, [this](std::uint32_t number) { restore(number); });
  buttons_.push_back(revisions_->restoreButton());
  chart_ = new ConvergenceChart;
  motion_ = new MotionView(
      node_, [this] { calibrate("calibrate_motion", 0U); }, [this] { trigger("forget_motion"); });
  buttons_.push_back(motion_->calibrateButton());
  buttons_.push_back(motion_->forgetButton());
  auto* tabs = new QTabWidget;
  tabs->addTab(parameters_, "In force");
  tabs->addTab(estimates_, "Cycle");
  tabs->addTab(samples_, "Samples");
  tabs->addTab(revisions_, "&Revisions");
  tabs->addTab(chart_, "Convergence");
  tabs->addTab(motion_, "&Motion");
  return tabs;
}

void CalibrationPanel::listen() {
  feed<msg::CalibrationStatus>("status");
  feed<msg::CalibrationReport>("report");
  feed<msg::ActuatorParameters>("parameters");
  feed<msg::CalibrationSample>("samples");
  constexpr std::uint32_t kQueueLength = 100;
  subscribers_.push_back(subscribeChecked<diagnostic_msgs::DiagnosticArray>(
      node_,
      "/diagnostics",
      kQueueLength,
      [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
        model_.receive(*message, ros::WallTime::now());
      },
      tellRefusal("/diagnostics")));
}

// rviz delivers messages in the thread of the windows.
template <typename Message>
void CalibrationPanel::feed(const std::string& topic) {
  constexpr std::uint32_t kQueueLength = 1000;
  subscribers_.push_back(subscribeChecked<Message>(
      node_,
      topic,
      kQueueLength,
      [this](const typename Message::ConstPtr& message) {
        model_.receive(*message);
        changed_ = true;
      },
      tellRefusal(topic)));
}

void CalibrationPanel::refresh() {
  showAnswer();
  hand_guide_->refresh();
  coil_look_->refresh(static_cast<int>(model_.coils()), hand_guide_->bench());
  outcome_->age();
  revisions_->refresh(model_.revision(), model_.revisionNumber());
  motion_->refresh();
  if (ticks_++ % kTicksOfHealth == 0) {
    const ros::WallTime now = ros::WallTime::now();
    health_->fill(model_.streams(now), model_.troubles(now));
    learnSamples();
  }
  if (changed_) {
    changed_ = false;
    showCalibration();
  }
}

void CalibrationPanel::learnSamples() {
  if (const std::optional<ServiceAnswer> answer = lister_.takeAnswer()) {
    if (answer->success) {
      model_.receive(answer->samples);
    } else {
      model_.repeatRequestForSamples();
    }
    changed_ = true;
  }
  if (!lister_.isBusy() && model_.takeRequestForSamples()) {
    lister_.call<msg::ListSamples>(node_.resolveName("calibration/list_samples"),
                                   msg::ListSamples::Request());
  }
}

void CalibrationPanel::showCalibration() {
  offerJointCycle();
  if (!caller_.isBusy()) {
    auto_capture_->setChecked(model_.capturesByItself());
  }
  next_step_->setText(QString::fromStdString(model_.nextStep()));
  bars_->setGroups(model_.coverage());
  if (model_.longestCapture() > 0.0) {
    duration_->setRange(model_.shortestCapture(), model_.longestCapture());
  }
  coil_->setRange(1, std::max(1, static_cast<int>(model_.coils())));
  const std::string reason = model_.gradeReason() + " (" + model_.revision() + ")";
  grade_->setText(QString("<b%1>%2</b> <small>%3</small>")
                      .arg(model_.isContradicted() ? " style='color:#c62828'" : "",
                           QString::fromStdString(model_.grade()).toHtmlEscaped(),
                           QString::fromStdString(reason).toHtmlEscaped()));
  parameters_->fill(model_.parameters());
  estimates_->fill(model_.estimates());
  samples_->fill(model_.samples());
  chart_->setHistory(QString::fromStdString(model_.historyTitle()), model_.errorHistory());
}

void CalibrationPanel::showAnswer() {
  const std::optional<ServiceAnswer> answer = caller_.takeAnswer();
  if (answer) {
    const bool is_well = answer->success && !(called_ == "save" && model_.isContradicted());
    outcome_->showEnd(called_ + ": " + QString::fromStdString(answer->message),
                      is_well ? OutcomeLabel::Ending::kGood : OutcomeLabel::Ending::kBad);
    changed_ = true;
    setCallsEnabled(true);
  } else if (caller_.isBusy()) {
    outcome_->showCourse(QString("%1 runs, %2 s …").arg(called_).arg(since_.elapsed() / 1000));
  }
}

void CalibrationPanel::setCallsEnabled(bool enabled) {
  are_calls_enabled_ = enabled;
  if (!enabled && focusWidget() != nullptr) {
    // A disabled widget gives it to the next one, to which the panel would scroll.
    focusWidget()->clearFocus();
  }
  for (QPushButton* button : buttons_) {
    button->setEnabled(enabled);
  }
  auto_capture_->setEnabled(enabled);
  offerJointCycle();
}

void CalibrationPanel::offerJointCycle() {
  const QString refusal = QString::fromStdString(model_.whyNoJointCycle());
  joint_cycle_->setEnabled(refusal.isEmpty() && are_calls_enabled_);
  joint_cycle_->setToolTip(refusal.isEmpty() ? joint_cycle_help_ : refusal);
}

template <typename Service>
void CalibrationPanel::call(const std::string& service, const typename Service::Request& request) {
  if (caller_.isBusy()) {
    return;
  }
  called_ = QString::fromStdString(service);
  since_.start();
  setCallsEnabled(false);
  caller_.call<Service>(node_.resolveName("calibration/" + service), request);
  showAnswer();
}

void CalibrationPanel::capture() {
  msg::Capture::Request request;
  request.duration = duration_->value();
  request.validation = static_cast<std::uint8_t>(validation_->isChecked());
  call<msg::Capture>("capture", request);
}

void CalibrationPanel::calibrate(const std::string& service, std::uint32_t coil) {
  msg::Calibrate::Request request;
  request.coil = coil;
  call<msg::Calibrate>(service, request);
}

void CalibrationPanel::trigger(const std::string& service) {
  call<std_srvs::Trigger>(service, std_srvs::Trigger::Request());
}

void CalibrationPanel::triggerIfMeant(const std::string& service,
                                      const QString& title,
                                      const QString& question) {
  if (QMessageBox::question(this, title, question) == QMessageBox::Yes) {
    trigger(service);
  }
}

void CalibrationPanel::removeSample(std::uint32_t id) {
  msg::RemoveSample::Request request;
  request.id = id;
  call<msg::RemoveSample>("remove_sample", request);
}

void CalibrationPanel::restore(std::uint32_t revision) {
  msg::Restore::Request request;
  request.revision = revision;
  call<msg::Restore>("restore", request);
}

void CalibrationPanel::setAutoCapture(bool on) {
  std_srvs::SetBool::Request request;
  request.data = static_cast<std::uint8_t>(on);
  call<std_srvs::SetBool>("set_auto_capture", request);
}

void CalibrationPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  float duration = 0.0F;
  if (config.mapGetFloat("Capture Duration", &duration)) {
    duration_->setValue(static_cast<double>(duration));
  }
}

void CalibrationPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Capture Duration", duration_->value());
}

}  // namespace sac

PLUGINLIB_EXPORT_CLASS(sac::CalibrationPanel, rviz::Panel)
