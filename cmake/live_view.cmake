# What the panel of rviz needs. A computer without a display does without it.
option(LIVE_VIEW "Build the panel of rviz" ON)

# Not among the components of catkin: their libraries, rendering and all, would go to every program.
if(LIVE_VIEW)
  find_package(actionlib REQUIRED)
  find_package(rviz REQUIRED)
  find_package(pluginlib REQUIRED)
  # The Qt that rviz is built with, 6 on Debian 13: with two of them in one program the panel ends rviz.
  string(REGEX MATCH "^[0-9]+" QT_OF_RVIZ "${rviz_QT_VERSION}")
  find_package(Qt${QT_OF_RVIZ} REQUIRED COMPONENTS Charts Widgets)
elseif(CATKIN_ENABLE_TESTING)
  message(FATAL_ERROR "The tests click in the panel: configure with -DLIVE_VIEW=ON, or with -DCATKIN_ENABLE_TESTING=OFF.")
else()
  message(NOTICE "Without a live view the panel of rviz is left out.")
endif()
