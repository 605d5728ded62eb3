# Writes THIRD_PARTY_NOTICES for each package: the licences of the third-party code in its binaries
# (third_party.py). Debian packages have this file in usr/share/doc/PACKAGE, the archive in
# share/doc/fieldwright, and the wheel next to LICENSE in its folder of licences. The data come from
# Debian's packages and from Ninja, so that other systems build without notices.
find_program(FIELDWRIGHT_NOTICES_PYTHON python3 HINTS /usr/bin)
find_program(FIELDWRIGHT_DPKG_QUERY dpkg-query)
mark_as_advanced(FIELDWRIGHT_NOTICES_PYTHON FIELDWRIGHT_DPKG_QUERY)
if(NOT (FIELDWRIGHT_NOTICES_PYTHON AND FIELDWRIGHT_DPKG_QUERY AND CMAKE_GENERATOR STREQUAL Ninja))
    message(STATUS "No THIRD_PARTY_NOTICES: they need Ninja, python3 and dpkg-query")
    return()
endif()

# add_notices(PACKAGE COMPONENT TARGET...): writes and installs the notices of a package that holds these targets.
function(add_notices package component)
    set(notices ${CMAKE_BINARY_DIR}/pages/${package}/THIRD_PARTY_NOTICES)
    list(TRANSFORM ARGN REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE binaries)
    file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/pages/${package})
    add_custom_command(OUTPUT ${notices} DEPENDS ${ARGN} ${here}/third_party.py ${here}/copyright_files.py
                       COMMAND ${FIELDWRIGHT_NOTICES_PYTHON} ${here}/third_party.py ${CMAKE_BINARY_DIR} ${notices} ${binaries}
                       COMMENT "Writing the third-party notices of ${package}")
    add_custom_target(notices-${package} ALL DEPENDS ${notices})
    install(FILES ${notices} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component} OPTIONAL)
endfunction()
add_notices(fieldwright application fieldwright fieldwright-editor fw_vdb)
add_notices(fieldwright-dev development fw_graph fw_runtime)
if(TARGET fw_python)
    add_notices(python3-fieldwright python fw_python)
    set(licences ${CMAKE_SOURCE_DIR}/LICENSE ${CMAKE_BINARY_DIR}/pages/python3-fieldwright/THIRD_PARTY_NOTICES)
    add_custom_command(OUTPUT ${python_wheel} APPEND DEPENDS ${here}/add_licences.py ${licences}
                       COMMAND ${FIELDWRIGHT_NOTICES_PYTHON} ${here}/add_licences.py ${python_wheel} ${licences})
endif()
