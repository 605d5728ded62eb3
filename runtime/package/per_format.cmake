# Read by CPack before each kind of package. An archive holds the application and what it carries, to be unpacked anywhere. Debian's
# packages are one for each component, and take all libraries from the system.
if(CPACK_GENERATOR STREQUAL TGZ)
    set(CPACK_COMPONENTS_ALL application carried)
    set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
    set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
else()
    set(CPACK_COMPONENTS_ALL ${CPACK_FIELDWRIGHT_COMPONENTS})
    set(CPACK_COMPONENTS_GROUPING IGNORE)
    set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/without_rpath.cmake)
endif()
