#include "runtime/measure/read_back.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "runtime/measure/readers.h"
#include "runtime/system/large_pages.h"
#include "runtime/system/output_file.h"

namespace fw {
namespace {

uint64_t hashOf(glm::vec3 p) {
    const auto x = std::bit_cast<uint32_t>(p.x), y = std::bit_cast<uint32_t>(p.y),
               z = std::bit_cast<uint32_t>(p.z);
    uint64_t h = (uint64_t{x} << 32 | y) * 0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 29) ^ z) * 0xBF58476D1CE4E5B9u;
    return h ^ (h >> 32);
}

}  // namespace

Welder::Welder(std::size_t expected) : slots(std::bit_ceil(expected * 2 + 16), 0) {
    positions.reserve(expected);
}

uint32_t Welder::add(glm::vec3 position) {
    position += 0.0f;  // -0 becomes 0, so that equal positions have equal bits
    const std::size_t mask = slots.size() - 1;
    std::size_t at = hashOf(position) & mask;
    while (slots[at] != 0) {
        if (positions[slots[at] - 1] == position) return slots[at] - 1;
        at = (at + 1) & mask;
    }
    positions.push_back(position);
    const auto number = static_cast<uint32_t>(positions.size() - 1);
    slots[at] = number + 1;
    if (positions.size() * 2 > slots.size()) resize(slots.size() * 2);
    return number;
}

void Welder::expect(std::size_t more) {
    positions.reserve(positions.size() + more);
    if (const std::size_t wanted = std::bit_ceil((positions.size() + more) * 2 + 16); wanted > slots.size())
        resize(wanted);
}

void Welder::resize(std::size_t slotCount) {
    std::vector<uint32_t> larger;
    resizeInLargePages(larger, slotCount);
    const std::size_t mask = larger.size() - 1;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        std::size_t at = hashOf(positions[i]) & mask;
        while (larger[at] != 0) at = (at + 1) & mask;
        larger[at] = static_cast<uint32_t>(i + 1);
    }
    slots = std::move(larger);
}

WeldedMesh weld(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
    Welder welder(positions.size());
    std::vector<uint32_t> numbers(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) numbers[i] = welder.add(positions[i]);
    WeldedMesh mesh{welder.take(), std::vector<uint32_t>(indices.size())};
    for (std::size_t i = 0; i < indices.size(); ++i) {
        assert(indices[i] < numbers.size());
        mesh.indices[i] = numbers[indices[i]];
    }
    return mesh;
}

namespace {

Result<WeldedMesh> readStl(const Bytes& bytes, const Fault& fault) {
    constexpr std::size_t kHead = 84, kRecord = 50;
    if (bytes.size() < kHead) return fault("not a binary STL: shorter than its header");
    const auto count = load<uint32_t>(bytes, 80);
    if (bytes.size() - kHead != uint64_t{count} * kRecord)
        return fault("not a binary STL: " + std::to_string(count) +
                     " triangles do not fill the file exactly");
    Welder welder(count / 2 + 8);  // a closed mesh has about half as many vertices as triangles
    WeldedMesh mesh;
    mesh.indices.reserve(std::size_t{count} * 3);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto p = load<glm::vec3>(bytes, kHead + i * kRecord + 12 + k * 12);
            if (!finite(p))
                return fault("triangle " + std::to_string(i) + " has a corner that is not finite");
            mesh.indices.push_back(welder.add(p));
        }
    }
    mesh.positions = welder.take();
    return mesh;
}

/// Collects the polygons of one file: vertices by number, polygons as fans.
struct PolygonReader {
    Welder welder{1024};
    std::vector<uint32_t> numbers;  ///< welded number of each vertex of the file
    WeldedMesh mesh;
    std::vector<uint32_t> polygon;

    void closePolygon() {
        for (std::size_t i = 2; i < polygon.size(); ++i)
            mesh.indices.insert(mesh.indices.end(), {polygon[0], polygon[i - 1], polygon[i]});
        polygon.clear();
    }
    WeldedMesh take() {
        mesh.positions = welder.take();
        return std::move(mesh);
    }
};

/// std::from_chars, but what exceeds the range of float becomes infinite or zero as in any other reader.
std::from_chars_result parseFloat(const char* first, const char* last, float& value) {
    const auto result = std::from_chars(first, last, value);
    if (result.ec != std::errc::result_out_of_range) return result;
    double wide = 0.0;
    const auto again = std::from_chars(first, last, wide);
    value = static_cast<float>(wide);
    return again;
}

