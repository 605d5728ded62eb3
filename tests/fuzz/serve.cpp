// libFuzzer: any bytes come from a client of the server, without a device. Whatever they are, the server
// reads to their end, answers with lines of JSON that have an id and a result or an error with a reason, and
// lets go of all.
//
//   cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_serve
//   build/fuzz/fuzz_serve -max_total_time=60 -max_len=4096 -dict=tests/fuzz/serve.dict CORPUS
//   tests/fuzz/serve
//
// The first byte says which of its protocols is spoken. What is read and written lies below an empty folder.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "graph/base/fence.h"
#include "runtime/serve/assistant.h"
#include "runtime/serve/client.h"
#include "tests/fuzz/require.h"

namespace {

/// A file in memory that has these bytes, at its beginning.
int fileOf(std::string_view bytes) {
    const int file = memfd_create("fuzz", MFD_CLOEXEC);
    require(file >= 0 && write(file, bytes.data(), bytes.size()) == ssize_t(bytes.size()),
            "a file in memory");
    lseek(file, 0, SEEK_SET);
    return file;
}

std::string contentOf(int file) {
    std::string content(std::size_t(lseek(file, 0, SEEK_END)), '\0');
    require(pread(file, content.data(), content.size(), 0) == ssize_t(content.size()), "what was written");
    return content;
}

void checkAnswers(std::string_view said, bool blobs) {
    while (!said.empty()) {
        const std::size_t end = said.find('\n');
        require(end != std::string_view::npos, "an answer is a whole line");
        const fw::Json json = fw::Json::parse(said.substr(0, end), nullptr, false);
        require(json.is_object(), "an answer is JSON");
        said.remove_prefix(end + 1);
        if (!json.contains("id")) {
            require(json.contains("method"), "or it is a notification");
            continue;
        }
        require(json.contains("result") != json.contains("error"), "it has a result or an error");
        if (json.contains("error"))
            require(!json["error"]["message"].get<std::string>().empty(), "an error has a reason");
        else if (blobs && json["result"].contains("blobs"))
            for (const fw::Json& blob : json["result"]["blobs"])
                said.remove_prefix(blob["bytes"].get<std::size_t>());
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    using namespace fw;
    static const std::string folder = [] {
        std::string name = std::filesystem::temp_directory_path() / "fieldwright-fuzz-XXXXXX";
        require(mkdtemp(name.data()) != nullptr, "a folder");
        require(bool(fenceFiles({name})) && chdir(name.c_str()) == 0, "a fence about it");
        return name;
    }();
    if (size == 0) return 0;
    const bool assistant = data[0] % 2 != 0;
    const int in = fileOf({reinterpret_cast<const char*>(data) + 1, size - 1}), out = fileOf("");
    const serve::OpenDevice none = []() -> Result<Device> { return Error{.message = "there is no device"}; };
    {
        serve::Wire wire(in, out);
        if (assistant)
            serve::Assistant(wire, none).serve();
        else
            serve::Client(wire, none, [] {}).serve();
    }
    checkAnswers(contentOf(out), !assistant);
    close(in), close(out);
    for (const auto& entry : std::filesystem::directory_iterator(folder)) std::filesystem::remove_all(entry);
    return 0;
}
