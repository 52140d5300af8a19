# The page's figures are drawn by Plotly, which reports/figures/drawing/plotly.cpp carries inside the library.
set(plotly_file ${PROJECT_SOURCE_DIR}/node_modules/plotly.js-cartesian-dist-min/plotly-cartesian.min.js)
if(NOT EXISTS ${plotly_file})
  message(FATAL_ERROR "${plotly_file} is missing: the reports of limcycle cannot be built without it, since their pages "
    "draw with it. Run ${PROJECT_SOURCE_DIR}/tools/assets (it calls `npm ci` with the versions of package-lock.json), "
    "then configure again; or, for the models, the methods and the case files without any report, configure with "
    "-DLIMCYCLE_REPORTS=OFF -DLIMCYCLE_PROGRAM=OFF -DLIMCYCLE_TESTS=OFF.")
endif()
set_source_files_properties(reports/figures/drawing/plotly.cpp PROPERTIES
  COMPILE_DEFINITIONS "LIMCYCLE_PLOTLY_FILE=\"${plotly_file}\"" OBJECT_DEPENDS ${plotly_file})
