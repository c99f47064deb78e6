# Checks: lint, format, static analysis. Registered with ctest by the option ENABLE_CHECKS.

if(NOT (CATKIN_ENABLE_TESTING AND ENABLE_CHECKS))
  return()
endif()

# One check: dev/check_<name>, from the source folder.
function(add_check name)
  add_test(NAME check.${name}
    COMMAND ${PROJECT_SOURCE_DIR}/dev/check_${name} ${ARGN}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(check.${name} PROPERTIES LABELS check)
endfunction()

add_check(catkin)
add_check(changelog)
add_check(clang_tidy ${PROJECT_BINARY_DIR})
add_check(cppcheck ${PROJECT_BINARY_DIR})
add_check(format)
add_check(guide)
add_check(launch)
add_check(messages)
add_check(rooms)
add_check(shell)
add_check(xml)
# It takes minutes after a large change: it starts first, on every processor, and is nice to the rest.
set_tests_properties(check.clang_tidy PROPERTIES COST 10 TIMEOUT 3600)

# That a check fails when it must: test/dev/check_<name>_test.py.
function(add_check_test name)
  add_test(NAME check.${name}_test
    COMMAND ${PYTHON_EXECUTABLE} ${PROJECT_SOURCE_DIR}/test/dev/check_${name}_test.py)
  set_tests_properties(check.${name}_test PROPERTIES LABELS check)
endfunction()

add_check_test(clang_tidy)
add_check_test(guide)
add_check_test(rooms)
