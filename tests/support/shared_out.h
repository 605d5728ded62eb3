// A graph that moves and has parameters, and jobs of it.
#pragma once

#include <gtest/gtest.h>

#include "runtime/play/frames.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::test {

struct SharedOut : testing::Test {
    /// A ball that rests, and one above it that goes to and fro: eight frames.
    static const std::string kGraph;
    TempDir folder;
    std::string graph = folder.path("a.field.json"), job = folder.path("job");
    void SetUp() override;

    /// `fieldwright job` of the command, for an engine, into the folder `job`.
    CommandResult shareOut(const std::string& engine, const std::vector<std::string>& options,
                           const std::vector<std::string>& command) const;
    /// Runs the job's `submit`.
    ProgramResult submit(const std::string& options = {}) const;
    /// Expects the same names and bytes in both folders.
    static void expectSameFiles(const std::string& made, const std::string& wanted);
};

}  // namespace fw::test
