# What catkin's configuration of the package adds: targets, and with them ${catkin_LIBRARIES}.
set(sac_folder ${spherical_actuator_calibration_DIR}/../../../lib/cmake/sac)
find_package(sac REQUIRED CONFIG PATHS ${sac_folder} NO_DEFAULT_PATH)
if(NOT TARGET sac::ros)
  include(${sac_folder}/sac_ros_targets.cmake)
endif()
# Drivers, storage and emulation by name: they bring libmodbus and SQLite.
list(INSERT spherical_actuator_calibration_LIBRARIES 0 sac::ros sac::control sac::core)
