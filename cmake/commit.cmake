# Writes OUTPUT, a source that holds the commit of SOURCE (GIT: the program, or empty). It stays untouched if it is right.
set(LIMCYCLE_COMMIT "unknown")
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
    OUTPUT_VARIABLE LIMCYCLE_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
configure_file(${SOURCE}/cmake/commit.cpp.in ${OUTPUT} @ONLY)
