#include "graph/implicit3mf/sheets.h"

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <algorithm>

#include "graph/assets/image.h"
#include "graph/base/words.h"

namespace fw::threemf {

namespace {

using Pixels = std::vector<uint16_t>;  // red, green, blue, alpha; 0 to 65535

struct Sheet {
    int width = 0, height = 0;
    bool fine = false;
    Pixels pixels = {};
};

Result<Sheet> decoded(const std::string& bytes, const std::string& name) {
    const auto problem = [&](const std::string& what) {
        return Error{.message = "the sheet " + inQuotes(name) + " " + what};
    };
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int length = static_cast<int>(bytes.size());
    Sheet sheet;
    int channels = 0;
    if (!bytes.starts_with("\x89PNG\r\n\x1A\n") ||
        !stbi_info_from_memory(data, length, &sheet.width, &sheet.height, &channels))
        return problem("is no PNG picture, or a damaged one");
    if (std::max(sheet.width, sheet.height) > kMaxImageSide)
        return problem("is larger than " + std::to_string(kMaxImageSide) + " pixels along a side");
    sheet.fine = stbi_is_16_bit_from_memory(data, length) != 0;
    const std::unique_ptr<stbi_us, void (*)(void*)> pixels(
        stbi_load_16_from_memory(data, length, &sheet.width, &sheet.height, &channels, 4), stbi_image_free);
    if (!pixels) return problem("is damaged or cut off");
    sheet.pixels.assign(pixels.get(),
                        pixels.get() + 4 * std::size_t(sheet.width) * std::size_t(sheet.height));
    return sheet;
}

void appendTo(void* text, void* data, int size) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(data), std::size_t(size));
}

/// The tiles of one channel; its upper bytes, or its lower ones.
std::string tiled(const std::vector<Sheet>& all, const Sheets& sheets, int channel, bool lower) {
    const int wide = sheets.width + 2 * sheets.border, high = sheets.height + 2 * sheets.border;
    const int rows = (sheets.count + sheets.columns - 1) / sheets.columns;
    const int across = sheets.columns * wide, up = rows * high;
    std::vector<unsigned char> grey(std::size_t(across) * std::size_t(up));
    for (int k = 0; k < sheets.count; ++k)
        for (int y = 0; y < high; ++y)
            for (int x = 0; x < wide; ++x) {
                const int column = (x - sheets.border + sheets.width) % sheets.width,
                          row = (y - sheets.border + sheets.height) % sheets.height;
                const std::size_t at = std::size_t(row) * std::size_t(sheets.width) + std::size_t(column);
                const uint16_t value = all[std::size_t(k)].pixels[4 * at + std::size_t(channel)];
                // Tiles stand one above the other as v grows: a picture begins with its highest row.
                const int left = k % sheets.columns * wide, top = (rows - 1 - k / sheets.columns) * high;
                grey[std::size_t(top + y) * std::size_t(across) + std::size_t(left + x)] =
                    static_cast<unsigned char>(lower ? value & 255 : value >> 8);
            }
    std::string bytes;
    stbi_write_png_to_func(appendTo, &bytes, across, up, 1, grey.data(), across);
    return bytes;
}

/// A coordinate as its tile style has it; `n` texels along it, of tiles with a border `bordered`.
std::string tiledCode(const std::string& s, TileStyle style, bool nearest, bool bordered, int n, bool falls) {
    const std::string size = std::to_string(n) + ".0", half = shortNumber(0.5) + " / " + size;
    std::string code;
    if (style == TileStyle::mirror) code += s + " = 1.0 - abs(mod(" + s + ", 2.0) - 1.0);\n";
    if (style == TileStyle::wrap && bordered) code += s + " = fract(" + s + ");\n";
    if (nearest)  // in the middle between two texels the one of the lower index, and rows are counted
                  // downwards
        code += s + (falls ? " = (floor(" + s + " * " + size + ") + 0.5) / " + size + ";\n"
                           : " = (ceil(" + s + " * " + size + ") - 0.5) / " + size + ";\n");
    if (style != TileStyle::wrap) code += s + " = clamp(" + s + ", " + half + ", 1.0 - " + half + ");\n";
    return code;
}

}  // namespace

