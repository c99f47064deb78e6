# The package for others. find_package(sac) gives sac::core, sac::control, … without ROS; catkin's
# find_package(catkin COMPONENTS spherical_actuator_calibration) adds the messages and sac::ros. Both find their files
# beside themselves, in an installation (which may be moved) as in the devel space.
include(CMakePackageConfigHelpers)

set(export_destination ${CATKIN_PACKAGE_LIB_DESTINATION}/cmake/sac)
set(export_devel ${CATKIN_DEVEL_PREFIX}/lib/cmake/sac)

configure_file(cmake/sacConfig.cmake ${export_devel}/sacConfig.cmake COPYONLY)
write_basic_package_version_file(${export_devel}/sacConfigVersion.cmake
  VERSION ${${PROJECT_NAME}_VERSION}
  COMPATIBILITY SameMinorVersion)
install(FILES cmake/sacConfig.cmake DESTINATION ${export_destination})
# Made at configuration, in no source folder.
#catkin_lint: ignore_once external_file
install(FILES ${export_devel}/sacConfigVersion.cmake DESTINATION ${export_destination})

foreach(set sac sac_ros)
  export(EXPORT ${set} NAMESPACE sac:: FILE ${export_devel}/${set}_targets.cmake)
  install(EXPORT ${set} NAMESPACE sac:: FILE ${set}_targets.cmake DESTINATION ${export_destination})
endforeach()
