# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# After check.cmake: builds and runs the project in CONSUMER_DIR/map against the installation, by
# the component map alone and as if what reads files and models were nowhere to be found; and in
# the same way the one in CONSUMER_DIR/store by the component store. Stops with an error at the first
# thing that fails.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
set(prefix ${BUILD_DIR}/install-test/prefix)
set(explorer ${BUILD_DIR}/install-test/explorer)
file(REMOVE_RECURSE ${explorer})

# Writes the example of a page to a file; what the page shows as its output, the pattern's second
# group, is ${shown} then.
function(write_example page pattern file)
  file(READ ${CONSUMER_DIR}/../../${page} text)
  string(REGEX MATCH "${pattern}" found "${text}")
  if(NOT found)
    message(FATAL_ERROR "${page} has no such example in C++: ${pattern}")
  endif()
  file(WRITE ${file} "${CMAKE_MATCH_1}")
  set(shown "${CMAKE_MATCH_2}" PARENT_SCOPE)
endfunction()
write_example(docs/exploration.md "```cpp\n([^`]*)```" ${explorer}/exploration.cpp)
write_example(README.md "```cpp\n([^`]*)```\n\n```text\n([^`]*)```" ${explorer}/readme.cpp)
set(readme_output "${shown}")

foreach(package fmt muparser LibLZMA EXPAT tomlplusplus nlohmann_json CLI11 Boost)
  list(APPEND absent -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()

# The one which keeps its map: run twice, the file is gone on with.
set(keeper ${BUILD_DIR}/install-test/keeper)
file(REMOVE_RECURSE ${keeper})
write_example(docs/methods.md "```cpp\n(#include <trussmap/map_store.hpp>[^`]*)```" ${keeper}/readme.cpp)
run(${CMAKE_COMMAND} -S ${CONSUMER_DIR}/store -B ${keeper} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=Debug
    -D README_EXAMPLE=${keeper}/readme.cpp ${absent})
run(${CMAKE_COMMAND} --build ${keeper})
foreach(calls 3 6)
  run(${CMAKE_COMMAND} -E chdir ${keeper} ./keeper)
  if(NOT output STREQUAL "2 landmarks, ${calls} calls kept\n")
    message(FATAL_ERROR "the example of a map store says:\n${output}")
  endif()
endforeach()

# Maps need no database either.
list(APPEND absent -D CMAKE_DISABLE_FIND_PACKAGE_SQLite3=ON)
run(${CMAKE_COMMAND} -S ${CONSUMER_DIR}/map -B ${explorer} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=Debug
    -D README_EXAMPLE=${explorer}/readme.cpp -D EXPLORATION_EXAMPLE=${explorer}/exploration.cpp ${absent})
run(${CMAKE_COMMAND} --build ${explorer})
foreach(program readme exploration explorer)
  run(${explorer}/${program})
  message(STATUS "${output}")
  if(program MATCHES "^readme$" AND NOT output STREQUAL readme_output)
    message(FATAL_ERROR "README.md shows another output of its example:\n${readme_output}")
  endif()
  run(readelf -d ${explorer}/${program})
  string(REGEX MATCH "NEEDED[^\n]*(sqlite|expat|lzma|muparser|fmt|toml|json)[^\n]*" needed "${output}")
  if(needed)
    message(FATAL_ERROR "${program} needs more than maps do: ${needed}")
  endif()
  if(NOT output MATCHES "NEEDED[^\n]*libc\\.")
    message(FATAL_ERROR "readelf says nothing of ${program}:\n${output}")
  endif()
endforeach()

# Without CMake.
find_program(pkg_config pkg-config)
if(pkg_config)
  file(GLOB folder ${prefix}/lib/pkgconfig ${prefix}/lib/*/pkgconfig)
  run(${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${folder} ${pkg_config} --cflags --libs trussmap-map)
  string(STRIP "${output}" flags)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run(${CXX_COMPILER} ${explorer}/readme.cpp ${flags} -o ${explorer}/by_pkg_config)
  run(${explorer}/by_pkg_config)
endif()