Result<Sheets> readSheets(const Package& package, const ImageStack& stack) {
    const std::string whose = "the image3d " + std::to_string(stack.id);
    std::vector<Sheet> all;
    Sheets sheets;
    sheets.count = int(stack.sheets.size());
    for (const std::string& name : stack.sheets) {
        const Result<std::string> bytes = package.part(name, kMostSheetBytes);
        if (!bytes) return bytes.error();
        Result<Sheet> sheet = decoded(*bytes, name);
        if (!sheet) return sheet.error();
        if (!all.empty() && (sheet->width != all[0].width || sheet->height != all[0].height))
            return Error{.message = "the sheets of " + whose + " are not of one size"};
        sheets.fine |= sheet->fine;
        if ((all.size() + 1) * sheet->pixels.size() > kMaxImageBytes / sizeof(uint32_t))
            return Error{.message = whose + " has more than " +
                                    std::to_string(kMaxImageBytes / sizeof(uint32_t) / 4 / 1'000'000) +
                                    " million voxels: write it with fewer"};
        all.push_back(std::move(*sheet));
    }
    sheets.width = all[0].width, sheets.height = all[0].height;
    if (sheets.width != stack.columns || sheets.height != stack.rows)
        sheets.remarks.push_back(whose + " says " + std::to_string(stack.columns) + " x " +
                                 std::to_string(stack.rows) + " pixels, and its sheets have " +
                                 std::to_string(sheets.width) + " x " + std::to_string(sheets.height) +
                                 ": these are taken");
    sheets.border = sheets.count > 1 ? 1 : 0;
    const int wide = sheets.width + 2 * sheets.border, high = sheets.height + 2 * sheets.border;
    const int inColumn = std::max(1, kMaxImageSide / high);
    sheets.columns = (sheets.count + inColumn - 1) / inColumn;
    if (sheets.columns * wide > kMaxImageSide)
        return Error{.message = whose + " is too large to be a picture of " + std::to_string(kMaxImageSide) +
                                " pixels a side: write it with fewer voxels"};

    const auto alike = [&](int a, int b) {
        return std::ranges::all_of(all, [&](const Sheet& sheet) {
            for (std::size_t i = 0; i < sheet.pixels.size(); i += 4)
                if (sheet.pixels[i + std::size_t(a)] != sheet.pixels[i + std::size_t(b)]) return false;
            return true;
        });
    };
    const bool opaque = std::ranges::all_of(all, [](const Sheet& sheet) {
        for (std::size_t i = 3; i < sheet.pixels.size(); i += 4)
            if (sheet.pixels[i] != 65535) return false;
        return true;
    });
    const char* const names[] = {"red", "green", "blue", "alpha"};
    const bool grey = alike(0, 1) && alike(0, 2);
    int made = 0;
    for (int channel = 0; channel < 4; ++channel) {
        if (channel == 3 ? opaque : grey && channel > 0) {
            sheets.channels[std::size_t(channel)] = channel == 3 ? -1 : 0;
            continue;
        }
        sheets.channels[std::size_t(channel)] = made++;
        const std::string name = grey && channel == 0 ? "grey" : names[channel];
        sheets.pictures.push_back({name, tiled(all, sheets, channel, false)});
        if (sheets.fine) sheets.pictures.push_back({name + "_fine", tiled(all, sheets, channel, true)});
    }
    return sheets;
}

std::string sheetCode(const Sheets& sheets, const ImageFunction& function) {
    const bool bordered = sheets.border > 0;
    std::string code = "float u = place.x;\nfloat v = place.y;\n";
    code += tiledCode("u", function.tiles[0], function.nearest, bordered, sheets.width, false);
    code += tiledCode("v", function.tiles[1], function.nearest, bordered, sheets.height, true);
    const std::string stored =
        sheets.fine ? "(65280.0 * image_grey(image, at) + 255.0 * image_grey(fine, at)) / 65535.0"
                    : "image_grey(image, at)";
    std::string value;
    if (sheets.count == 1) {
        code += "vec2 at = vec2(u, v);\n";
        value = stored;
    } else {
        const int rows = (sheets.count + sheets.columns - 1) / sheets.columns;
        const auto text = [](int n) { return std::to_string(n) + ".0"; };
        const std::string n = text(sheets.count), columns = text(sheets.columns);
        const std::string wide = text(sheets.width + 2), high = text(sheets.height + 2);
        std::string sheet;
        switch (function.tiles[2]) {
            case TileStyle::wrap: sheet = "mod(k, " + n + ")"; break;
            case TileStyle::clamp: sheet = "clamp(k, 0.0, " + n + " - 1.0)"; break;
            case TileStyle::mirror: sheet = n + " - 0.5 - abs(mod(k, 2.0 * " + n + ") - " + n + " + 0.5)";
        }
        code = "float sheet(float k, float u, float v) {\n    k = " + sheet +
               ";\n    vec2 at = vec2((mod(k, " + columns + ") * " + wide + " + 1.0 + u * " +
               text(sheets.width) + ") / (" + columns + " * " + wide + "), (floor(k / " + columns + ") * " +
               high + " + 1.0 + v * " + text(sheets.height) + ") / (" + text(rows) + " * " + high +
               "));\n    return " + stored + ";\n}\n" + code;
        if (function.nearest) {
            value = "sheet(ceil(place.z * " + n + ") - 1.0, u, v)";
        } else {
            code += "float w = place.z * " + n + " - 0.5;\nfloat k = floor(w);\n";
            value = "mix(sheet(k, u, v), sheet(k + 1.0, u, v), w - k)";
        }
    }
    const auto number = [](double x) { return exactNumber(x); };
    if (function.scale != 1.0) value = number(function.scale) + " * (" + value + ")";
    if (function.offset != 0.0) value = number(function.offset) + " + " + value;
    return code + "return " + value + ";";
}

}  // namespace fw::threemf
