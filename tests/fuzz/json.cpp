// libFuzzer: any bytes are read as a graph file. What is read must be written so that it reads back as the
// same document and the same bytes, and its structure must be checkable; what is refused must be refused with
// a place. What can be read of it must be a document too, and the same one where all can be.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_json
//   build/fuzz/fuzz_json -max_total_time=60 -max_len=4096 -dict=tests/fuzz/json.dict CORPUS samples
//   tests/data/bad

#include <cstdint>
#include <string_view>

#include "graph/check/check.h"
#include "graph/document/json.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    std::vector<fw::Error> warnings;
    const fw::Result<fw::Graph> graph = fw::parseGraph(text, "fuzz.field.json", &warnings);
    const fw::PartialGraph part = fw::parseWhatCanBeRead(text, "fuzz.field.json");
    require(part.whole == bool(graph), "all can be read, or there is an error");
    require(!graph || *graph == part.graph, "both readings give the same document");
    if (part.any) {
        const fw::Result<fw::Graph> kept =
            fw::parseGraph(fw::writeGraph(part.graph), "fuzz.field.json", nullptr);
        require(kept && *kept == part.graph, "what was kept is a document");
    }
    for (const fw::Error& finding : part.findings)
        require(!finding.message.empty() && finding.line > 0, "what was left out has a reason and a place");
    if (!graph) {
        require(!graph.error().message.empty(), "an error has a message");
        require(graph.error().line > 0 && graph.error().column > 0, "an error has a place");
        return 0;
    }
    const std::string written = fw::writeGraph(*graph);
    const fw::Result<fw::Graph> again = fw::parseGraph(written, "fuzz.field.json", nullptr);
    require(bool(again), "what was written can be read");
    require(*again == *graph, "reading what was written gives the same document");
    require(fw::writeGraph(*again) == written, "writing it again gives the same bytes");
    for (const fw::Error& finding : fw::checkStructure(*graph))
        require(!finding.message.empty(), "a finding has a message");
    return 0;
}
