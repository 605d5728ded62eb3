// "Bgeo" version 5: counts, the attributes of points, then for each point four floats of its place and its
// attributes. Numbers are words of 32 bits, the high byte first. What follows, of primitives, is passed over.
// The form is told by partio's reader (wdas/partio, src/lib/io/BGEO.cpp).
#include <bit>
#include <optional>

#include "graph/assets/file_points.h"
#include "graph/assets/triangle_mesh_text.h"
#include "graph/base/file_kind.h"

namespace fw {

namespace {

struct BgeoFault {
    std::string what;
};
[[noreturn]] void failBgeo(const std::string& what) { throw BgeoFault{what}; }

class BgeoReader {
  public:
    explicit BgeoReader(std::string_view bytes) : scanner{bytes} {}

    FilePoints run() {
        if (scanner.rest.starts_with("\x1f\x8b")) failBgeo("is compressed: write it without that");
        if (scanner.rest.starts_with("\x7fNSJ"))
            failBgeo("is of Houdini's newer form: write .bgeo as partio does (.bhclassic), or .ply");
        if (!scanner.rest.starts_with("BgeoV")) failBgeo("is no geometry of Houdini");
        scanner.rest.remove_prefix(5);
        if (const uint32_t version = word(); version != 5)
            failBgeo("is of version " + std::to_string(version) + ": write version 5");
        const uint32_t count = word();
        for (int i = 0; i < 3; ++i) word();  // primitives and groups
        const uint32_t attributes = word();
        for (int i = 0; i < 3; ++i) word();  // attributes of all else
        if (count > kMostFileParticles)
            failBgeo("has " + std::to_string(count) + " particles: " + std::to_string(kMostFileParticles) +
                     " is the most");
        uint64_t size = 4;
        std::optional<uint64_t> velocity, id;
        for (uint32_t i = 0; i < attributes; ++i) {
            const std::string name = text();
            const uint32_t words = half(), type = word();
            constexpr uint32_t kInteger = 1, kIndexedText = 4, kVector = 5;
            if (type > kVector || type == 2 || type == 3)
                failBgeo("has an attribute of a type that is not read");
            if (type == kIndexedText) {
                const uint32_t texts = word();
                for (uint32_t k = 0; k < texts; ++k) text();
            } else {
                for (uint32_t k = 0; k < words; ++k) word();  // by default
            }
            if (namesVelocity(name) && type != kInteger && type != kIndexedText && words == 3)
                velocity = size;
            if (namesId(name) && type == kInteger && words == 1) id = size;
            size += words;
        }
        if (4 * size * count > scanner.rest.size()) failBgeo("is cut off: copy it again");
        FilePoints points;
        for (uint32_t i = 0; i < count; ++i) {
            const std::string_view bytes = scanner.rest.substr(4 * size * i, 4 * size);
            points.places.push_back(vectorAt(bytes, 0));
            if (velocity) points.velocities.push_back(vectorAt(bytes, *velocity));
            if (id) points.ids.push_back(wordAt(bytes, *id));
        }
        return points;
    }

  private:
    static uint32_t wordAt(std::string_view bytes, uint64_t at) {
        uint32_t made = 0;
        for (std::size_t k = 0; k < 4; ++k) made = made << 8 | static_cast<unsigned char>(bytes[4 * at + k]);
        return made;
    }
    static glm::vec3 vectorAt(std::string_view bytes, uint64_t at) {
        glm::vec3 made;
        for (int k = 0; k < 3; ++k) made[k] = std::bit_cast<float>(wordAt(bytes, at + uint64_t(k)));
        return made;
    }
    void need(std::size_t bytes) const {
        if (scanner.rest.size() < bytes) failBgeo("is cut off: copy it again");
    }
    uint32_t word() {
        need(4);
        const uint32_t made = wordAt(scanner.rest, 0);
        scanner.rest.remove_prefix(4);
        return made;
    }
    uint32_t half() {
        need(2);
        const auto high = static_cast<unsigned char>(scanner.rest[0]),
                   low = static_cast<unsigned char>(scanner.rest[1]);
        scanner.rest.remove_prefix(2);
        return uint32_t(high) << 8 | low;
    }
    std::string text() {
        const uint32_t length = half();
        need(length);
        std::string made(scanner.rest.substr(0, length));
        scanner.rest.remove_prefix(length);
        return made;
    }

    Scanner scanner;
};

}  // namespace

Result<FilePoints> readBgeoPoints(std::string_view bytes, const std::string& path) {
    try {
        return BgeoReader(bytes).run();
    } catch (const BgeoFault& fault) { return fileProblem(path, kParticleFile, fault.what); }
}

}  // namespace fw