Result<WeldedMesh> readObj(const Bytes& bytes, const Fault& fault) {
    PolygonReader reader;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    int lineNumber = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const char *cursor = text.data() + at, *stop = text.data() + end;
        at = end + 1;
        ++lineNumber;
        const auto wrong = [&](const std::string& what) {
            return fault("line " + std::to_string(lineNumber) + ": " + what);
        };
        const auto skipSpace = [&] {
            while (cursor < stop && (*cursor == ' ' || *cursor == '\t' || *cursor == '\r')) ++cursor;
        };
        skipSpace();
        if (stop - cursor < 2 || (cursor[1] != ' ' && cursor[1] != '\t'))
            continue;  // vn, vt, usemtl, comments, ...
        const char key = *cursor++;
        if (key == 'v') {
            glm::vec3 p(0.0f);
            for (int k = 0; k < 3; ++k) {
                skipSpace();
                const auto [rest, code] = parseFloat(cursor, stop, p[k]);
                if (code != std::errc()) return wrong("a vertex needs three numbers");
                cursor = rest;
            }
            if (!finite(p)) return wrong("a coordinate is not finite");
            reader.numbers.push_back(reader.welder.add(p));
        } else if (key == 'f') {
            for (skipSpace(); cursor < stop; skipSpace()) {
                int64_t index = 0;
                const auto [rest, code] = std::from_chars(cursor, stop, index);
                if (code != std::errc()) return wrong("a face needs vertex numbers");
                const auto count = static_cast<int64_t>(reader.numbers.size());
                if (index == 0 || index > count || index < -count)
                    return wrong("a face names a vertex that is not there");
                reader.polygon.push_back(
                    reader.numbers[static_cast<std::size_t>(index > 0 ? index - 1 : count + index)]);
                cursor = rest;
                while (cursor < stop && *cursor != ' ' && *cursor != '\t' && *cursor != '\r')
                    ++cursor;  // "/vt/vn"
            }
            if (reader.polygon.size() < 3) return wrong("a face needs three corners");
            reader.closePolygon();
        }
    }
    return reader.take();
}

struct PlyProperty {
    std::string name;
    std::size_t bytes = 0;       ///< of the value, or of one entry of the list
    std::size_t countBytes = 0;  ///< of a list's count; 0 for a plain value
    bool isFloat = false;
};

struct PlyElement {
    std::string name;
    uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

std::vector<std::string> words(std::string_view line) {
    std::vector<std::string> list;
    for (std::size_t at = 0; at < line.size();) {
        const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
        if (end > at) list.emplace_back(line.substr(at, end - at));
        at = end + 1;
    }
    return list;
}

std::size_t plySize(const std::string& type) {
    if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
    if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
    if (type == "int" || type == "uint" || type == "int32" || type == "uint32") return 4;
    if (type == "float" || type == "float32") return 4;
    if (type == "double" || type == "float64") return 8;
    return 0;
}

/// Unsigned value of 1, 2 or 4 bytes.
uint32_t loadUnsigned(const Bytes& bytes, std::size_t at, std::size_t size) {
    if (size == 1) return load<uint8_t>(bytes, at);
    return size == 2 ? load<uint16_t>(bytes, at) : load<uint32_t>(bytes, at);
}

/// The header's elements; `body` becomes the offset of the first byte after it.
Result<std::vector<PlyElement>> readPlyHeader(const Bytes& bytes, std::size_t& body, const Fault& fault) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::vector<PlyElement> elements;
    bool binary = false;
    std::size_t at = 0;
    for (int line = 1;; ++line) {
        const std::size_t end = text.find('\n', at);
        if (end == std::string_view::npos) return fault("not a PLY: its header does not end");
        const std::vector<std::string> word = words(text.substr(at, end - at));
        at = end + 1;
        const auto wrong = [&](const std::string& what) {
            return fault("line " + std::to_string(line) + ": " + what);
        };
        if (line == 1) {
            if (word.size() != 1 || word[0] != "ply") return fault("not a PLY: it does not start with 'ply'");
        } else if (word.empty() || word[0] == "comment" || word[0] == "obj_info") {
            continue;
        } else if (word[0] == "end_header") {
            break;
        } else if (word[0] == "format" && word.size() == 3) {
            binary = word[1] == "binary_little_endian";
        } else if (word[0] == "element" && word.size() == 3) {
            PlyElement element{word[1], 0, {}};
            const auto [rest, code] =
                std::from_chars(word[2].data(), word[2].data() + word[2].size(), element.count);
            if (code != std::errc() || *rest != 0) return wrong("an element needs a count");
            elements.push_back(std::move(element));
        } else if (word[0] == "property" && !elements.empty() && (word.size() == 3 || word.size() == 5)) {
            PlyProperty property;
            property.name = word.back();
            const std::string& type = word[word.size() - 2];
            property.bytes = plySize(type);
            property.isFloat = type.starts_with("float") || type == "double";
            if (word.size() == 5) {
                property.countBytes = plySize(word[2]);
                if (word[1] != "list" || property.countBytes == 0 || property.countBytes > 4 ||
                    word[2].starts_with("f"))
                    return wrong("a list needs an integer count");
            }
            if (property.bytes == 0) return wrong("unknown type '" + type + "'");
            elements.back().properties.push_back(std::move(property));
        } else {
            return wrong("unknown line in the header");
        }
    }
    if (!binary) return fault("only binary little-endian PLY is read back");
    body = at;
    return elements;
}

