# Script: fetches the chart library into OUTPUT as vega.min.js, vega-lite.min.js and licences.txt, with npm, whose lock file
# holds the check sums. Without npm or network the three files are empty, and a line says so: charts are an extra.
#   cmake -DNPM=.. -DSOURCE=reports/web -DOUTPUT=.. -P chart_library.cmake
set(files vega.min.js vega-lite.min.js licences.txt)

function(leave_out why)
  foreach(file IN LISTS files)
    file(WRITE "${OUTPUT}/${file}" "")
  endforeach()
  message("Charts are left out of HTML reports: ${why}")
  return()
endfunction()

if(NOT NPM)
  leave_out("npm is not installed, or ODOBENCH_CHARTS is OFF")
  return()
endif()
set(work "${OUTPUT}/npm")
file(REMOVE_RECURSE "${work}")
file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" DESTINATION "${work}")
execute_process(COMMAND "${NPM}" ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 --fetch-timeout=60000
  WORKING_DIRECTORY "${work}" RESULT_VARIABLE status OUTPUT_FILE "${OUTPUT}/npm.log" ERROR_FILE "${OUTPUT}/npm.err" TIMEOUT 300)
set(vega "${work}/node_modules/vega")
set(vega_lite "${work}/node_modules/vega-lite")
if(NOT status EQUAL 0 OR NOT EXISTS "${vega}/build/vega.min.js" OR NOT EXISTS "${vega_lite}/build/vega-lite.min.js")
  leave_out("npm could not fetch vega and vega-lite (see ${OUTPUT}/npm.err); configuring again tries again")
  return()
endif()

file(READ "${vega}/LICENSE" vega_licence)
file(READ "${vega_lite}/LICENSE" vega_lite_licence)
file(READ "${SOURCE}/bundled_licences.txt" bundled_licences)
file(WRITE "${OUTPUT}/licences.txt" "Vega\n\n${vega_licence}\n--------------------\nVega-Lite\n\n${vega_lite_licence}\n"
  "--------------------\n${bundled_licences}")
file(COPY_FILE "${vega}/build/vega.min.js" "${OUTPUT}/vega.min.js")
file(COPY_FILE "${vega_lite}/build/vega-lite.min.js" "${OUTPUT}/vega-lite.min.js")
file(REMOVE_RECURSE "${work}")
