# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# trussmap_precompile(TARGET HEADER...) precompiles headers of libraries for a target, which takes
# most of a build's time away. Every source still includes what it uses; a build with
# TRUSSMAP_PRECOMPILE_HEADERS=OFF shows where one does not.
option(TRUSSMAP_PRECOMPILE_HEADERS "Precompile the headers of libraries" ON)

set(TRUSSMAP_STANDARD_HEADERS
  <algorithm> <array> <cmath> <cstddef> <cstdint> <filesystem> <functional> <limits> <map> <memory>
  <numbers> <numeric> <optional> <random> <set> <sstream> <stdexcept> <string> <string_view> <utility>
  <vector>)

function(trussmap_precompile target)
  if(TRUSSMAP_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} PRIVATE ${TRUSSMAP_STANDARD_HEADERS} ${ARGN})
  endif()
endfunction()