Result<WeldedMesh> readPly(const Bytes& bytes, const Fault& fault) {
    std::size_t at = 0;
    const Result<std::vector<PlyElement>> elements = readPlyHeader(bytes, at, fault);
    if (!elements) return elements.error();
    PolygonReader reader;
    const auto room = [&](uint64_t size) { return size <= bytes.size() - at; };
    for (const PlyElement& element : *elements) {
        if (element.properties.empty()) continue;
        if (element.count > bytes.size())
            return fault("truncated: more " + element.name + " records than bytes");
        for (uint64_t i = 0; i < element.count; ++i) {
            glm::vec3 p(std::numeric_limits<float>::quiet_NaN());
            for (const PlyProperty& property : element.properties) {
                if (property.countBytes == 0) {
                    if (!room(property.bytes)) return fault("truncated in the " + element.name + " records");
                    if (property.isFloat && property.name.size() == 1 && property.name[0] >= 'x' &&
                        property.name[0] <= 'z')
                        p[property.name[0] - 'x'] = property.bytes == 4
                                                        ? load<float>(bytes, at)
                                                        : static_cast<float>(load<double>(bytes, at));
                    at += property.bytes;
                    continue;
                }
                if (!room(property.countBytes)) return fault("truncated in the " + element.name + " records");
                const uint32_t count = loadUnsigned(bytes, at, property.countBytes);
                at += property.countBytes;
                if (!room(uint64_t{count} * property.bytes))
                    return fault("truncated in the " + element.name + " records");
                if (element.name == "face" && property.name.starts_with("vertex_ind") && !property.isFloat) {
                    for (uint32_t k = 0; k < count; ++k) {
                        const uint32_t index = loadUnsigned(bytes, at + k * property.bytes, property.bytes);
                        if (index >= reader.numbers.size())
                            return fault("face " + std::to_string(i) + " names a vertex that is not there");
                        reader.polygon.push_back(reader.numbers[index]);
                    }
                    reader.closePolygon();
                }
                at += uint64_t{count} * property.bytes;
            }
            if (element.name == "vertex") {
                if (!finite(p)) return fault("vertex " + std::to_string(i) + " is missing or not finite");
                reader.numbers.push_back(reader.welder.add(p));
            }
        }
    }
    return reader.take();
}

}  // namespace

MappedFile::~MappedFile() {
    if (!content.empty()) ::munmap(const_cast<unsigned char*>(content.data()), content.size());
}

std::string MappedFile::open(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return std::generic_category().message(errno);
    struct stat status {};
    std::string failure;
    if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        failure = "not a regular file";
    } else if (status.st_size > 0) {
        const auto size = static_cast<std::size_t>(status.st_size);
        void* mapped = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
        if (mapped == MAP_FAILED)
            failure = std::generic_category().message(errno);
        else
            content = {static_cast<const unsigned char*>(mapped), size};
    }
    ::close(descriptor);
    return failure;
}

Result<WeldedMesh> readWelded(const StoredMesh& mesh) {
    const Fault fault = [&](std::string what) {
        return Error{.message = std::move(what), .file = mesh.name};
    };
    MappedFile file;
    if (const std::string failure = file.open(mesh.file); !failure.empty())
        return fault("cannot read: " + failure);
    const std::string extension = lowerExtension(mesh.name);
    if (extension == ".stl") return readStl(file.bytes(), fault);
    if (extension == ".obj") return readObj(file.bytes(), fault);
    if (extension == ".ply") return readPly(file.bytes(), fault);
    if (extension == ".glb") return readGlb(file.bytes(), fault);
    if (extension == ".gltf") return readGltf(file.bytes(), mesh, fault);
    if (extension == ".3mf") return read3mf(file.bytes(), fault);
    if (extension == ".vdb") return fault("it holds distances and no triangles");
    return fault("unknown format '" + extension + "'");
}

}  // namespace fw
