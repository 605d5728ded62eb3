# What is installed and where, in three components: `application` (programs, what they read, what a desktop shows of them),
# `development` (what programs that embed the runtime are built with) and, if it is built, `python` (the module). CPack makes of
# them the Debian packages fieldwright, fieldwright-dev and python3-fieldwright, and of the first an archive that runs from any
# folder, with the libraries that plain systems lack:
#     cmake --build build/ci --target package
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME application)
set(here ${CMAKE_SOURCE_DIR}/runtime/package)

# In the archive libraries lie in the modules' folder, for the programs and for what those load: as DT_RPATH, which unlike
# DT_RUNPATH holds for libraries of libraries too. Packages go without (without_rpath.cmake).
foreach(program fieldwright fieldwright-editor)
    set_target_properties(${program} PROPERTIES INSTALL_RPATH "$ORIGIN/../${modules_folder}")
    target_link_options(${program} PRIVATE -Wl,--disable-new-dtags)
    install(TARGETS ${program} OPTIONAL)
endforeach()
install(TARGETS fw_vdb LIBRARY DESTINATION ${modules_folder} OPTIONAL)

# As in the source tree, so that the pages' links and the editor find them (graph/base/own_files.h).
set(data ${CMAKE_INSTALL_DATADIR}/fieldwright)
install(DIRECTORY samples docs DESTINATION ${data} PATTERN pictures/make EXCLUDE)
install(FILES README.md ARCHITECTURE.md CHANGELOG.md CONTRIBUTING.md LICENSE DESTINATION ${data})

install(FILES ${blender_zip} DESTINATION ${data} OPTIONAL)

# What a desktop shows.
install(FILES ${here}/fieldwright-editor.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES ${here}/fieldwright.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages)
set(icons ${CMAKE_INSTALL_DATADIR}/icons/hicolor)
install(FILES ${here}/fieldwright.svg DESTINATION ${icons}/scalable/apps)
install(FILES ${here}/fieldwright.png DESTINATION ${icons}/256x256/apps)
install(FILES ${here}/application-x-fieldwright+json.svg DESTINATION ${icons}/scalable/mimetypes)

# Manual pages and completions: the programs print their own.
set(pages)
foreach(program fieldwright fieldwright-editor)
    foreach(page bash zsh fish)
        add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/pages/${program}.${page} DEPENDS ${program}
                           COMMAND ${program} --completion ${page} > pages/${program}.${page} WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
        list(APPEND pages ${CMAKE_BINARY_DIR}/pages/${program}.${page})
    endforeach()
    add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/pages/${program}.1.gz DEPENDS ${program}
                       COMMAND ${program} --manual | gzip -9n > pages/${program}.1.gz WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
    list(APPEND pages ${CMAKE_BINARY_DIR}/pages/${program}.1.gz)
    install(FILES ${CMAKE_BINARY_DIR}/pages/${program}.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
    install(FILES ${CMAKE_BINARY_DIR}/pages/${program}.bash OPTIONAL
            DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
    install(FILES ${CMAKE_BINARY_DIR}/pages/${program}.zsh OPTIONAL
            DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _${program})
    install(FILES ${CMAKE_BINARY_DIR}/pages/${program}.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d OPTIONAL)
endforeach()
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/pages)
add_custom_target(pages ALL DEPENDS ${pages})

# What find_package(fieldwright) finds: the target fieldwright::runtime, and headers as <fieldwright/runtime/player.h>. pkg-config
# has the same.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fieldwright)
set_target_properties(fw_graph PROPERTIES EXPORT_NAME graph)
set_target_properties(fw_runtime PROPERTIES EXPORT_NAME runtime)
target_compile_features(fw_graph PUBLIC cxx_std_20)
target_include_directories(fw_graph INTERFACE "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR};${CMAKE_INSTALL_INCLUDEDIR}/fieldwright>")
install(TARGETS fw_graph fw_runtime EXPORT fieldwright)
install(DIRECTORY graph runtime shaders DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/fieldwright
        FILES_MATCHING PATTERN "*.h" PATTERN cli EXCLUDE PATTERN serve EXCLUDE PATTERN window EXCLUDE
        PATTERN blender EXCLUDE PATTERN python EXCLUDE PATTERN package EXCLUDE)
install(EXPORT fieldwright NAMESPACE fieldwright:: FILE fieldwright-targets.cmake DESTINATION ${package_folder})
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/package/fieldwright-config.cmake @ONLY CONTENT [[
include(CMakeFindDependencyMacro)
find_dependency(nlohmann_json)
find_dependency(Vulkan)
find_dependency(Threads)
find_dependency(meshoptimizer)
find_dependency(OpenEXR)
find_dependency(pugixml)
find_dependency(PkgConfig)
pkg_check_modules(letters REQUIRED IMPORTED_TARGET harfbuzz fribidi fontconfig)
pkg_check_modules(zip REQUIRED IMPORTED_TARGET libzip)
include(${CMAKE_CURRENT_LIST_DIR}/fieldwright-targets.cmake)
]])
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/fieldwright-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(DIRECTORY ${CMAKE_BINARY_DIR}/package/ DESTINATION ${package_folder})
file(RELATIVE_PATH to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/pages/fieldwright.pc @ONLY CONTENT [[
prefix=${pcfiledir}/@to_prefix@
Name: fieldwright
Description: Procedural solids from graphs of signed distance fields
Version: @PROJECT_VERSION@
Requires: nlohmann_json vulkan OpenEXR pugixml harfbuzz fribidi fontconfig libzip
Cflags: -std=c++20 -I${prefix}/@CMAKE_INSTALL_INCLUDEDIR@ -I${prefix}/@CMAKE_INSTALL_INCLUDEDIR@/fieldwright
Libs: -L${prefix}/@CMAKE_INSTALL_LIBDIR@ -lfw_runtime -lfw_graph -lglslang -lMachineIndependent -lGenericCodeGen -lOGLCompiler -lOSDependent -lSPIRV -lglslang-default-resource-limits -lSPIRV-Tools-opt -lSPIRV-Tools -ltinygltf -lstb -lmeshoptimizer -l3MF -lpthread -ldl
]])
install(FILES ${CMAKE_BINARY_DIR}/pages/fieldwright.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# The module where Debian's Python looks: the contents of the wheel, without its list of files, by which pip would remove what
# apt has installed, and without its licences, which Debian keeps in usr/share/doc.
if(TARGET fw_python)
    install(CODE "set(packages \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/python3/dist-packages\")
file(ARCHIVE_EXTRACT INPUT \"${python_wheel}\" DESTINATION \"\${packages}\" TOUCH)
set(about \"\${packages}/fieldwright-${PROJECT_VERSION}.dist-info\")
file(REMOVE_RECURSE \"\${about}/RECORD\" \"\${about}/licenses\")" COMPONENT python EXCLUDE_FROM_ALL)
endif()

include(runtime/package/notices.cmake)
include(runtime/package/package.cmake)
