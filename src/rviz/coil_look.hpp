#pragma once

#include <QDoubleSpinBox>
#include <QPushButton>
#include <QSpinBox>
#include <QWidget>

#include <ros/node_handle.h>

#include "engine_action.hpp"
#include "outcome_label.hpp"
#include "pose_guide.hpp"
#include "progress_words.hpp"
#include "spherical_actuator_calibration/ExciteAction.h"

namespace sac {

/// A look at a coil: has the engine excite it for a while, and shows what all coils carry
/// meanwhile. Nothing is excited by a window that nobody sees: where it is hidden or closed, the
/// currents end.
class CoilLook : public QWidget {
 public:
  /// `outcome`, which shows how an excitation goes, outlives it.
  CoilLook(const ros::NodeHandle& node, OutcomeLabel& outcome);

  /// Coils of the actuator, and whether they are to be had; to be called ten times a second.
  void refresh(int coils, Bench bench);

 protected:
  void hideEvent(QHideEvent* event) override;

 private:
  void build();
  void exciteOrStop();
  void showExcitation();

  ExcitationWords words_;
  EngineAction<msg::ExciteAction> excitation_;
  QPushButton* excite_ = nullptr;
  QSpinBox* coil_ = nullptr;
  QDoubleSpinBox* current_ = nullptr;
  QDoubleSpinBox* duration_ = nullptr;
  OutcomeLabel& outcome_;
};

}  // namespace sac
