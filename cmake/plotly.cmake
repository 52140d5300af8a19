# The page's figures are drawn by Plotly, which reports/plotly.cpp carries inside the library.
set(plotly_file ${CMAKE_SOURCE_DIR}/node_modules/plotly.js-cartesian-dist-min/plotly-cartesian.min.js)
if(NOT EXISTS ${plotly_file})
  message(FATAL_ERROR "${plotly_file} is missing: the HTML report cannot be built without it. Run tools/assets "
    "(it calls `npm ci` with the versions of package-lock.json), then configure again.")
endif()
set_source_files_properties(reports/plotly.cpp PROPERTIES
  COMPILE_DEFINITIONS "LIMCYCLE_PLOTLY_FILE=\"${plotly_file}\"" OBJECT_DEPENDS ${plotly_file})
