#include "graph/assets/environment.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIO.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <cstring>

#include "graph/assets/image.h"
#include "graph/base/asset_file.h"

namespace fw {

namespace {

Error mapProblem(const std::string& path, const std::string& what) {
    return fileProblem(path, kEnvironmentFile, what);
}

Error damaged(const std::string& path) {
    return mapProblem(path, "is damaged or cut off: save or copy it again");
}

Done checkSize(const std::string& path, int64_t width, int64_t height, int64_t side) {
    const int64_t half = side / 2;
    if (std::max(width, height) <= side && width * height <= side * half) return done();
    return mapProblem(path, "has " + std::to_string(width) + " x " + std::to_string(height) +
                                " pixels: at most " + std::to_string(side) + " x " + std::to_string(half) +
                                " can be used, so scale it down");
}

/// An OpenEXR file in memory.
class MemoryStream : public Imf::IStream {
  public:
    explicit MemoryStream(const std::string& bytes_) : IStream("memory"), bytes(bytes_) {}
    bool read(char to[], int count) override {
        const std::size_t size = std::size_t(count);
        if (size > bytes.size() - at) throw std::runtime_error("the file is too short");
        std::memcpy(to, bytes.data() + at, size);
        at += size;
        return at < bytes.size();
    }
    uint64_t tellg() override { return at; }
    void seekg(uint64_t place) override { at = std::min<std::size_t>(place, bytes.size()); }

  private:
    const std::string& bytes;
    std::size_t at = 0;
};

Result<EnvironmentMap> decodeExr(const std::string& bytes, const std::string& path, int mostSide) {
    try {
        MemoryStream stream(bytes);
        Imf::InputFile file(stream, 0);
        const Imath::Box2i window = file.header().dataWindow();
        const int64_t width = int64_t(window.max.x) - window.min.x + 1,
                      height = int64_t(window.max.y) - window.min.y + 1;
        if (const Done fits = checkSize(path, width, height, mostSide); !fits) return fits.error();
        if (!file.isComplete()) return damaged(path);
        const Imf::ChannelList& channels = file.header().channels();
        const bool colored =
            channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
        if (!colored && !channels.findChannel("Y"))
            return mapProblem(path, "has no channels R, G and B: save it with them");
        EnvironmentMap map{int(width), int(height), std::vector<Radiance>(std::size_t(width * height))};
        Imf::FrameBuffer pixels;
        for (std::size_t k = 0; k < 3; ++k) {
            // The library counts from the picture's origin, which may lie outside.
            auto* origin = reinterpret_cast<char*>(&map.texels[0][k]) -
                           std::ptrdiff_t(sizeof(Radiance)) * (window.min.x + window.min.y * width);
            pixels.insert(std::string(1, "RGB"[k]), Imf::Slice(Imf::FLOAT, origin, sizeof(Radiance),
                                                               sizeof(Radiance) * std::size_t(width)));
        }
        if (!colored) pixels.insert("Y", *pixels.findSlice("R"));
        file.setFrameBuffer(pixels);
        file.readPixels(window.min.y, window.max.y);
        for (Radiance& texel : map.texels)
            if (!colored) texel = {texel[0], texel[0], texel[0]};
        return map;
    } catch (const std::bad_alloc&) { throw; } catch (const std::exception&) {
        return damaged(path);
    }
}

/// Whether the runs of a picture in Radiance's format are all there: some versions of its reader never come
/// back from a run that is cut off. What is of no runs, or is refused anyway, passes.
bool hasAllRuns(const std::string& bytes, int width, int height) {
    if (width < 8 || width >= 32768) return true;
    const std::size_t size = bytes.size();
    std::size_t at = 0;
    // The header ends with a line that is empty, or is for who reads it as text; one with the size follows.
    for (bool last = false, ended = false; !last && at < size;) {
        last = ended;
        ended = ended || bytes[at] == '\n' || bytes[at] == '\0';
        at = std::min(bytes.find('\n', at), size - 1) + 1;
    }
    for (int y = 0; y < height; ++y) {
        if (size - at < 4) return false;
        const auto byte = [&](std::size_t place) { return int(uint8_t(bytes[place])); };
        if (byte(at) != 2 || byte(at + 1) != 2 || (byte(at + 2) << 8 | byte(at + 3)) != width) return true;
        at += 4;
        for (int channel = 0; channel < 4; ++channel)
            for (int left = width; left > 0;) {
                if (at >= size) return false;
                const int code = byte(at++), count = code > 128 ? code - 128 : code;
                const std::size_t values = code > 128 ? 1 : std::size_t(count);
                if (count == 0 || count > left || size - at < values) return false;
                at += values, left -= count;
            }
    }
    return true;
}

/// Radiance's format, and pictures of 8 bits.
Result<EnvironmentMap> decodeOther(const std::string& bytes, const std::string& path, int mostSide) {
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int length = int(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, length, &width, &height, &channels) || width < 1 || height < 1)
        return mapProblem(path, "is of no format that is read, or damaged: use " + anyOf(kEnvironmentFile));
    if (const Done fits = checkSize(path, width, height, mostSide); !fits) return fits.error();
    EnvironmentMap map{width, height, std::vector<Radiance>(std::size_t(width) * std::size_t(height))};
    const auto take = [&](const auto* pixels, const auto& radiance) {
        for (std::size_t i = 0; i < 3 * map.texels.size(); ++i)
            map.texels[i / 3][i % 3] = radiance(pixels[i]);
    };
    if (stbi_is_hdr_from_memory(data, length)) {
        if (!hasAllRuns(bytes, width, height)) return damaged(path);
        const std::unique_ptr<float, void (*)(void*)> pixels(
            stbi_loadf_from_memory(data, length, &width, &height, &channels, 3), stbi_image_free);
        if (!pixels) return damaged(path);
        take(pixels.get(), [](float value) { return value; });
    } else {
        const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
            stbi_load_from_memory(data, length, &width, &height, &channels, 3), stbi_image_free);
        if (!pixels) return damaged(path);
        take(pixels.get(), [](int byte) { return float(linearOfByte(byte)); });
    }
    return map;
}

}  // namespace

