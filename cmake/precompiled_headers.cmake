# Headers that are parsed once for all sources of a target, and of those that share them.
option(PRECOMPILED_HEADERS "Parse the headers of Eigen, ROS and GoogleTest once, which halves the build" ON)

# The headers that a target precompiles, or shares: use_precompiled_headers(<target> <other target> | <headers...>)
function(use_precompiled_headers target)
  if(NOT PRECOMPILED_HEADERS)
    return()
  endif()
  if(TARGET "${ARGV1}")
    target_precompile_headers(${target} REUSE_FROM ${ARGV1})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# A program that shares the headers of a library: they are valid for the code of libraries alone, which programs may be
# made of, too.
function(use_headers_of_library program library)
  if(NOT PRECOMPILED_HEADERS)
    return()
  endif()
  set_target_properties(${program} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(${program} PRIVATE -fPIC)
  use_precompiled_headers(${program} ${library})
endfunction()
