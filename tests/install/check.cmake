# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Installs BUILD_DIR below itself, then builds and runs the project in CONSUMER_DIR, which knows
# nothing but the place of that installation. Stops with an error at the first thing that fails.
set(prefix ${BUILD_DIR}/install-test/prefix)
set(consumer ${BUILD_DIR}/install-test/consumer)
file(REMOVE_RECURSE ${prefix} ${consumer})

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
run(${prefix}/bin/trussmap --version)
if(NOT output STREQUAL "trussmap ${VERSION}\n")
  message(FATAL_ERROR "the installed command says it is '${output}', not trussmap ${VERSION}")
endif()
file(GLOB_RECURSE licence ${prefix}/share/LICENSE)
if(NOT licence)
  message(FATAL_ERROR "the licence was not installed")
endif()

# Flags that a packager's environment gives are the packager's, and no leak of ours.
unset(ENV{CXXFLAGS})

# CLI11 serves the command alone: who uses the library must not need it.
run(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${consumer} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=Debug
    -D CMAKE_EXPORT_COMPILE_COMMANDS=ON -D CMAKE_DISABLE_FIND_PACKAGE_CLI11=ON)
run(${CMAKE_COMMAND} --build ${consumer})
run(${consumer}/consumer)
message(STATUS "${output}")

# Our own warnings and sanitizers stay at home, in the commands and in what was installed.
file(READ ${consumer}/compile_commands.json commands)
file(GLOB exported ${prefix}/lib*/cmake/trussmap/*.cmake ${prefix}/lib*/*/cmake/trussmap/*.cmake)
if(NOT exported)
  message(FATAL_ERROR "no CMake files were installed below ${prefix}")
endif()
foreach(file ${exported})
  file(READ ${file} text)
  string(APPEND commands "${text}")
endforeach()
string(REGEX MATCH " -W[a-z]|-fsanitize|-DNDEBUG|TRUSSMAP_[A-Z]+=|${CONSUMER_DIR}/../../include"
       leak "${commands}")
if(leak)
  message(FATAL_ERROR "'${leak}' leaks to those who use the library")
endif()
