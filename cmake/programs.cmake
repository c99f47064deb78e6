# Programs that are installed as they are: what users run beside the nodes and tools.
# Their Python package is src/spherical_actuator_calibration; setup.py and catkin_python_setup() install it.

install(PROGRAMS scripts/record_session
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION}
)
catkin_install_python(
  PROGRAMS
    scripts/calibrate_by_motion
    scripts/export_session
    scripts/guided_session
    scripts/import_csv
    scripts/level_1_by_coils
    scripts/list_revisions
    scripts/plot_study
    scripts/plot_tracking
    scripts/render_report
    scripts/run_motion
    scripts/session_engine
    scripts/track_orientation
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION}
)
