# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# TRUSSMAP_UNITY compiles up to TRUSSMAP_UNITY_SIZE sources of a folder as one: most of the time goes
# into templates that they have in common. A first build takes less than half of the time, each later
# one more. `make` turns it on in a new tree. A private name is the only one of its folder, therefore; what
# cannot be has the property SKIP_UNITY_BUILD_INCLUSION.
option(TRUSSMAP_UNITY "Compile the sources of a folder as one" OFF)
set(TRUSSMAP_UNITY_SIZE 30 CACHE STRING "How many sources are compiled as one at most")

# Once the target has its sources.
function(trussmap_unity target)
  if(NOT TRUSSMAP_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "[.]cpp$")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    cmake_path(GET folder PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${folder}" group)
    list(APPEND groups ${group})
    list(APPEND of_${group} ${source})
  endforeach()
  list(REMOVE_DUPLICATES groups)
  foreach(group IN LISTS groups)
    # Parts of the same size.
    list(LENGTH of_${group} count)
    math(EXPR parts "(${count} + ${TRUSSMAP_UNITY_SIZE} - 1) / ${TRUSSMAP_UNITY_SIZE}")
    set(place 0)
    foreach(source IN LISTS of_${group})
      math(EXPR part "${place} * ${parts} / ${count}")
      math(EXPR place "${place} + 1")
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${group}_${part})
    endforeach()
  endforeach()
endfunction()
