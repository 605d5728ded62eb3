#include "runtime/render/light_picture.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>

#include "runtime/system/output_file.h"

namespace fw {

namespace {

class Stream : public Imf::OStream {
  public:
    Stream(OutputFile& file_, const std::string& path) : OStream(path.c_str()), file(file_) {}
    void write(const char bytes[], int count) override { file.write(bytes, std::size_t(count)); }
    uint64_t tellp() override { return file.position(); }
    void seekp(uint64_t place) override { file.goTo(place); }

  private:
    OutputFile& file;
};

struct Channel {
    const char* name;
    Imf::PixelType type;
    const void* first;
    std::size_t stride;  // from pixel to pixel, bytes
};

}  // namespace

Done saveLight(const LightPicture& picture, const std::string& path, const std::function<void()>& kept) {
    Result<OutputFile> file = OutputFile::open(path, nullptr);
    if (!file) return file.error();
    const float *color = picture.color.data(), *normal = &picture.normal[0].x;
    const Channel channels[] = {{"R", Imf::FLOAT, color, 16},
                                {"G", Imf::FLOAT, color + 1, 16},
                                {"B", Imf::FLOAT, color + 2, 16},
                                {"A", Imf::FLOAT, color + 3, 16},
                                {"Z", Imf::FLOAT, picture.depth.data(), 4},
                                {"N.X", Imf::FLOAT, normal, 12},
                                {"N.Y", Imf::FLOAT, normal + 1, 12},
                                {"N.Z", Imf::FLOAT, normal + 2, 12},
                                {"id", Imf::UINT, picture.id.data(), 4}};
    Imf::Header header(picture.width, picture.height);
    Imf::FrameBuffer pixels;
    for (const Channel& channel : channels) {
        header.channels().insert(channel.name, Imf::Channel(channel.type));
        auto* first = static_cast<char*>(const_cast<void*>(channel.first));  // which is only read
        pixels.insert(channel.name,
                      Imf::Slice(channel.type, first, channel.stride, channel.stride * picture.width));
    }
    {
        Stream stream(*file, path);
        Imf::OutputFile exr(stream, header);
        exr.setFrameBuffer(pixels);
        exr.writePixels(picture.height);
    }
    return file->commit(kept);
}

std::optional<std::pair<int, int>> sizeOfLight(const std::string& path) {
    try {
        Imf::InputFile file(path.c_str());
        if (!file.isComplete()) return std::nullopt;
        const Imath::Box2i window = file.header().dataWindow();
        const std::pair size(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
        // What was cut off lacks its last line.
        std::vector<float> line(std::size_t(size.first));
        Imf::FrameBuffer last;
        last.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(line.data() - window.min.x), 4, 0));
        file.setFrameBuffer(last);
        file.readPixels(window.max.y);
        return size;
    } catch (const std::exception&) { return std::nullopt; }
}

}  // namespace fw
