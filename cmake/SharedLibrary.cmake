# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# One shared library, libtrussmap.so, of which others see what is declared in include/trussmap and
# nothing else: neither our rooms nor what is instantiated of Eigen or the standard library. Until
# 1.0 each minor version has a binary interface, and so a name, of its own.
#
# It is one, not five, since its parts use each other's rooms. trussmap::map and the like, by which a
# program links static libraries, are there as well: names for the one library.
add_library(trussmap SHARED)
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(trussmap_soversion 0.${PROJECT_VERSION_MINOR})
else()
  set(trussmap_soversion ${PROJECT_VERSION_MAJOR})
endif()
set_target_properties(trussmap PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${trussmap_soversion})
foreach(part IN LISTS trussmap_parts)
  add_library(trussmap_${part} OBJECT)
  target_link_libraries(trussmap PRIVATE $<BUILD_INTERFACE:trussmap_${part}>)
  add_library(trussmap_${part}_name INTERFACE)
  target_link_libraries(trussmap_${part}_name INTERFACE trussmap)
  set_target_properties(trussmap_${part}_name PROPERTIES EXPORT_NAME ${part})
  add_library(trussmap::${part} ALIAS trussmap_${part}_name)
endforeach()

# By a header that comes before all others: what is first declared in it is visible, all the rest is
# hidden. The public headers need no word for it in front of each class and call.
function(trussmap_export_public_names)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/trussmap/*.hpp)
  set(others "")
  set(ours "")
  foreach(header IN LISTS headers)
    file(STRINGS ${header} lines REGEX "^#include <")
    list(TRANSFORM lines REPLACE ">.*" ">")
    list(APPEND others ${lines})
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR}/include ${header})
    list(APPEND ours "#include \"${name}\"")
  endforeach()
  list(REMOVE_DUPLICATES others)
  list(SORT others)
  list(JOIN others "\n" others)
  list(JOIN ours "\n" ours)
  # With what they include: a public class of a hidden Eigen matrix would be hidden for its sake.
  set(visible ${PROJECT_BINARY_DIR}/public_names.hpp)
  file(CONFIGURE OUTPUT ${visible} @ONLY CONTENT
       "#pragma once\n#pragma GCC visibility push(default)\n@others@\n@ours@\n#pragma GCC visibility pop\n")

  # What the compiler leaves visible and is not ours: weak copies of other libraries' templates.
  set(script ${PROJECT_BINARY_DIR}/exports.map)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/exports.map.in ${script} @ONLY)
  target_link_options(trussmap PRIVATE "LINKER:--version-script=${script}" LINKER:-z,defs)
  set_target_properties(trussmap PROPERTIES LINK_DEPENDS ${script})

  foreach(library IN LISTS ARGN)
    set_target_properties(${library} PROPERTIES POSITION_INDEPENDENT_CODE ON
                          CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    # Our calls of our own names stay ours, and may be inlined, as in a static library.
    target_compile_options(${library} PRIVATE -fno-semantic-interposition)
    if(TRUSSMAP_PRECOMPILE_HEADERS)
      target_precompile_headers(${library} PRIVATE ${visible})
    else()
      target_compile_options(${library} PRIVATE "SHELL:-include ${visible}")
    endif()
  endforeach()
endfunction()
