# Targets of the libraries that need no ROS: sac::core, sac::control, sac::drivers, sac::emulation, sac::storage.
# find_package(sac REQUIRED COMPONENTS core control): fails when this installation was built without one of them.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)

# A workspace that builds the package itself has the targets already.
if(NOT TARGET sac::core)
  include(${CMAKE_CURRENT_LIST_DIR}/sac_targets.cmake)
endif()

foreach(component ${sac_FIND_COMPONENTS})
  if(TARGET sac::${component})
    set(sac_${component}_FOUND TRUE)
  elseif(sac_FIND_REQUIRED_${component})
    set(sac_FOUND FALSE)
    set(sac_NOT_FOUND_MESSAGE "sac::${component} is no library of this installation that needs no ROS; sac::ros comes by\nfind_package(catkin COMPONENTS spherical_actuator_calibration).")
  endif()
endforeach()
