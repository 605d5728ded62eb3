#include "runtime/export/whole.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "runtime/export/formats.h"

namespace fw {

namespace {

struct Ends {
    uint64_t bytes = 0;
    std::string first = {}, last = {};  ///< at most 1 KiB each

    uint32_t word(std::size_t at) const {
        uint32_t number = 0;
        if (at + 4 <= first.size()) std::memcpy(&number, first.data() + at, 4);
        return number;
    }
};

std::optional<Ends> endsOf(const std::string& path) {
    constexpr uint64_t kMost = 1024;
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure)) return std::nullopt;
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) return std::nullopt;
    Ends ends{.bytes = uint64_t(file.tellg())};
    const auto size = std::size_t(std::min(ends.bytes, kMost));
    ends.first.resize(size), ends.last.resize(size);
    file.seekg(0).read(ends.first.data(), std::streamsize(size));
    file.seekg(std::streamoff(ends.bytes - size)).read(ends.last.data(), std::streamsize(size));
    return file ? std::optional(ends) : std::nullopt;
}

/// As many bytes as the header of a PLY says.
bool isWholePly(const Ends& ends) {
    const std::string end = "end_header\n";
    const std::size_t headerEnd = ends.first.find(end);
    if (headerEnd == std::string::npos) return false;
    std::istringstream header(ends.first.substr(0, headerEnd));
    uint64_t bytes = headerEnd + end.size(), vertices = 0, faces = 0, vertexBytes = 0;
    for (std::string line; std::getline(header, line);) {
        if (line.starts_with("element vertex ")) vertices = std::strtoull(line.c_str() + 15, nullptr, 10);
        if (line.starts_with("element face ")) faces = std::strtoull(line.c_str() + 13, nullptr, 10);
        vertexBytes += line.starts_with("property float ") ? 4 : line.starts_with("property uchar ") ? 1 : 0;
    }
    return ends.bytes == bytes + vertices * vertexBytes + faces * kPlyFaceBytes;
}

/// The buffer has the length that the JSON says.
bool isWholeGltf(const std::string& path, uint64_t bufferBytes) {
    std::ifstream file(path);
    const nlohmann::json document = nlohmann::json::parse(file, nullptr, false);
    if (!document.is_object() || !document.contains("asset")) return false;
    const nlohmann::json buffers = document.value("buffers", nlohmann::json::array());
    if (!buffers.is_array() || buffers.size() > 1) return false;
    return buffers.empty() || buffers[0].value("byteLength", uint64_t{0}) == bufferBytes;
}

}  // namespace

bool isWholeMesh(const std::string& path) {
    const std::vector<std::string> paths = exportedPaths(path);
    const std::optional<Ends> ends = endsOf(path), beside = endsOf(paths.back());
    if (!ends || !beside || ends->bytes == 0) return false;
    const std::string ending = lowerExtension(path);
    if (ending == ".glb")
        return ends->bytes >= 20 && ends->word(0) == 0x46546C67 && ends->word(8) == ends->bytes;
    if (ending == ".gltf") return isWholeGltf(path, beside->bytes);
    if (ending == ".stl") return ends->bytes >= 84 && ends->bytes == 84 + 50ull * ends->word(80);
    if (ending == ".ply") return isWholePly(*ends);
    if (ending == ".obj") return ends->last.back() == '\n';
    if (ending == ".3mf") return ends->last.find("PK\x05\x06") != std::string::npos;
    return true;
}

}  // namespace fw