EnvironmentMap halved(const EnvironmentMap& map) {
    const int across = map.width > 1 ? 2 : 1, down = map.height > 1 ? 2 : 1;
    EnvironmentMap half{map.width / across, map.height / down, {}, map.file};
    half.texels.resize(std::size_t(half.width) * std::size_t(half.height));
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x)
            for (int i = 0; i < across * down; ++i) {
                const Radiance& from =
                    map.texels[std::size_t(y * down + i / across) * std::size_t(map.width) +
                               std::size_t(x * across + i % across)];
                Radiance& to = half.texels[std::size_t(y) * std::size_t(half.width) + std::size_t(x)];
                for (std::size_t k = 0; k < 3; ++k) to[k] += from[k] / float(across * down);
            }
    return half;
}

Result<EnvironmentMap> parseEnvironment(const std::string& bytes, const std::string& path, int mostSide) {
    if (bytes.empty()) return mapProblem(path, "is an empty file");
    Result<EnvironmentMap> map = bytes.starts_with("\x76\x2f\x31\x01") ? decodeExr(bytes, path, mostSide)
                                                                       : decodeOther(bytes, path, mostSide);
    if (!map) return map;
    for (Radiance& texel : map->texels)
        for (float& value : texel) value = value > 0.0f ? std::min(value, kMostRadiance) : 0.0f;
    while (map->width > kMostEnvironmentWidth || map->height > kMostEnvironmentWidth) *map = halved(*map);
    return map;
}

Result<EnvironmentMapPtr> readEnvironment(const std::string& graphPath, const std::string& path) {
    return readAsset<EnvironmentMap>(
        graphPath, path, kEnvironmentFile,
        [&](const std::string& bytes, const std::string& file) -> Result<EnvironmentMapPtr> {
            Result<EnvironmentMap> map = parseEnvironment(bytes, path);
            if (!map) return map.error();
            map->file = file;
            return std::make_shared<const EnvironmentMap>(std::move(*map));
        });
}

}  // namespace fw
