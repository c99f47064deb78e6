# Libraries are made of rooms: folders of include/, src/ and test/ of the same name. A room uses only rooms that
# were added before it: the includes are held by dev/check_rooms, the symbols by the linker (see add_room()).

option(WARNINGS_AS_ERRORS "For developers: another compiler warns of other things" OFF)

# C++17, all warnings, and libraries found from an installed program without LD_LIBRARY_PATH.
function(use_project_options target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wzero-as-null-pointer-constant
    $<$<BOOL:${WARNINGS_AS_ERRORS}>:-Werror>
    # Templates leave much to collect: seldom done, it saves a tenth of the time for a tenth more memory.
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-expand=300 --param=ggc-min-heapsize=400000>)
  set_target_properties(${target} PROPERTIES
    CXX_STANDARD 17
    CXX_STANDARD_REQUIRED ON
    CXX_EXTENSIONS OFF
    POSITION_INDEPENDENT_CODE ON
    INSTALL_RPATH "$ORIGIN:$ORIGIN/..")
  # A library of its own before glibc 2.34.
  target_link_libraries(${target} PRIVATE Threads::Threads)
endfunction()

# Shells round the core turn messages and options into its types: half the optimisation saves a third of their compiler's
# time, and costs them nothing that shows.
function(use_shell_options target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

include(cmake/precompiled_headers.cmake)

option(SOURCES_IN_BATCHES "Compile twenty sources of a room together, and six of its tests, in less than two thirds of the time" ON)

# One shared library, whose rooms add their sources: sac_<part>, and sac::<part> for those who link it.
# add_library_of_rooms(<name> [ROS] [SHELL] [EXPORTED] [USES libraries...])
# ROS: with ROS headers and generated messages, as system headers: their warnings are not ours.
# SHELL: see use_shell_options().
# Twenty sources of a room are compiled as one (SOURCES_IN_BATCHES), so that what each keeps to itself, in a namespace
# without a name, has a name of its own among them.
# EXPORTED: other packages may link it, so that the headers of its rooms are installed (see export.cmake).
function(add_library_of_rooms name)
  cmake_parse_arguments(arg "ROS;SHELL;EXPORTED" "" "USES" ${ARGN})
  # libFuzzer and the sanitizers of clang are linked into programs alone.
  set(kind SHARED)
  if(FUZZING)
    set(kind STATIC)
  endif()
  add_library(${name} ${kind})
  use_project_options(${name})
  if(arg_SHELL)
    use_shell_options(${name})
  endif()
  string(REGEX REPLACE "^sac_" "" part ${name})
  # Without DEFINE_SYMBOL all libraries can share one precompiled header.
  set_target_properties(${name} PROPERTIES
    LINKER_LANGUAGE CXX
    DEFINE_SYMBOL ""
    EXPORT_NAME ${part}
    EXPORTED ${arg_EXPORTED})
  # Before 3.18 CMake cannot keep the rooms apart.
  if(SOURCES_IN_BATCHES AND NOT CMAKE_VERSION VERSION_LESS 3.18)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  endif()
  add_library(sac::${part} ALIAS ${name})
  target_include_directories(${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:include>)
  target_compile_features(${name} PUBLIC cxx_std_17)
  target_link_libraries(${name} PUBLIC ${arg_USES})
  # The link fails as soon as a symbol comes from a library that is not named.
  target_link_options(${name} PRIVATE -Wl,--no-undefined)
  if(arg_ROS)
    # Who links the installed library has both from catkin.
    set(headers ${catkin_INCLUDE_DIRS} ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION})
    set(libraries ${catkin_LIBRARIES})
    list(TRANSFORM headers REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
    list(TRANSFORM libraries REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
    target_include_directories(${name} SYSTEM PUBLIC ${headers})
    target_link_libraries(${name} PRIVATE ${catkin_LIBRARIES} INTERFACE ${libraries})
    add_dependencies(${name} ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})
  endif()
  set(export)
  if(arg_EXPORTED AND arg_ROS)
    set(export EXPORT sac_ros)
  elseif(arg_EXPORTED)
    set(export EXPORT sac)
  endif()
  install(TARGETS ${name} ${export}
    ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
endfunction()

# The room of the present folder: add_room(<room> LIBRARY <library> SOURCES files... [PRIVATE libraries...])
# PRIVATE: libraries that no header of the room shows. With ENABLE_CHECKS each room is linked once with those
# before it alone, so that a symbol of a later room fails the build.
function(add_room room)
  cmake_parse_arguments(arg "" "LIBRARY" "SOURCES;PRIVATE" ${ARGN})
  list(TRANSFORM arg_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  target_sources(${arg_LIBRARY} PRIVATE ${arg_SOURCES})
  get_target_property(in_batches ${arg_LIBRARY} UNITY_BUILD)
  if(in_batches)
    group_sources(${room} ${arg_LIBRARY} ${arg_SOURCES})
  endif()
  target_link_libraries(${arg_LIBRARY} PRIVATE ${arg_PRIVATE})
  set_property(TARGET ${arg_LIBRARY} APPEND PROPERTY ROOMS ${room})
  get_target_property(is_exported ${arg_LIBRARY} EXPORTED)
  if(is_exported)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/${PROJECT_NAME}/${room}/
      DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION}/${room}
      FILES_MATCHING PATTERN "*.hpp")
  endif()
  if(ENABLE_CHECKS)
    add_order_check(${room} ${arg_LIBRARY})
  endif()
endfunction()

# Batches of twenty: group_sources(<room> <library> <sources>...)
function(group_sources room library)
  string(REPLACE "/" "_" name ${room})
  set(number 0)
  foreach(source IN LISTS ARGN)
    math(EXPR batch "${number} / 20")
    set_source_files_properties(${source} TARGET_DIRECTORY ${library} PROPERTIES UNITY_GROUP ${name}_${batch})
    math(EXPR number "${number} + 1")
  endforeach()
endfunction()

# The first of several rooms is linked once there is a second one: alone, the library itself is the check.
function(add_order_check room library)
  get_target_property(rooms ${library} ROOMS)
  list(LENGTH rooms count)
  if(count EQUAL 1)
    return()
  endif()
  if(count EQUAL 2)
    list(GET rooms 0 first)
    link_rooms(${first} ${library} ${first})
  endif()
  link_rooms(${room} ${library} ${rooms})
endfunction()

# Links the objects of a room with those of the rooms before it in its library, and with nothing after it:
# link_rooms(<room> <library> <rooms up to it>...)
function(link_rooms room library)
  list(JOIN ARGN "|" alternatives)
  string(REPLACE "/" "_" batches "${alternatives}")
  string(REPLACE "/" "_" name ${room}_order)
  set(objects "/${library}\\.dir/((${alternatives})/|Unity/unity_(${batches})_[0-9]+_)")
  add_library(${name} MODULE $<FILTER:$<TARGET_OBJECTS:${library}>,INCLUDE,${objects}>)
  set_target_properties(${name} PROPERTIES
    LINKER_LANGUAGE CXX
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/order)
  target_link_libraries(${name} PRIVATE $<TARGET_PROPERTY:${library},LINK_LIBRARIES>)
  target_link_options(${name} PRIVATE -Wl,--no-undefined)
endfunction()

# Tests of a room, in one program: add_room_tests(<room> SOURCES files of test/<room>... LIBRARIES libraries...)
# Internal headers of the room are found by their name, shipped files by support/source_dir.hpp.
# NUMERIC: the tests of this filter run a second time, with the mathematics that the C library has for processors
# without fused multiply-add: last digits differ there. Trials by the hundred need not, nor what tells gross mistakes.
function(add_room_tests room)
  if(NOT CATKIN_ENABLE_TESTING)
    return()
  endif()
  cmake_parse_arguments(arg "" "NUMERIC" "SOURCES;LIBRARIES" ${ARGN})
  string(REPLACE "/" "_" name ${room}_tests)
  list(TRANSFORM arg_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/test/${room}/)
  add_executable(${name} EXCLUDE_FROM_ALL ${arg_SOURCES})
  use_project_options(${name})
  # A test runs for a moment, and takes longer to optimise: a quarter of the time of its compiler.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test)
  if(SOURCES_IN_BATCHES)
    # Of eight, those of one room took the compiler 1.7 gigabytes.
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
  endif()
  target_include_directories(${name} PRIVATE
    ${PROJECT_SOURCE_DIR}/test ${PROJECT_BINARY_DIR}/test/include ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} sac_test_support GTest::gtest_main)
  if(name STREQUAL base_tests)
    use_precompiled_headers(${name}
      <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath> <string> <vector> <gtest/gtest.h>)
  else()
    use_precompiled_headers(${name} base_tests)
  endif()
  add_dependencies(tests ${name})
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS unit)
  if(arg_NUMERIC)
    add_test(NAME ${name}.without_fma COMMAND ${name} --gtest_filter=${arg_NUMERIC})
    # The second three are their names before glibc 2.33; those that it does not know count as nothing.
    set_tests_properties(${name}.without_fma PROPERTIES
      LABELS unit
      TIMEOUT 600
      ENVIRONMENT
        GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX2_Usable,-FMA_Usable,-FMA4_Usable)
  endif()
endfunction()
