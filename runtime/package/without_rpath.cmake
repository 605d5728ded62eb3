# Run by CPack on what a Debian package will hold: programs of the system look for libraries in the system alone.
file(GLOB_RECURSE programs ${CPACK_TEMPORARY_DIRECTORY}/fieldwright ${CPACK_TEMPORARY_DIRECTORY}/fieldwright-editor)
list(FILTER programs INCLUDE REGEX "/bin/[^/]*$")
foreach(program ${programs})
    file(RPATH_REMOVE FILE ${program})
endforeach()
