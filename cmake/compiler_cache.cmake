# Objects that another build of the same sources has made are taken from ccache, where it is installed: in another
# clone, on another branch. Folders below the package's count by their place in it; a precompiled header is one more
# header. See https://ccache.dev/manual/latest.html, "Precompiled headers".
# Into an empty cache it takes a fourteenth more time, so that it is for those who also build tests, unless
# -DCOMPILER_CACHE says ON or OFF.
set(use_compiler_cache ${CATKIN_ENABLE_TESTING})
if(DEFINED COMPILER_CACHE)
  set(use_compiler_cache ${COMPILER_CACHE})
endif()

find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if(use_compiler_cache AND CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()
