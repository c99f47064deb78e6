#include <memory>

#include "spherical_actuator_calibration/ros/conversion/description_parameter.hpp"
#include "spherical_actuator_calibration/ros/devices/coil_driver_node.hpp"
#include "spherical_actuator_calibration/ros/node/memory_limit.hpp"
#include "spherical_actuator_calibration/ros/node/node_main.hpp"
#include "spherical_actuator_calibration/ros/node/termination.hpp"
#include "spherical_actuator_calibration/ros/node/thread_priority.hpp"

namespace {

/// For taking leave of the master, when the currents are zero [s].
constexpr unsigned kLeave = 3;

}  // namespace

int main(int argc, char** argv) {
  sac::askForRealTime();
  bool may_flow = false;
  std::unique_ptr<sac::ZeroWatch> watch;
  const int status = sac::runNode(
      argc,
      argv,
      "coil_driver",
      [&may_flow, &watch](const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
        may_flow = true;
        const sac::CurrentAmplifierOptions options = sac::loadCurrentAmplifierOptions(private_node);
        sac::handleFatalExceptions();
        sac::limitMemory(options.memory_limit);
        sac::CoilDriverNode coil_driver(node,
                                        private_node,
                                        sac::loadDescriptionParameter(node).actuator,
                                        options,
                                        sac::makeTransport(options.link));
        sac::spinUntilTermination();
        may_flow = !coil_driver.stop();
        // Whoever started this program must not take it for done while current may flow.
        sac::endWithin(kLeave, may_flow || sac::failedFatally() ? 1 : 0);
        if (!may_flow) {
          watch = coil_driver.watch();
        }
      });
  // ROS has taken its time to end.
  may_flow = may_flow || (watch && !watch->end());
  return status == 0 && (may_flow || sac::failedFatally()) ? 1 : status;
}
