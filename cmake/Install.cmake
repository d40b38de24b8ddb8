# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# Four sets of targets, five with MPI, so that find_package(trussmap COMPONENTS map) needs only what maps need.
include(CMakePackageConfigHelpers)

set(TRUSSMAP_ZSH_FOLDER site-functions CACHE STRING "Where zsh looks for completions, below share/zsh")
mark_as_advanced(TRUSSMAP_ZSH_FOLDER)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/trussmap)
install(TARGETS trussmap_map EXPORT trussmapMapTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS trussmap_store EXPORT trussmapStoreTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS trussmap_logs EXPORT trussmapLogsTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TRUSSMAP_WITH_MPI)
  install(TARGETS trussmap_distributed EXPORT trussmapDistributedTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT trussmapDistributedTargets NAMESPACE trussmap:: DESTINATION ${config_dir})
  install(FILES cmake/FindPetsc.cmake DESTINATION ${config_dir})
endif()
install(TARGETS trussmap EXPORT trussmapTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/trussmap DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT trussmapMapTargets NAMESPACE trussmap:: DESTINATION ${config_dir})
install(EXPORT trussmapStoreTargets NAMESPACE trussmap:: DESTINATION ${config_dir})
install(EXPORT trussmapLogsTargets NAMESPACE trussmap:: DESTINATION ${config_dir})
install(EXPORT trussmapTargets NAMESPACE trussmap:: DESTINATION ${config_dir})
configure_package_config_file(cmake/trussmapConfig.cmake.in
                              ${CMAKE_CURRENT_BINARY_DIR}/trussmapConfig.cmake
                              INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/trussmapConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/trussmapConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/trussmapConfigVersion.cmake
              cmake/FindCholmod.cmake
        cmake/FindLz4.cmake
        DESTINATION ${config_dir})
configure_file(cmake/trussmap.pc.in ${CMAKE_CURRENT_BINARY_DIR}/trussmap.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/trussmap.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(TARGET trussmap_command)
  install(TARGETS trussmap_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  # The command says itself what man and shells take.
  if(NOT CMAKE_CROSSCOMPILING)
    install(CODE "
      set(top \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
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
