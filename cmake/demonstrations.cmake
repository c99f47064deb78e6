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
add_custom_target(demo_programs
  DEPENDS ${laboratory} calibrate_bag generate_urdf session_recorder visualization)
add_custom_target(tracking_demo_programs
  DEPENDS ${laboratory} orientation_controller visualization ${PROJECT_NAME}_rviz)
add_custom_target(motion_demo_programs
  DEPENDS ${laboratory} calibrate_bag orientation_controller plan_motion publish_parameters session_recorder)
