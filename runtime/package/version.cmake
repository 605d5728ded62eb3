# Writes OUT, the source behind runtime/system/version.h, if it would be another: VERSION, the commit of SOURCE if that is the
# top of a repository, and the type of the BUILD.
execute_process(COMMAND git rev-parse --show-prefix --short HEAD WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE said ERROR_QUIET RESULT_VARIABLE failed)
set(commit)
if(NOT failed AND said MATCHES "^\n([0-9a-f]+)\n$")
    set(commit "${CMAKE_MATCH_1}, ")
endif()
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [[
#include "runtime/system/version.h"

const char* const fw::kVersionAndBuild = "@VERSION@ (@commit@@BUILD@)";
]])
