# Installs the parts of the archive that come from other packages: the libraries that `programs` and `module` need and plain
# systems lack, and fonts, each with its copyright file and the licence texts that this file refers to. The C and C++ runtimes
# remain those of the system, and so do the other libraries that Vulkan drivers load, because a process must not have two of them.
# THIRD_PARTY_NOTICES (notices.cmake) is about the code in Fieldwright's own binaries.
set(CMAKE_GET_RUNTIME_DEPENDENCIES_PLATFORM linux+elf)
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${programs} MODULES ${module} RESOLVED_DEPENDENCIES_VAR needed UNRESOLVED_DEPENDENCIES_VAR lacking
     PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|rt|pthread|stdc\\+\\+|gcc_s|z|zstd|lzma)\\.so")
if(lacking)
    message(FATAL_ERROR "These libraries are not here to be carried: ${lacking}")
endif()
file(GLOB letters /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf /usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf
     /usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf /usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf
     /usr/share/fonts/truetype/dejavu/DejaVuSerif-Bold.ttf)
if(NOT letters)
    message(FATAL_ERROR "The fonts DejaVu are not here to be carried: install fonts-dejavu-core")
endif()
file(INSTALL ${letters} DESTINATION ${CMAKE_INSTALL_PREFIX}/share/fieldwright/fonts)
file(INSTALL ${needed} DESTINATION ${CMAKE_INSTALL_PREFIX}/${modules_folder} FOLLOW_SYMLINK_CHAIN)
set(owners)
foreach(file ${needed} ${letters})
    get_filename_component(real ${file} REALPATH)
    execute_process(COMMAND dpkg-query -S ${real} OUTPUT_VARIABLE owner ERROR_QUIET RESULT_VARIABLE unknown)
    if(unknown)  # as /lib of a merged /usr
        string(REGEX REPLACE "^/usr/" "/" real ${real})
        execute_process(COMMAND dpkg-query -S ${real} OUTPUT_VARIABLE owner)
    endif()
    string(REGEX REPLACE "[:,].*" "" owner "${owner}")
    list(APPEND owners ${owner})
endforeach()
list(REMOVE_DUPLICATES owners)
set(documents ${CMAKE_INSTALL_PREFIX}/share/doc/fieldwright/libraries)
set(licences)
foreach(owner ${owners})
    file(INSTALL /usr/share/doc/${owner}/copyright DESTINATION ${documents} RENAME ${owner})
    file(READ /usr/share/doc/${owner}/copyright text)
    string(REGEX MATCHALL "/usr/share/common-licenses/[A-Za-z]+-[0-9.]*[0-9]" referred "${text}")
    list(APPEND licences ${referred})
endforeach()
list(REMOVE_DUPLICATES licences)
file(INSTALL ${licences} DESTINATION ${documents}/common-licenses)
