# Debian packages by `cpack`: limcycle (the program), liblimcycle-dev and, with the Python module, python3-limcycle.
# tools/package makes and checks them.
set(LIMCYCLE_MAINTAINER "limcycle maintainers <maintainers@limcycle.invalid>" CACHE STRING
  "Whom the Debian packages name: NAME <ADDRESS>")
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # cpack takes what is built; it does not build the tests
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME limcycle)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_CONTACT "${LIMCYCLE_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL development)
if(LIMCYCLE_PROGRAM)
  list(APPEND CPACK_COMPONENTS_ALL program)
endif()
if(LIMCYCLE_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python_debian)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME limcycle)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "librsvg2-bin, octave")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
"limit cycles of feedback loops with friction
Tells from one small text file whether a feedback loop with friction, a relay,
a dead zone, backlash, a saturation or a dead time will oscillate: which limit
cycles the describing function, the composite describing function and
harmonic balance predict, which there really are, and what each prediction
was worth. Follows cycles over a parameter, maps planes of two, and tells how
far every parameter is from where hunting begins or ends.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblimcycle-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libgsl-dev (>= 2.7), libtbb-dev (>= 2021), \
libfftw3-dev, libfmt-dev (>= 9), libtomlplusplus-dev, libmuparser-dev, libmatio-dev, libssl-dev, libsqlite3-dev, libhdf5-dev, pkgconf | pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
"C++ library for limit cycles of feedback loops with friction
The methods of the program limcycle as a library: describing functions,
harmonic balance, exact cycles by shooting, Floquet multipliers, simulation
with located events, continuation and sensitivity, for the friction laws of
the program and for friction laws of your own.

Headers and static libraries, with files for CMake and pkg-config.")
if(LIMCYCLE_PYTHON)
  math(EXPR python_next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_NAME python3-limcycle)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~), \
python3 (<< ${Python_VERSION_MAJOR}.${python_next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_RECOMMENDS python3-matplotlib)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_DESCRIPTION
"Python module for limit cycles of feedback loops with friction
Asks the questions of the program limcycle from Python: predictions with
verdicts, describing functions, simulation, continuation, margins, maps,
sensitivity, dissipativity, remedies and identification. Loops are made of
dictionaries, case files, or systems of python-control and SciPy; results have
arrays of NumPy and figures of Matplotlib, and a friction law can be written
in Python.")
endif()
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/policy.cmake)
include(CPack)
