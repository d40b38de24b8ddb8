# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# TRUSSMAP_UNITY compiles a dozen sources as one: a first build takes half of the time, each later one
# more. `make` turns it on in a new tree. Sources that have private names in common with others of the
# same dozen are compiled alone: trussmap_alone(SOURCE...).
option(TRUSSMAP_UNITY "Compile a dozen sources as one" OFF)

function(trussmap_unity target)
  if(TRUSSMAP_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  endif()
endfunction()

function(trussmap_alone)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  set_source_files_properties(${ARGN} DIRECTORY ${PROJECT_SOURCE_DIR}
                              PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
