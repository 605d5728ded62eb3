// libFuzzer: any bytes are pasted, into a document and into a group of it. What is taken must leave the
// document as sound as it was and readable when it is written; it must be possible to copy and paste it
// again. What is refused must be refused with a reason.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_paste
//   build/fuzz/fuzz_paste -max_total_time=60 -max_len=4096 -dict=tests/fuzz/paste.dict CORPUS samples

#include <cstdint>
#include <string_view>

#include "editor/document/clipboard.h"
#include "editor/document/soundness.h"
#include "graph/document/json.h"
#include "tests/fuzz/require.h"

namespace {

constexpr std::string_view kDocument = R"({"fieldwright": 1, "nodes": [
    {"id": "a", "type": "sphere", "at": [0, 0]},
    {"id": "g", "type": "group", "group": "ring", "inputs": {"surface": {"from": "a"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "g"}}}],
  "groups": [{"id": "ring", "inputs": [{"name": "surface", "type": "surface"}],
    "outputs": [{"name": "surface", "type": "surface"}], "nodes": [
    {"id": "in", "type": "group_input"},
    {"id": "end", "type": "group_output", "inputs": {"surface": {"from": "in", "output": "surface"}}}]}]})";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    using namespace fw;
    static const Result<Graph> document = parseGraph(kDocument, "fuzz.field.json", nullptr);
    require(bool(document), "the document is one");
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    for (const std::string_view scope : {"", "ring"}) {
        const Result<editor::Edited> pasted = editor::pasteNodes(*document, scope, text, {100, 50});
        if (!pasted) {
            require(!pasted.error().message.empty(), "an error has a message");
            continue;
        }
        require(!editor::newError(*document, pasted->graph), "the document is as sound as before");
        const Result<Graph> again = parseGraph(writeGraph(pasted->graph), "fuzz.field.json", nullptr);
        require(bool(again), "what was written can be read");
        require(*again == pasted->graph, "reading what was written gives the same document");
        if (pasted->nodes.empty()) continue;
        const std::string copied = editor::copyNodes(pasted->graph, scope, pasted->nodes);
        require(bool(editor::pasteNodes(*document, scope, copied, {0, 0})), "what was copied can be pasted");
    }
    return 0;
}
