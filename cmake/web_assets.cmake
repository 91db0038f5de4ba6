# Embeds the files of HTML reports (reports/page/web_assets.hpp) into a library.
set(ODOBENCH_CHARTS AUTO CACHE STRING "Charts of HTML reports, fetched with npm: AUTO where possible, ON or fail, OFF")
set_property(CACHE ODOBENCH_CHARTS PROPERTY STRINGS AUTO ON OFF)
if(NOT ODOBENCH_CHARTS MATCHES "^(AUTO|ON|OFF)$")
  message(FATAL_ERROR "ODOBENCH_CHARTS=${ODOBENCH_CHARTS}: expected AUTO, ON or OFF")
endif()
set(NPM "")
if(NOT ODOBENCH_CHARTS STREQUAL "OFF")
  find_program(ODOBENCH_NPM npm)
  if(ODOBENCH_NPM)
    set(NPM "${ODOBENCH_NPM}")
  elseif(ODOBENCH_CHARTS STREQUAL "ON")
    message(FATAL_ERROR "ODOBENCH_CHARTS=ON, but npm is not installed")
  endif()
endif()

set(web "${CMAKE_SOURCE_DIR}/reports/web")
set(charts "${CMAKE_BINARY_DIR}/charts")
set(ODOBENCH_CHART_FILES "${charts}/vega.min.js" "${charts}/vega-lite.min.js" "${charts}/licences.txt" "${charts}/missing.txt")
# What an earlier build went without is tried again.
if(NPM AND EXISTS "${charts}/missing.txt")
  file(SIZE "${charts}/missing.txt" size)
  if(size GREATER 0)
    file(REMOVE ${ODOBENCH_CHART_FILES})
  endif()
endif()
add_custom_command(OUTPUT ${ODOBENCH_CHART_FILES}
  COMMAND "${CMAKE_COMMAND}" "-DNPM=${NPM}" "-DWANTED=${ODOBENCH_CHARTS}" "-DSOURCE=${web}" "-DOUTPUT=${charts}" -P "${CMAKE_SOURCE_DIR}/cmake/chart_library.cmake"
  DEPENDS "${web}/package.json" "${web}/package-lock.json" "${web}/bundled_licences.txt" "${CMAKE_SOURCE_DIR}/cmake/chart_library.cmake"
  COMMENT "Chart library of HTML reports" VERBATIM)

# The assembler copies the files into the object file: nothing to parse, whatever their size.
set(embedded page.css theme.js charts.js page.js render_svg.js)
list(TRANSFORM embedded PREPEND "${web}/")
set_source_files_properties(reports/page/web_assets.cpp PROPERTIES
  COMPILE_DEFINITIONS "ODOBENCH_WEB=\"${web}/\";ODOBENCH_CHART_FOLDER=\"${charts}/\""
  OBJECT_DEPENDS "${embedded};${ODOBENCH_CHART_FILES}" SKIP_PRECOMPILE_HEADERS ON)

# The last words of a build without charts say why.
function(odobench_charts_notice)
  add_custom_target(charts_notice ALL COMMAND "${CMAKE_COMMAND}" "-DMISSING=${CMAKE_BINARY_DIR}/charts/missing.txt" -P
    "${CMAKE_SOURCE_DIR}/cmake/charts_notice.cmake" VERBATIM)
  add_dependencies(charts_notice ${ARGN})
endfunction()
