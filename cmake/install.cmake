# What `cmake --install` puts under the prefix. Two components: `program` (the program, its manual, completions, cases
# and documents) and `development` (headers, static libraries, files for find_package and pkg-config).
include(CMakePackageConfigHelpers)
set(parts models analysis cases)
if(LIMCYCLE_REPORTS)
  list(APPEND parts reports)
endif()

list(TRANSFORM parts PREPEND limcycle_ OUTPUT_VARIABLE libraries)
install(TARGETS ${libraries} limcycle_library EXPORT limcycle ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  COMPONENT development INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/limcycle)
install(EXPORT limcycle FILE limcycleTargets.cmake NAMESPACE limcycle:: DESTINATION ${config_folder}
  COMPONENT development)
configure_package_config_file(cmake/limcycleConfig.cmake.in ${PROJECT_BINARY_DIR}/package/limcycleConfig.cmake
  INSTALL_DESTINATION ${config_folder})
# Before 1.0.0 a minor version may break what was; then a major one.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/limcycleConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/limcycleConfig.cmake
  ${PROJECT_BINARY_DIR}/package/limcycleConfigVersion.cmake DESTINATION ${config_folder} COMPONENT development)

# -l of a library before those that it needs; the folder of the .pc file is how many levels below the prefix?
set(LIMCYCLE_PC_LIBRARIES ${parts})
list(REVERSE LIMCYCLE_PC_LIBRARIES)
list(TRANSFORM LIMCYCLE_PC_LIBRARIES PREPEND -llimcycle_)
list(JOIN LIMCYCLE_PC_LIBRARIES " " LIMCYCLE_PC_LIBRARIES)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
  OUTPUT_VARIABLE LIMCYCLE_PC_TO_PREFIX)
configure_file(cmake/limcycle.pc.in ${PROJECT_BINARY_DIR}/package/limcycle.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/limcycle.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT development)

# Headers that the program does not include, and a user may: methods that it reaches through others, laws of one's own.
set(entries models/friction/own_law.hpp models/diagram/assemble.hpp analysis/frequency/describing_function/df_table.hpp
  analysis/frequency/composite/composite_describing_function.hpp
  analysis/frequency/harmonic_balance/harmonic_balance.hpp analysis/orbit/simulate/ensemble.hpp analysis/orbit/cycle/floquet.hpp
  analysis/study/dissipativity.hpp analysis/study/continuation/follow.hpp analysis/study/precision/precision.hpp analysis/study/adequacy/adequate.hpp)
set(headers ${CMAKE_INSTALL_INCLUDEDIR}/limcycle)
install(CODE "set(source [[${PROJECT_SOURCE_DIR}]])
set(entries [[${entries}]])
set(parts [[${parts}]])
set(destination \"\${CMAKE_INSTALL_PREFIX}/${headers}\")" COMPONENT development)
install(SCRIPT cmake/install_headers.cmake COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/include/limcycle/version.hpp DESTINATION ${headers} COMPONENT development)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)

if(LIMCYCLE_PROGRAM)
  install(TARGETS limcycle RUNTIME COMPONENT program)
  install(DIRECTORY cases/ DESTINATION ${CMAKE_INSTALL_DATADIR}/limcycle/cases COMPONENT program
    FILES_MATCHING PATTERN "*.toml" PATTERN "*.csv")
  install(DIRECTORY matlab DESTINATION ${CMAKE_INSTALL_DATADIR}/limcycle COMPONENT program)
  install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
  if(NOT CMAKE_CROSSCOMPILING)
    set(written ${PROJECT_BINARY_DIR}/user_files)
    add_custom_command(OUTPUT ${written}/man1/limcycle.1 DEPENDS limcycle cmake/user_files.cmake
      COMMAND ${CMAKE_COMMAND} -D program=$<TARGET_FILE:limcycle> -D folder=${written}
        -P ${PROJECT_SOURCE_DIR}/cmake/user_files.cmake
      COMMENT "Manual pages and completions, by the program" VERBATIM)
    add_custom_target(limcycle_user_files ALL DEPENDS ${written}/man1/limcycle.1)
    install(DIRECTORY ${written}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
    install(FILES ${written}/completions/limcycle DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
      COMPONENT program)
    install(FILES ${written}/completions/_limcycle DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions
      COMPONENT program)
    install(FILES ${written}/completions/limcycle.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
      COMPONENT program)
  endif()
endif()
