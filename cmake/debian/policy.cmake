# What Debian's policy asks of a package beyond the files that are installed: a copyright and a changelog in the folder of
# its name, compressed manual pages, libraries without symbols for debuggers. Run by cpack before it packs.
set(root "${CPACK_TEMPORARY_DIRECTORY}")

function(compress file)
  execute_process(COMMAND gzip -9nf "${file}" COMMAND_ERROR_IS_FATAL ANY)
endfunction()

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(package "${CPACK_DEBIAN_${upper}_PACKAGE_NAME}")
  set(usr "${root}/${component}/usr")
  set(doc "${usr}/share/doc/${package}")
  file(COPY "${CMAKE_CURRENT_LIST_DIR}/copyright" DESTINATION "${doc}" FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ
    WORLD_READ)
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(WRITE "${doc}/changelog.Debian"
"${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * Built from the sources of version ${CPACK_PACKAGE_VERSION}.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
  compress("${doc}/changelog.Debian")
  # The licence stands in /usr/share/common-licenses, which the copyright names.
  file(REMOVE "${usr}/share/doc/limcycle/LICENSE")
  file(GLOB pages "${usr}/share/man/man1/*.1")
  foreach(page IN LISTS pages)
    compress("${page}")
  endforeach()
  # Debian's zsh looks here.
  if(EXISTS "${usr}/share/zsh/site-functions")
    file(RENAME "${usr}/share/zsh/site-functions" "${usr}/share/zsh/vendor-completions")
  endif()
  # Examples belong to the package that they are of.
  if(component STREQUAL development)
    file(RENAME "${usr}/share/doc/limcycle/examples" "${doc}/examples")
    file(REMOVE_RECURSE "${usr}/share/doc/limcycle")
  endif()
  file(GLOB libraries "${usr}/lib/*.a")
  foreach(library IN LISTS libraries)
    execute_process(COMMAND strip --strip-debug --remove-section=.comment --remove-section=.note "${library}"
      COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endforeach()
