#include "runtime/window/overlay.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

namespace fw {

namespace {

constexpr int kMargin = 8;  // pixels

/// Pixels of a point of the font.
int scaleFor(const Picture& picture) { return picture.width < 600 ? 1 : 2; }

struct Tint {
    uint8_t red, green, blue;
    double strength;  ///< 0 leaves the picture as it is, 1 covers it
};
constexpr Tint kShade{18, 20, 24, 0.72}, kInk{240, 240, 236, 1.0}, kTrack{150, 155, 165, 0.8},
    kPlayed{245, 165, 60, 1.0};

/// Blends a tint over the rectangle's pixels that lie in the picture.
void fillRectangle(Picture& picture, int left, int top, int right, int bottom, const Tint& tint) {
    left = std::max(left, 0), top = std::max(top, 0);
    right = std::min(right, picture.width), bottom = std::min(bottom, picture.height);
    const auto blend = [&](uint8_t& to, uint8_t from) {
        to = static_cast<uint8_t>(to + tint.strength * (from - to) + 0.5);
    };
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
            uint8_t* pixel =
                picture.pixels.data() + 4 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
            blend(pixel[0], tint.red), blend(pixel[1], tint.green), blend(pixel[2], tint.blue);
            blend(pixel[3], 255);
        }
}

struct FontVertex {
    float x, y, z;
    uint8_t color[4];
};

void drawText(Picture& picture, int x, int y, std::string_view text) {
    std::string words(text);  // the font's interface takes text that it may change
    std::vector<FontVertex> corners(words.size() * 64 + 64);
    const int quads = stb_easy_font_print(0, 0, words.data(), nullptr, corners.data(),
                                          static_cast<int>(corners.size() * sizeof(FontVertex)));
    const int scale = scaleFor(picture);
    for (int i = 0; i < quads; ++i) {
        const FontVertex &lo = corners[std::size_t(4 * i)], &hi = corners[std::size_t(4 * i + 2)];
        fillRectangle(picture, x + int(lo.x) * scale, y + int(lo.y) * scale, x + int(hi.x) * scale,
                      y + int(hi.y) * scale, kInk);
    }
}

std::pair<int, int> sizeOf(std::string_view text, int scale) {
    std::string words(text);
    return {scale * stb_easy_font_width(words.data()), scale * stb_easy_font_height(words.data())};
}

}  // namespace

int drawPanel(Picture& picture, int x, int y, const std::vector<std::string>& columns) {
    int width = kMargin, height = 0;
    for (const std::string& column : columns) {
        const auto [columnWidth, columnHeight] = sizeOf(column, scaleFor(picture));
        width += columnWidth + kMargin;
        height = std::max(height, columnHeight);
    }
    const int bottom = y + height + kMargin;
    fillRectangle(picture, x, y, x + width, bottom, kShade);
    int left = x + kMargin;
    for (const std::string& column : columns) {
        drawText(picture, left, y + kMargin, column);
        left += sizeOf(column, scaleFor(picture)).first + kMargin;
    }
    return bottom;
}

void drawOverlay(Picture& picture, const Viewer& viewer, std::string_view message) {
    if (const int bar = viewer.barHeight(); bar > 0 && picture.height > bar) {
        const int top = picture.height - bar, middle = top + bar / 2;
        const double part = viewer.length > 0.0 ? viewer.shownTime() / viewer.length : 0.0;
        const int at = static_cast<int>(part * picture.width);
        fillRectangle(picture, 0, top, picture.width, picture.height, kShade);
        fillRectangle(picture, 0, middle - 2, picture.width, middle + 2, kTrack);
        fillRectangle(picture, 0, middle - 2, at, middle + 2, kPlayed);
        fillRectangle(picture, at - 3, top + 4, at + 3, picture.height - 4, kPlayed);
        char text[64];
        std::snprintf(text, sizeof text, "%.2f / %.2f s%s", viewer.shownTime(), viewer.length,
                      viewer.paused ? "  paused" : "");
        drawPanel(picture, kMargin, top - 32, {text});
    }
    int y = kMargin;
    if (viewer.help) {
        std::string keys, does;
        for (const KeyHelp& help : viewerKeys()) {
            keys += (keys.empty() ? "" : "\n") + std::string(help.key);
            does += (does.empty() ? "" : "\n") + std::string(help.does);
        }
        y = drawPanel(picture, kMargin, y, {keys, does}) + kMargin;
    }
    if (message.empty()) return;
    std::string lines;
    const std::size_t width =
        std::max<std::size_t>(std::size_t(picture.width) / std::size_t(7 * scaleFor(picture)), 20);
    for (std::size_t i = 0; i < message.size() && i < 6 * width; i += width)
        lines += (lines.empty() ? "" : "\n") + std::string(message.substr(i, width));
    drawPanel(picture, kMargin, y, {lines});
}

}  // namespace fw
