# Objects that another build of the same sources has made are taken from ccache, where it is installed: in another
# clone, on another branch. Folders below the package's count by their place in it; a precompiled header is one more
# header. See https://ccache.dev/manual/latest.html, "Precompiled headers".
option(COMPILER_CACHE "Compile through ccache where it is installed" ON)

find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if(COMPILER_CACHE AND CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()
