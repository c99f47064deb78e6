#pragma once

#include <QLabel>
#include <QPushButton>
#include <QWidget>
#include <functional>

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "motion_chart.hpp"
#include "motion_history.hpp"
#include "service_caller.hpp"

namespace sac {

/// What a motion tells while it goes on, and what is made of it.
class MotionView : public QWidget {
 public:
  /// `calibrate`, `forget`: called when their buttons are pressed.
  MotionView(const ros::NodeHandle& node,
             std::function<void()> calibrate,
             std::function<void()> forget);

  /// To be called ten times a second.
  void refresh();
  QPushButton* calibrateButton() const { return calibrate_; }
  QPushButton* forgetButton() const { return forget_; }

 private:
  void endMotion();
  void showMotion();

  ros::NodeHandle node_;
  ServiceCaller caller_;
  MotionHistory history_;
  bool changed_ = true;
  ros::Subscriber subscriber_;
  QPushButton* calibrate_;
  QPushButton* end_;
  QPushButton* forget_;
  QLabel* words_;
  QLabel* trouble_;
  MotionChart* chart_;
  QLabel* dynamics_;
};

}  // namespace sac
