# Checks: lint, format, static analysis. Registered with ctest by the option ENABLE_CHECKS.

if(NOT (CATKIN_ENABLE_TESTING AND ENABLE_CHECKS))
  return()
endif()

# Whether a tool has the version of Debian 12, which the sources are held to: others find other things.
function(has_version result tool version)
  execute_process(COMMAND ${tool} --version OUTPUT_VARIABLE text RESULT_VARIABLE status ERROR_VARIABLE ignored)
  string(REGEX MATCH "[0-9]+(\\.[0-9]+)+" found "${text}")
  string(FIND "${found}." "${version}." place)
  if(place EQUAL 0)
    set(${result} TRUE PARENT_SCOPE)
  else()
    set(${result} FALSE PARENT_SCOPE)
  endif()
endfunction()

# One check: dev/check_<name>, from the source folder: add_check(<name> [arguments...] [TOOL <program> <version>])
function(add_check name)
  cmake_parse_arguments(arg "" "" "TOOL" ${ARGN})
  if(arg_TOOL)
    list(JOIN arg_TOOL " " wanted)
    has_version(is_here ${arg_TOOL})
    if(NOT is_here)
      message(NOTICE "check.${name} is left out: it needs ${wanted}, as Debian 12 has it.")
      return()
    endif()
  endif()
  add_test(NAME check.${name}
    COMMAND ${PROJECT_SOURCE_DIR}/dev/check_${name} ${arg_UNPARSED_ARGUMENTS}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(check.${name} PROPERTIES LABELS check)
endfunction()

add_check(catkin TOOL catkin_lint 1.6.22)
add_check(changelog)
add_check(clang_tidy ${PROJECT_BINARY_DIR} TOOL clang-tidy 14)
add_check(cppcheck ${PROJECT_BINARY_DIR} TOOL cppcheck 2.10)
add_check(format TOOL clang-format 14)
add_check(guide)
add_check(launch)
add_check(messages)
add_check(rooms)
add_check(shell TOOL shellcheck 0.9)
add_check(xml)
# It takes minutes after a large change, on every processor: after the tests of running nodes, which need them at
# their rates, and before all that is short.
if(TEST check.clang_tidy)
  set_tests_properties(check.clang_tidy PROPERTIES COST 4 TIMEOUT 3600)
endif()

# That a check fails when it must: test/dev/check_<name>_test.py.
function(add_check_test name)
  if(NOT TEST check.${name})
    return()
  endif()
  add_test(NAME check.${name}_test
    COMMAND ${PYTHON_EXECUTABLE} ${PROJECT_SOURCE_DIR}/test/dev/check_${name}_test.py)
  set_tests_properties(check.${name}_test PROPERTIES LABELS check)
endfunction()

add_check_test(clang_tidy)
add_check_test(guide)
add_check_test(rooms)
