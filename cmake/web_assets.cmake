# Embeds the files of HTML reports (reports/web_assets.hpp) into a library.
option(ODOBENCH_CHARTS "Fetch the chart library of HTML reports with npm" ON)
set(NPM "")
if(ODOBENCH_CHARTS)
  find_program(ODOBENCH_NPM npm)
  if(ODOBENCH_NPM)
    set(NPM "${ODOBENCH_NPM}")
  else()
    message(STATUS "npm is not installed: HTML reports will have tables, but no charts")
  endif()
endif()

set(web "${CMAKE_SOURCE_DIR}/reports/web")
set(charts "${CMAKE_BINARY_DIR}/charts")
set(ODOBENCH_CHART_FILES "${charts}/vega.min.js" "${charts}/vega-lite.min.js" "${charts}/licences.txt")
# What an earlier build went without is tried again.
foreach(file IN LISTS ODOBENCH_CHART_FILES)
  if(NPM AND EXISTS "${file}")
    file(SIZE "${file}" size)
    if(size EQUAL 0)
      file(REMOVE "${file}")
    endif()
  endif()
endforeach()
add_custom_command(OUTPUT ${ODOBENCH_CHART_FILES}
  COMMAND "${CMAKE_COMMAND}" "-DNPM=${NPM}" "-DSOURCE=${web}" "-DOUTPUT=${charts}" -P "${CMAKE_SOURCE_DIR}/cmake/chart_library.cmake"
  DEPENDS "${web}/package.json" "${web}/package-lock.json" "${web}/bundled_licences.txt" "${CMAKE_SOURCE_DIR}/cmake/chart_library.cmake"
  COMMENT "Chart library of HTML reports" VERBATIM)

# The assembler copies the files into the object file: nothing to parse, whatever their size.
set(embedded page.css theme.js charts.js page.js render_svg.js)
list(TRANSFORM embedded PREPEND "${web}/")
set_source_files_properties(reports/web_assets.cpp PROPERTIES
  COMPILE_DEFINITIONS "ODOBENCH_WEB=\"${web}/\";ODOBENCH_CHART_FOLDER=\"${charts}/\""
  OBJECT_DEPENDS "${embedded};${ODOBENCH_CHART_FILES}" SKIP_PRECOMPILE_HEADERS ON)
