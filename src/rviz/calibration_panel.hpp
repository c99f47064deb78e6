#pragma once

#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QElapsedTimer>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QTimer>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <rviz/panel.h>

#include "coil_look.hpp"
#include "convergence_chart.hpp"
#include "coverage_bars.hpp"
#include "hand_guide.hpp"
#include "health_view.hpp"
#include "motion_view.hpp"
#include "outcome_label.hpp"
#include "panel_model.hpp"
#include "parameter_table.hpp"
#include "revision_table.hpp"
#include "sample_table.hpp"
#include "service_caller.hpp"

namespace sac {

/// Panel of rviz for a calibration in the namespace that rviz runs in: streams and their health,
/// what is sampled and what is missing, buttons for the services of the calibration node, the
/// grade, the parameters in force with their uncertainty, and what the last cycle did. It talks
/// through topics, services and actions only.
class CalibrationPanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit CalibrationPanel(QWidget* parent = nullptr);

  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  void build();
  QLayout* makeCaptureRow();
  QLayout* makeCycleRow();
  QLayout* makeFileRow();
  QWidget* makeResults();
  QPushButton* addButton(QLayout* row,
                         const QString& text,
                         const QString& help,
                         const QString& key = QString());

  void listen();
  template <typename Message>
  void feed(const std::string& topic);

  void refresh();
  /// Asks for the samples in use where some are not known, or went.
  void learnSamples();
  void showCalibration();
  /// How long a call runs, or what came of it.
  void showAnswer();

  void setCallsEnabled(bool enabled);
  /// Level 1 is not offered where there is nothing to calibrate.
  void offerJointCycle();
  void capture();
  void calibrate(const std::string& service, std::uint32_t coil);
  void trigger(const std::string& service);
  /// Triggers a service once somebody has said that it is meant.
  void triggerIfMeant(const std::string& service, const QString& title, const QString& question);
  void removeSample(std::uint32_t id);
  void restore(std::uint32_t revision);
  void setAutoCapture(bool on);
  template <typename Service>
  void call(const std::string& service, const typename Service::Request& request);

  ros::NodeHandle node_;
  PanelModel model_;
  ServiceCaller caller_;
  ServiceCaller lister_;  ///< of samples
  std::vector<ros::Subscriber> subscribers_;
  bool changed_ = true;
  int ticks_ = 0;
  QTimer timer_;

  QLabel* next_step_ = nullptr;
  HealthView* health_ = nullptr;
  CoverageBars* bars_ = nullptr;
  std::vector<QPushButton*> buttons_;
  bool are_calls_enabled_ = true;
  QPushButton* joint_cycle_ = nullptr;
  QString joint_cycle_help_;  ///< what its tool tip says where it is offered
  QDoubleSpinBox* duration_ = nullptr;
  QCheckBox* validation_ = nullptr;
  HandGuide* hand_guide_ = nullptr;
  CoilLook* coil_look_ = nullptr;
  QCheckBox* auto_capture_ = nullptr;
  QSpinBox* coil_ = nullptr;
  OutcomeLabel* outcome_ = nullptr;
  QString called_;       ///< service of the running or the last call
  QElapsedTimer since_;  ///< its begin
  QLabel* grade_ = nullptr;
  ParameterTable* parameters_ = nullptr;
  ParameterTable* estimates_ = nullptr;
  SampleTable* samples_ = nullptr;
  RevisionTable* revisions_ = nullptr;
  ConvergenceChart* chart_ = nullptr;
  MotionView* motion_ = nullptr;
};

}  // namespace sac
