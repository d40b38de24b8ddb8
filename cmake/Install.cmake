# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Five sets of static targets, six with MPI, so that find_package(trussmap COMPONENTS map) needs only what maps need.
include(CMakePackageConfigHelpers)

set(TRUSSMAP_ZSH_FOLDER site-functions CACHE STRING "Where zsh looks for completions, below share/zsh")
mark_as_advanced(TRUSSMAP_ZSH_FOLDER)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/trussmap)
if(BUILD_SHARED_LIBS)
  # One library, one set.
  list(TRANSFORM trussmap_parts REPLACE "(.+)" "trussmap_\\1_name" OUTPUT_VARIABLE names)
  install(TARGETS trussmap ${names} EXPORT trussmapTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
else()
  install(TARGETS trussmap EXPORT trussmapTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  foreach(part IN LISTS trussmap_parts)
    string(SUBSTRING ${part} 0 1 first)
    string(SUBSTRING ${part} 1 -1 set)
    string(TOUPPER ${first} first)
    string(PREPEND set ${first})
    install(TARGETS trussmap_${part} EXPORT trussmap${set}Targets
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(EXPORT trussmap${set}Targets NAMESPACE trussmap:: DESTINATION ${config_dir})
  endforeach()
  if(TRUSSMAP_WITH_MPI)
    install(FILES cmake/FindPetsc.cmake DESTINATION ${config_dir})
  endif()
endif()
install(EXPORT trussmapTargets NAMESPACE trussmap:: DESTINATION ${config_dir})
install(DIRECTORY include/trussmap DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(BUILD_SHARED_LIBS)
  set(config cmake/trussmapSharedConfig.cmake.in)
else()
  set(config cmake/trussmapConfig.cmake.in)
endif()
configure_package_config_file(${config} ${CMAKE_CURRENT_BINARY_DIR}/trussmapConfig.cmake
                              INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/trussmapConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/trussmapConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/trussmapConfigVersion.cmake
        DESTINATION ${config_dir})
if(BUILD_SHARED_LIBS)  # brings what it needs
  set(requires eigen3)
  set(libs "-ltrussmap")
  set(map_requires eigen3)
  set(map_libs "-ltrussmap")
else()  # their users link what they need
  install(FILES cmake/FindCholmod.cmake cmake/FindLz4.cmake DESTINATION ${config_dir})
  set(requires
      "eigen3 lapack blas fmt muparser liblzma expat tomlplusplus sqlite3 liblz4 libzstd zlib yaml-cpp")
  set(libs "-ltrussmap_datasets -ltrussmap_logs -ltrussmap_store -ltrussmap -ltrussmap_map -lcholmod -lbz2 -pthread")
  set(map_requires "eigen3 lapack blas")
  set(map_libs "-ltrussmap_map -lcholmod -pthread")
endif()
# All of it, and maps alone. Wherever an installation is taken to, its files find it.
file(RELATIVE_PATH up "/prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/prefix")
function(trussmap_pkgconfig name pkgconfig_requires pkgconfig_libs)
  configure_file(cmake/trussmap.pc.in ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
trussmap_pkgconfig(trussmap "${requires}" "${libs}")
trussmap_pkgconfig(trussmap-map "${map_requires}" "${map_libs}")
if(TARGET trussmap_command)
  install(TARGETS trussmap_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  # The command says itself what man, shells and readers of its JSON take.
  if(NOT CMAKE_CROSSCOMPILING)
    install(CODE "
      set(top \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
      file(MAKE_DIRECTORY \"\${top}/${CMAKE_INSTALL_DATADIR}/trussmap\")
      execute_process(COMMAND $<TARGET_FILE:trussmap_command> schema
                      OUTPUT_FILE \"\${top}/${CMAKE_INSTALL_DATADIR}/trussmap/trussmap.schema.json\" COMMAND_ERROR_IS_FATAL ANY)
      execute_process(COMMAND $<TARGET_FILE:trussmap_command> manual --out \"\${top}/${CMAKE_INSTALL_MANDIR}/man1\"
                      OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
      foreach(to bash:bash-completion/completions/trussmap zsh:zsh/${TRUSSMAP_ZSH_FOLDER}/_trussmap
                 fish:fish/vendor_completions.d/trussmap.fish)
        string(REPLACE \":\" \";\" to \${to})
        list(GET to 0 shell)
        list(GET to 1 file)
        execute_process(COMMAND $<TARGET_FILE:trussmap_command> completion \${shell} OUTPUT_VARIABLE text
                        COMMAND_ERROR_IS_FATAL ANY)
        file(WRITE \"\${top}/${CMAKE_INSTALL_DATADIR}/\${file}\" \"\${text}\")
      endforeach()")
  endif()
endif()
