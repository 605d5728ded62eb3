// Where Fieldwright's own files lie: samples, pictures, fonts, modules. They are looked for from the program
// that runs, so that whatever it was installed, unpacked or built into may be moved.
#pragma once

#include <filesystem>

namespace fw {

/// The folder of the program that runs, behind all links; empty where the system does not tell.
std::filesystem::path programFolder();

/// The nearest folder that is called `name`, in share/fieldwright or by itself, above the program, and holds
/// `file`; empty if there is none. As in PREFIX/bin and PREFIX/share/fieldwright/samples, or in the source
/// tree's build/release and samples.
std::filesystem::path ownFolder(const char* name, const char* file);

}  // namespace fw
