# What Debian 11 (and with it Ubuntu 20.04) names otherwise, or lacks.

# The imported target <name>, by the target <older> where <name> is not known.
function(name_target name older)
  if(NOT TARGET ${name})
    add_library(${name} INTERFACE IMPORTED GLOBAL)
    target_link_libraries(${name} INTERFACE ${older})
  endif()
endfunction()

if(CATKIN_ENABLE_TESTING)
  name_target(Ceres::ceres ceres)
  name_target(GTest::gtest_main GTest::Main)
endif()
if(NOT TARGET urdfdom::urdfdom_model)
  pkg_check_modules(urdfdom REQUIRED IMPORTED_TARGET urdfdom)
  name_target(urdfdom::urdfdom_model PkgConfig::urdfdom)
endif()

# Vectors as ranges, selection by lists of indices: our sources use them, installed headers do not.
if(Eigen3_VERSION VERSION_LESS 3.4)
  set_property(TARGET Eigen3::Eigen APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS
    EIGEN_FUNCTORS_PLUGIN="${CMAKE_CURRENT_LIST_DIR}/eigen_3_3/selection.inl"
    EIGEN_PLAINOBJECTBASE_PLUGIN="${CMAKE_CURRENT_LIST_DIR}/eigen_3_3/plain_object.inl")
endif()

if(yaml-cpp_VERSION VERSION_LESS 0.7)
  add_compile_definitions(YAML_CPP_BEFORE_0_7)
endif()
