// libFuzzer: the first byte says whether the others are a 3MF file or the text of its model. What is read is
// a graph that can be written and read again; what is refused must be refused with a reason.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_implicit3mf
//   build/fuzz/fuzz_implicit3mf -max_total_time=60 -max_len=4096 -dict=tests/fuzz/implicit3mf.dict CORPUS
//   tests/fuzz/implicit3mf

#include <cstdint>

#include "graph/document/json.h"
#include "graph/implicit3mf/import.h"
#include "graph/implicit3mf/package.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    const fw::Result<fw::Imported> imported = fw::import3mf(
        data[0] & 1 ? bytes : fw::threemf::packed({{"3D/3dmodel.model", bytes}}), "a.3mf", "a_3mf");
    if (!imported) {
        require(!imported.error().message.empty() && imported.error().file == "a.3mf",
                "a refusal has a reason");
        return 0;
    }
    const fw::Result<fw::Graph> again = fw::parseGraph(fw::writeGraph(imported->graph), "", nullptr);
    require(bool(again), "the graph is one");
    require(fw::writeGraph(*again) == fw::writeGraph(imported->graph), "nothing of it is lost");
    for (const fw::FileBeside& file : imported->files) {
        require(file.path.starts_with("a_3mf/"), "files stay in their folder");
        require(file.path.find("..") == std::string::npos, "and go nowhere else");
    }
    return 0;
}
