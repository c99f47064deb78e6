#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <actionlib/client/simple_action_client.h>
#include <ros/node_handle.h>

#include "spherical_actuator_calibration/base/printable_text.hpp"
#include "spherical_actuator_calibration/ros/conversion/messages.hpp"

namespace sac {

/// Has the engine do something, by one of its actions, and follows it. Callbacks come by the queue
/// of the node. With it its subscription ends, at which the engine cancels the goal.
template <typename Action>
class EngineAction {
 public:
  ACTION_DEFINITION(Action)

  /// How it ended.
  struct End {
    bool success = false;
    std::string message;  ///< one sentence
    Result result;        ///< empty where the engine has gone
  };

  /// `name`: of the action, such as calibration/capture; `receive` gets the feedback.
  EngineAction(ros::NodeHandle node,
               const std::string& name,
               std::function<void(const Feedback&)> receive)
      : name_(name), receive_(std::move(receive)), client_(node, name, false) {}
  ~EngineAction() = default;
  EngineAction(const EngineAction&) = delete;
  EngineAction& operator=(const EngineAction&) = delete;
  EngineAction(EngineAction&&) = delete;
  EngineAction& operator=(EngineAction&&) = delete;

  /// Precondition: !isRunning().
  void begin(const Goal& goal) {
    is_running_ = true;
    end_.reset();
    if (!client_.isServerConnected()) {
      end_ = {false,
              "The engine does not answer (" + name_ + "): is session_engine running?",
              Result()};
      return;
    }
    client_.sendGoal(
        goal,
        [this](const actionlib::SimpleClientGoalState& state, const ResultConstPtr& result) {
          end(state, result);
        },
        {},
        [this](const FeedbackConstPtr& feedback) { receive_(*feedback); });
  }
  bool isRunning() const { return is_running_; }
  /// The engine takes the currents to zero; the end comes as any other. Nothing where none runs.
  void cancel() {
    if (is_running_ && !end_) {
      client_.cancelGoal();
    }
  }
  /// How it ended, once, when it has; to be asked again and again, as an engine may go without a
  /// word.
  std::optional<End> takeEnd() {
    if (is_running_ && !end_ && !client_.isServerConnected()) {
      client_.stopTrackingGoal();
      end_ = {false,
              "The engine has ended, and with it the currents: try again once it is back.",
              Result()};
    }
    if (!is_running_ || !end_) {
      return std::nullopt;
    }
    is_running_ = false;
    return end_;
  }

 private:
  void end(const actionlib::SimpleClientGoalState& state, const ResultConstPtr& result) {
    const bool is_told = result && !result->message.empty();
    end_ = {state == actionlib::SimpleClientGoalState::SUCCEEDED && result && result->success != 0,
            is_told ? printable(result->message) : "The engine has been started anew: try again.",
            result ? *result : Result()};
  }

  std::string name_;
  std::function<void(const Feedback&)> receive_;
  actionlib::SimpleActionClient<Action> client_;
  bool is_running_ = false;
  std::optional<End> end_;
};

}  // namespace sac
