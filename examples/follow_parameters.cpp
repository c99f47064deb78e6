// A node that follows the calibration: whenever other parameters come into force, it tells how much
// torque the strongest coil exerts per ampere with the rotor at home.
//   follow_parameters ACTUATOR.yaml __ns:=/actuator
#include <exception>

#include <ros/ros.h>
#include <spherical_actuator_calibration/ActuatorParameters.h>
#include <spherical_actuator_calibration/actuator/description_file.hpp>
#include <spherical_actuator_calibration/actuator/torque_model.hpp>
#include <spherical_actuator_calibration/ros/conversion/msg_conversion.hpp>

namespace {

using spherical_actuator_calibration::ActuatorParameters;

void tellStrongestCoil(const sac::Actuator& design, const ActuatorParameters& message) {
  const auto actuator = sac::actuatorFromRos(message, design);
  if (!actuator) {
    ROS_ERROR("The parameters in force belong to another actuator: %s.", message.actuator.c_str());
    return;
  }
  if (!actuator->hasTorqueModel()) {
    ROS_WARN("revision %u (%s): an actuator without poles and coils exerts no torque.",
             message.revision,
             message.source.c_str());
    return;
  }
  const Eigen::Matrix3Xd torque = sac::torquePerAmpere(sac::TorqueCurve(*actuator->torque_curve),
                                                       sac::torqueGeometry(*actuator),
                                                       Eigen::Matrix3d::Identity());
  Eigen::Index coil = 0;
  const double strength = torque.colwise().norm().maxCoeff(&coil);
  ROS_INFO("revision %u (%s): coil %d exerts %.9f N*m/A",
           message.revision,
           message.source.c_str(),
           static_cast<int>(coil) + 1,
           strength);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "follow_parameters");
  if (argc != 2) {
    ROS_FATAL("usage: follow_parameters ACTUATOR.yaml");
    return 2;
  }
  try {
    const sac::Actuator design = sac::loadActuator(argv[1]);
    ros::NodeHandle node;
    const ros::Subscriber subscriber = node.subscribe<ActuatorParameters>(
        "parameters", 1, [&design](const ActuatorParameters::ConstPtr& message) {
          tellStrongestCoil(design, *message);
        });
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
