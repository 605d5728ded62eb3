// A folder of a test's own, removed with all it holds when the test ends.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fw::test {

class TempDir {
  public:
    TempDir();
    TempDir(const TempDir&) = delete;
    TempDir& operator=(const TempDir&) = delete;
    ~TempDir();

    std::string path(const std::string& name) const { return (folder / name).string(); }
    /// Names of all entries, hidden ones too, sorted: what an operation left behind.
    std::vector<std::string> names() const;

    std::filesystem::path folder;
};

/// What a folder holds, by name, in their order.
std::vector<std::string> namesIn(const std::string& folder);

/// Whole content of a file; fails the test if it cannot be read.
std::string readText(const std::string& path);
void writeText(const std::string& path, const std::string& text);

/// What a program printed (both streams), and its exit status (-1 if it did not end by itself).
struct ProgramResult {
    int status = -1;
    std::string output;
};
/// Runs a shell command line.
ProgramResult runProgram(const std::string& commandLine);

}  // namespace fw::test
