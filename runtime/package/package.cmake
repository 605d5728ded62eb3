# What CPack makes of the components: fieldwright_VERSION_amd64.deb, fieldwright-dev_VERSION_amd64.deb, and
# fieldwright-VERSION-linux-x86_64.tar.gz with the application alone.
set(CPACK_GENERATOR DEB TGZ)
set(CPACK_PACKAGE_VENDOR "The Fieldwright authors")
set(CPACK_PACKAGE_CONTACT "The Fieldwright authors <authors@fieldwright.org>" CACHE STRING "Who packages it, with an address")
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

# What Debian has in each package's own folder, written once here.
foreach(package fieldwright fieldwright-dev)
    if(package STREQUAL fieldwright-dev)
        set(component development)
    else()
        set(component application)
    endif()
    set(folder ${CMAKE_BINARY_DIR}/pages/${package})
    file(MAKE_DIRECTORY ${folder})
    string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
    file(WRITE ${folder}/changelog.Debian "fieldwright (${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * What changed is told by /usr/share/fieldwright/CHANGELOG.md.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
    execute_process(COMMAND gzip -9nf ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
    install(FILES ${folder}/changelog.Debian.gz ${here}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endforeach()
include(CPack)
