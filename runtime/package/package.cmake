# What CPack makes of the components: fieldwright_VERSION_amd64.deb, fieldwright-dev_VERSION_amd64.deb,
# python3-fieldwright_VERSION_amd64.deb, and fieldwright-VERSION-linux-x86_64.tar.gz with the application alone.
set(CPACK_GENERATOR DEB TGZ)
set(CPACK_PACKAGE_VENDOR "The Fieldwright authors")
# Debian wants an address of who answers for a package: whoever hands packages out gives theirs. This one reaches nobody (RFC 2606).
set(CPACK_PACKAGE_CONTACT "The Fieldwright authors <authors@fieldwright.invalid>" CACHE STRING "Who packages it, with an address")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "procedural solids from graphs of signed distance fields")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_THREADS 0)
set(CPACK_PROJECT_CONFIG_FILE ${here}/per_format.cmake)

# The archive, with a third component: what it carries.
install(CODE "set(programs \"$<TARGET_FILE:fieldwright>\" \"$<TARGET_FILE:fieldwright-editor>\")
set(module \"$<TARGET_FILE:fw_vdb>\")
set(modules_folder ${modules_folder})" COMPONENT carried EXCLUDE_FROM_ALL)
install(SCRIPT ${here}/carry.cmake COMPONENT carried EXCLUDE_FROM_ALL)
string(TOLOWER "fieldwright-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR}" archive)
set(CPACK_PACKAGE_FILE_NAME ${archive})
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)

# The Debian packages.
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_APPLICATION_PACKAGE_NAME fieldwright)
set(CPACK_DEBIAN_APPLICATION_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_APPLICATION_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_APPLICATION_PACKAGE_DEPENDS fonts-dejavu-core)
set(CPACK_DEBIAN_APPLICATION_PACKAGE_RECOMMENDS
    "mesa-vulkan-drivers | vulkan-icd, fonts-droid-fallback, libxcursor1, libxi6, libxinerama1, libxrandr2, libxxf86vm1")
set(CPACK_COMPONENT_APPLICATION_DESCRIPTION "\
A model is a graph of nodes: boxes, repeats, booleans, noise, letters,
fluids, or code. Fieldwright compiles it to shader code, turns its surface
into closed triangle meshes for slicers, Blender and game engines, and makes
pictures of it, on any Vulkan 1.3 device or on the processor alone.

This package has the command fieldwright, the node editor, samples and
their pages.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME fieldwright-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
string(JOIN ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "fieldwright (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})"
    libvulkan-dev libglm-dev glslang-dev spirv-tools libtinygltf-dev nlohmann-json3-dev libstb-dev libmeshoptimizer-dev lib3mf-dev
    libopenexr-dev libharfbuzz-dev libfribidi-dev libfontconfig-dev libpugixml-dev libzip-dev)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "\
Headers and static libraries for programs that embed the runtime, and what
CMake and pkg-config find them by: open a graph, set its parameters, step
through its time, and have its mesh or picture.")

set(components application development)
if(TARGET fw_python)
    list(APPEND components python)
    math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-fieldwright)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
    string(JOIN ", " CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
        "fieldwright (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})"
        "python3 (>= 3.${Python3_VERSION_MINOR}~)" "python3 (<< 3.${next_python})" python3-numpy)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${here}/python3-fieldwright/postinst ${here}/python3-fieldwright/prerm)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
    set(CPACK_COMPONENT_PYTHON_DESCRIPTION "\
The module fieldwright of Python: open or build graphs of nodes, and have
their distances, meshes and pictures as arrays of numpy.")
endif()
set(CPACK_FIELDWRIGHT_COMPONENTS ${components})  # read by per_format.cmake

# What Debian has in each package's own folder, written once here, and what lintian need not say.
foreach(component ${components})
    string(TOUPPER ${component} name)
    set(package ${CPACK_DEBIAN_${name}_PACKAGE_NAME})
    set(folder ${CMAKE_BINARY_DIR}/pages/${package})
    file(MAKE_DIRECTORY ${folder})
    string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
    file(WRITE ${folder}/changelog.Debian "fieldwright (${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * What changed is told by /usr/share/fieldwright/CHANGELOG.md.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
    execute_process(COMMAND gzip -9nf ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
    install(FILES ${folder}/changelog.Debian.gz ${here}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
    install(FILES ${here}/lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME ${package} COMPONENT ${component})
endforeach()
include(CPack)
