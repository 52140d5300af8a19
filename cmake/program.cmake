# The program, from cli/: the only place that sees every layer.
find_package(CLI11 2.1 REQUIRED)
file(GLOB_RECURSE cli_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cli/*.cpp)
add_executable(limcycle ${cli_sources})
target_link_libraries(limcycle PRIVATE limcycle_options limcycle_questions CLI11::CLI11 fmt::fmt
  nlohmann_json::nlohmann_json)
limcycle_text(limcycle)
if(LIMCYCLE_SANITIZE)
  limcycle_optimised_first(limcycle limcycle_analysis limcycle_models)
endif()
limcycle_unity(limcycle)
if(LIMCYCLE_MPI)
  # Only the C interface is called (from C++, the one language here); one source sees it, and by itself.
  set(MPI_CXX_SKIP_MPICXX ON)
  find_package(MPI COMPONENTS CXX)
  if(MPI_CXX_FOUND)
    target_link_libraries(limcycle PRIVATE MPI::MPI_CXX)
    set_source_files_properties(cli/ranks/ranks.cpp PROPERTIES COMPILE_DEFINITIONS LIMCYCLE_MPI
      SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endif()
