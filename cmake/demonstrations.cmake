# What a demonstration runs, as one target each: make would go through the messages again for every target that it is
# given. A system without a session database has no calibration node, and no demonstrations with nodes.

if(NOT TARGET calibration)
  return()
endif()
set(laboratory
  calibration
  coil_driver
  joint_sensor
  lab_emulator
  tracker_bridge
  ${PROJECT_NAME}_generate_messages_py
)

# add_demonstration(<name> targets...): <name>_programs. A name that is no target would be taken for a file, which only
# fails once the demonstration is built.
function(add_demonstration name)
  foreach(program IN LISTS ARGN)
    if(NOT TARGET ${program})
      message(FATAL_ERROR "${name} needs \"${program}\", which is no target.")
    endif()
  endforeach()
  add_custom_target(${name}_programs DEPENDS ${ARGN})
endfunction()

add_demonstration(demo ${laboratory} calibrate_bag generate_urdf session_recorder)
add_demonstration(tracking_demo ${laboratory} orientation_controller)
add_demonstration(motion_demo
  ${laboratory} calibrate_bag orientation_controller plan_motion publish_parameters session_recorder simulate_recording)
if(LIVE_VIEW)
  add_dependencies(demo_programs visualization)
  add_dependencies(tracking_demo_programs visualization sac_rviz)
endif()
