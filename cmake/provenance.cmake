# What a result must say about the binary that made it: version, commit, compiler, flags.
set(LIMCYCLE_COMPILER "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
configure_file(${PROJECT_SOURCE_DIR}/cmake/build_info.hpp.in ${PROJECT_BINARY_DIR}/generated/build_info.hpp @ONLY)

# The commit is that of the tree when the program is built, which may be long after it was configured. It is written
# now too, for tools that read sources without building them.
find_package(Git QUIET)
set(commit_source ${PROJECT_BINARY_DIR}/generated/commit.cpp)
set(write_commit ${CMAKE_COMMAND} -D GIT=${GIT_EXECUTABLE} -D SOURCE=${PROJECT_SOURCE_DIR} -D OUTPUT=${commit_source}
  -P ${PROJECT_SOURCE_DIR}/cmake/commit.cmake)
execute_process(COMMAND ${write_commit})
add_custom_target(limcycle_commit COMMAND ${write_commit} BYPRODUCTS ${commit_source} VERBATIM
  COMMENT "The commit of the tree")
set_source_files_properties(${commit_source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

# build_info.hpp for whoever links the questions.
target_include_directories(limcycle_questions PUBLIC ${PROJECT_BINARY_DIR}/generated)
add_dependencies(limcycle_questions limcycle_commit)
target_sources(limcycle_questions PRIVATE ${commit_source})
