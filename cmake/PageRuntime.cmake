# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
#
# The script that draws the charts of a page: src/report/page together with Vega, bundled and
# minified by esbuild. Both come from the system (Debian: esbuild, libjs-vega).
#
# trussmap_page_script(VARIABLE NAME) sets VARIABLE to the path of the script that begins with
# NAME.js, and makes a rule for it.
find_program(ESBUILD esbuild)
find_path(VEGA_DIR vega-view.min.js
          PATHS /usr/share/javascript/vega /usr/share/nodejs/vega /usr/local/share/javascript/vega)
if(NOT ESBUILD OR NOT VEGA_DIR)
  message(FATAL_ERROR
    "The command's pages need esbuild and Vega's modules: apt-get install esbuild libjs-vega "
    "(or set ESBUILD and VEGA_DIR). The library alone needs neither: -D TRUSSMAP_BUILD_APPS=OFF.")
endif()

function(trussmap_page_script variable name)
  set(source ${PROJECT_SOURCE_DIR}/src/report/page)
  file(GLOB scripts CONFIGURE_DEPENDS ${source}/*.js)
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${name}.min.js)
  foreach(module canvas dataflow encode event-selector expression format functions interpreter
                 loader parser runtime scale scenegraph statistics time transforms util view view-transforms)
    list(APPEND aliases --alias:vega-${module}=${VEGA_DIR}/vega-${module}.min.js)
  endforeach()
  # One module is required by another name than its file's.
  list(APPEND aliases --alias:vega-selections=${VEGA_DIR}/vega-selection.min.js)
  add_custom_command(
    OUTPUT ${script}
    COMMAND ${ESBUILD} ${source}/${name}.js --bundle --minify --format=iife --target=es2021
            --charset=ascii --legal-comments=inline --log-level=warning ${aliases}
            --outfile=${script}
    DEPENDS ${scripts}
    COMMENT "Bundling ${name}.js for the pages"
    VERBATIM)
  set(${variable} ${script} PARENT_SCOPE)
endfunction()
