if(LIMCYCLE_SANITIZE)
  message(FATAL_ERROR "LIMCYCLE_PYTHON: an interpreter that is not watched cannot load a watched module")
endif()
# The Python module: the package python/limcycle and its extension, in python/ of the build folder.
# Among several interpreters the first that has NumPy, which the arrays of results need, unless the user names one.
if(NOT Python_EXECUTABLE)
  find_program(python_of_path NAMES python3 NO_CACHE)
  foreach(candidate "${python_of_path}" /usr/bin/python3)
    execute_process(COMMAND ${candidate} -c "import numpy" RESULT_VARIABLE lacks_numpy OUTPUT_QUIET ERROR_QUIET)
    if(NOT Python_EXECUTABLE AND lacks_numpy EQUAL 0)
      set(Python_EXECUTABLE ${candidate} CACHE FILEPATH "The interpreter that the module is for" FORCE)
    endif()
  endforeach()
endif()
set(PYBIND11_FINDPYTHON ON)
find_package(Python 3.9 REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 2.10 REQUIRED CONFIG)
file(GLOB_RECURSE python_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/core/*.cpp)
pybind11_add_module(limcycle_python MODULE NO_EXTRAS ${python_sources})
target_link_libraries(limcycle_python PRIVATE limcycle_options limcycle_questions fmt::fmt)
limcycle_text(limcycle_python)
set(python_package ${PROJECT_BINARY_DIR}/python/limcycle)
set_target_properties(limcycle_python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${python_package})
# Names of the libraries inside are not for others who load them too.
target_link_options(limcycle_python PRIVATE -Wl,--exclude-libs,ALL)

file(GLOB python_files RELATIVE ${PROJECT_SOURCE_DIR}/python/limcycle CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/python/limcycle/*.py ${PROJECT_SOURCE_DIR}/python/limcycle/*.pyi
  ${PROJECT_SOURCE_DIR}/python/limcycle/py.typed)
foreach(file ${python_files})
  add_custom_command(OUTPUT ${python_package}/${file} DEPENDS ${PROJECT_SOURCE_DIR}/python/limcycle/${file}
    COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/python/limcycle/${file} ${python_package}/${file} VERBATIM)
  list(APPEND python_copies ${python_package}/${file})
endforeach()
add_custom_target(limcycle_python_package ALL DEPENDS ${python_copies} COMMENT "The Python package")
add_dependencies(limcycle_python limcycle_python_package)

# Components that are installed when they are asked for, each into the folder of its place under the prefix:
# a virtual environment (cmake --install build/release --component python --prefix "$VIRTUAL_ENV"), a wheel (pyproject.toml),
# the Python of Debian (the package python3-limcycle).
function(limcycle_install_python component folder)
  install(TARGETS limcycle_python LIBRARY DESTINATION ${folder}/limcycle COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(DIRECTORY python/limcycle DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL
    FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
endfunction()
if(LIMCYCLE_INSTALL)
  limcycle_install_python(python lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/site-packages)
  limcycle_install_python(wheel .)
  limcycle_install_python(python_debian lib/python3/dist-packages)
endif()
