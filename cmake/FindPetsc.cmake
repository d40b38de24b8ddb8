# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# PETSc with real numbers in double precision, as its pkg-config file has it: Petsc::Petsc.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(Petsc_PC QUIET IMPORTED_TARGET GLOBAL PETSc>=3.18)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Petsc
  REQUIRED_VARS Petsc_PC_LINK_LIBRARIES
  VERSION_VAR Petsc_PC_VERSION
  REASON_FAILURE_MESSAGE "it needs PETSc 3.18 or later and pkg-config: apt-get install petsc-dev pkg-config")
if(Petsc_FOUND AND NOT TARGET Petsc::Petsc)
  add_library(Petsc::Petsc ALIAS PkgConfig::Petsc_PC)
endif()
