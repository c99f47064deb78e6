#pragma once

#include <QDoubleSpinBox>
#include <QElapsedTimer>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QWidget>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include "engine_action.hpp"
#include "outcome_label.hpp"
#include "panel_model.hpp"
#include "pose_guide.hpp"
#include "progress_words.hpp"
#include "spherical_actuator_calibration/CaptureAction.h"
#include "spherical_actuator_calibration/PlanAction.h"
#include "spherical_actuator_calibration/SessionAction.h"

namespace sac {

/// For a rotor that a hand turns: has the engine plan poses, tells which way to turn, in degrees,
/// and has it measure a pose by one button: without current, then with each planned coil excited in
/// turn. Publishes the pose that is next on `wanted_pose`, so that it can be seen.
class HandGuide : public QWidget {
 public:
  /// `model` and `outcome`, which shows how a plan and a measurement go, outlive it; `hold_out()`
  /// tells whether samples are to judge only.
  HandGuide(const ros::NodeHandle& node,
            const PanelModel& model,
            std::function<bool()> hold_out,
            std::function<double()> duration,
            OutcomeLabel& outcome);

  /// To be called ten times a second.
  void refresh();
  /// Whether a guided session works, as of the last refresh().
  Bench bench() const { return guide_.bench(); }

 private:
  void build();
  void listen();
  void planOrStop();
  void showPlan();
  void measureOrStop();
  void measure();
  /// Has a goal ask for what a planned pose lacks. Returns why it cannot, in a sentence; empty: it
  /// can.
  std::string askFor(const msg::PoseProgress& pose, msg::CaptureGoal& goal) const;
  void showMeasurement();
  void showAdvice();
  void tellTarget();

  ros::NodeHandle node_;
  const PanelModel& model_;
  std::function<bool()> hold_out_;
  std::function<double()> duration_;
  PoseGuide guide_;
  ProgressWords words_;
  EngineAction<msg::CaptureAction> capture_;
  EngineAction<msg::PlanAction> planning_;
  QElapsedTimer planning_since_;
  std::string planned_;  ///< how far it is
  QElapsedTimer session_heard_;
  std::string session_;  ///< how far it is
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher wanted_pose_;
  std::optional<std::array<double, 3>> told_target_;

  QPushButton* plan_ = nullptr;
  QSpinBox* poses_ = nullptr;
  QDoubleSpinBox* current_ = nullptr;
  QPushButton* measure_ = nullptr;
  QLabel* advice_ = nullptr;
  OutcomeLabel& outcome_;
};

}  // namespace sac
