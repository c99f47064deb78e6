# Refuses another prefix than that of the configuration, before anything is installed: catkin has written that one into its
# setup files and into what installs the Python package, and half of the package would be elsewhere. DESTDIR is put before
# the prefix and does not change it.
install(CODE "
  set(configured_prefix [==[${CMAKE_INSTALL_PREFIX}]==])
  string(REGEX REPLACE \"/+$\" \"\" configured_prefix \"\${configured_prefix}\")
  string(REGEX REPLACE \"/+$\" \"\" asked_prefix \"\${CMAKE_INSTALL_PREFIX}\")
  if(NOT asked_prefix STREQUAL configured_prefix)
    message(FATAL_ERROR \"The build is configured for \${configured_prefix}, and cannot be installed to \"
      \"\${asked_prefix}: configure it with -DCMAKE_INSTALL_PREFIX=\${asked_prefix}, build, and install it again.\")
  endif()")
