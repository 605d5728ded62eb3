#include "tests/support/shared_out.h"

#include "runtime/jobs/task_script.h"

namespace fw::test {

const std::string SharedOut::kGraph = R"({"fieldwright": 1, "parameters": [
  {"name": "size", "node": "rest", "input": "radius", "min": 0.1, "max": 1},
  {"name": "high", "node": "ball", "input": "radius", "min": 0.1, "max": 3}], "nodes": [
  {"id": "rest", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "ball", "type": "sphere", "inputs": {"radius": 0.5}},
  {"id": "lift", "type": "translate", "inputs": {"surface": {"from": "ball"}, "offset": [0, 1.5, 0]}},
  {"id": "both", "type": "union", "inputs": {"a": {"from": "rest"}, "b": {"from": "lift"}}},
  {"id": "out", "type": "output", "inputs": {"surface": {"from": "both"}, "resolution": 24}}],
 "timeline": {"length": 2, "fps": 4, "tracks": [{"node": "lift", "input": "offset", "keys": [
   {"time": 0, "value": [0, 1.5, 0]}, {"time": 1, "value": [1, 1.5, 0]}, {"time": 2, "value": [0, 1.5, 0]}]}]}})";

void SharedOut::SetUp() { writeText(graph, kGraph); }

CommandResult SharedOut::shareOut(const std::string& engine, const std::vector<std::string>& options,
                                  const std::vector<std::string>& command) const {
    std::vector<std::string> words = {"job", "--for", engine, "-o", job};
    words.insert(words.end(), options.begin(), options.end());
    words.push_back("--");
    words.insert(words.end(), command.begin(), command.end());
    CommandResult result = runCommand(words);
    EXPECT_EQ(result.output, result.status == 0 ? job + "/submit\n" : "") << result.errors;
    return result;
}

ProgramResult SharedOut::submit(const std::string& options) const {
    return runProgram("XDG_CACHE_HOME=" + shellWord(folder.path("caches")) + " " +
                      shellWord(job + "/submit") + " " + options);
}

void SharedOut::expectSameFiles(const std::string& made, const std::string& wanted) {
    EXPECT_EQ(namesIn(made), namesIn(wanted));
    for (const std::string& name : namesIn(wanted))
        EXPECT_TRUE(readText(made + "/" + name) == readText(wanted + "/" + name)) << name;
}

}  // namespace fw::test
