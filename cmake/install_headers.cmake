# Installs the public headers and no others: those that the program is made with (cli/ and questions/ include them),
# those named in `entries`, and all that these include in turn, of the parts that are built. Run by `cmake --install`;
# needs source, destination, entries, parts.
cmake_policy(VERSION 3.25)
file(GLOB_RECURSE commands "${source}/cli/*.[ch]pp" "${source}/questions/*.[ch]pp")
set(own "^#include \"limcycle/((models|analysis|cases|reports)/[^\"]+)\".*")
foreach(command IN LISTS commands)
  file(STRINGS "${command}" lines REGEX "${own}")
  list(TRANSFORM lines REPLACE "${own}" "\\1")
  list(APPEND entries ${lines})
endforeach()

set(done)
while(entries)
  list(POP_FRONT entries header)
  if(header IN_LIST done)
    continue()
  endif()
  list(APPEND done "${header}")
  file(STRINGS "${source}/${header}" lines REGEX "${own}")
  list(TRANSFORM lines REPLACE "${own}" "\\1")
  list(APPEND entries ${lines})
  cmake_path(GET header PARENT_PATH folder)
  string(REGEX REPLACE "/.*" "" part "${header}")
  if(NOT part IN_LIST parts)  # the reports, where they are not built
    continue()
  endif()
  file(INSTALL DESTINATION "${destination}/${folder}" TYPE FILE FILES "${source}/${header}")
endwhile()
