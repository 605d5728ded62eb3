// Which Fieldwright a program is. Stands in an object of its own that is made anew with each commit, so that
// only programs that ask for it are linked anew.
#pragma once

namespace fw {

/// "0.1.0 (5a73a19, Release)": version, commit if it was built from a repository, and type of the build.
extern const char* const kVersionAndBuild;

}  // namespace fw
