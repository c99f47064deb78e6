#pragma once

#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QWidget>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include "coil_exciter.hpp"
#include "panel_model.hpp"
#include "pose_guide.hpp"
#include "pose_measurement.hpp"
#include "service_caller.hpp"

namespace sac {

/// For a rotor that a hand turns: plans poses, tells which way to turn, in degrees, and measures a
/// pose by one button: without current, then with each planned coil excited in turn. Publishes the
/// pose that is next on `wanted_pose`, so that it can be seen.
class HandGuide : public QWidget {
 public:
  /// `model` outlives it; `hold_out()` tells whether samples are to judge only.
  HandGuide(const ros::NodeHandle& node,
            const PanelModel& model,
            std::function<bool()> hold_out,
            std::function<double()> duration);

  /// To be called ten times a second.
  void refresh();

 private:
  /// What the running call, or the last one, is for.
  enum class Asked { kPlan, kCapture };

  void build();
  void listen();
  void plan();
  void take(const ServiceAnswer& answer);
  void takePlan(const ServiceAnswer& answer);
  void measureOrStop();
  void measure();
  void goOn();
  void askForCapture();
  void finish();
  void showAdvice();
  void tellTarget();

  ros::NodeHandle node_;
  const PanelModel& model_;
  std::function<bool()> hold_out_;
  std::function<double()> duration_;
  PoseGuide guide_;
  PoseMeasurement measurement_;
  CoilExciter exciter_;
  ServiceCaller caller_;
  Asked asked_ = Asked::kPlan;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher wanted_pose_;
  std::optional<std::array<double, 3>> told_target_;
  std::optional<std::array<double, 3>>
      pose_;  ///< planned, that is measured [rad]; or what is there

  QPushButton* plan_ = nullptr;
  QSpinBox* poses_ = nullptr;
  QDoubleSpinBox* current_ = nullptr;
  QPushButton* measure_ = nullptr;
  QLabel* advice_ = nullptr;
  QLabel* outcome_ = nullptr;
};

}  // namespace sac
