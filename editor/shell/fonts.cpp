#include "editor/shell/fonts.h"

#include <imgui_freetype.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "editor/shell/letters.h"
#include "graph/base/own_files.h"

namespace fw::editor {

namespace {

constexpr float kSizes[] = {7, 8, 9, 10, 11, 12, 13, kFontSize, 17, 21, 28, 40};  // pixels at scale 1
constexpr float kLargest = 64;  // pixels; larger text is scaled up, which costs less than its atlas

// What an interface writes: Latin, Greek letters for maths, and the signs of menus and of nodes.
constexpr ImWchar kGlyphs[] = {
    0x0020, 0x017f,  // Latin, with supplement and extension A
    0x0391, 0x03c9,  // Greek
    0x2010, 0x2027,  // dashes, quotes, bullets, the ellipsis
    0x2030, 0x203a,  // per mille, primes, angle quotes
    0x2070, 0x2094,  // raised and lowered numbers
    0x2190, 0x2199,  // arrows
    0x21ba, 0x21bb,  // turning arrows
    0x21d2, 0x21d5,  // double arrows
    0x2200, 0x2212,  // signs of logic, sums, minus
    0x2218, 0x221e,  // ring, dot, root, infinity
    0x2227, 0x222b,  // and, or, sections, integral
    0x2248, 0x2248,  // about
    0x2260, 0x2265,  // not equal, at most, at least
    0x2318, 0x2318,  // the place of interest
    0x25a0, 0x25ff,  // squares, triangles, diamonds, circles
    0x2605, 0x2606,  // stars
    0x2630, 0x2630,  // the menu's three bars
    0x2660, 0x2667,  // suits
    0x2699, 0x2699,  // a gear
    0x26a0, 0x26a0,  // the warning sign
    0x2713, 0x2718,  // ticks and crosses
    0x279c, 0x279c,  // a heavy arrow
    0xfffd, 0xfffd,  // what is no letter, or of no font here
    0,
};

constexpr const char* kFolders[] = {
    "/usr/share/fonts/truetype/dejavu",    // Debian, Ubuntu
    "/usr/share/fonts/TTF",                // Arch
    "/usr/share/fonts/dejavu",             // SUSE
    "/usr/share/fonts/dejavu-sans-fonts",  // Fedora, and the next
    "/usr/share/fonts/dejavu-sans-mono-fonts",
};

// For letters that DejaVu lacks, those of China, Japan and Korea above all: the first that is installed.
constexpr const char* kOtherFonts[] = {
    "/usr/share/fonts-droid-fallback/truetype/DroidSansFallbackFull.ttf",  // Debian: fonts-droid-fallback
    "/usr/share/fonts-droid-fallback/truetype/DroidSansFallback.ttf",
    "/usr/share/fonts/truetype/droid/DroidSansFallbackFull.ttf",
    "/usr/share/fonts/google-droid-sans-fonts/DroidSansFallbackFull.ttf",  // Fedora
    "/usr/share/fonts/droid/DroidSansFallbackFull.ttf",                    // Arch
    "/usr/share/fonts/truetype/wqy/wqy-microhei.ttc",
};

/// Besides kGlyphs: what texts have asked for, which only grows.
struct Asked {
    std::set<ImWchar> letters;
    bool fresh = false;  ///< since fonts were baked
};
Asked& asked() {
    static Asked all;
    return all;
}

bool usual(char32_t letter) {
    for (const ImWchar* range = kGlyphs; *range; range += 2)
        if (letter >= range[0] && letter <= range[1]) return true;
    return false;
}

/// As ImGui has ranges; it lives until the next call. ImGui reads it while the atlas is built.
const ImWchar* askedRanges() {
    static std::vector<ImWchar> ranges;
    ranges.clear();
    for (const ImWchar letter : asked().letters) ranges.insert(ranges.end(), {letter, letter});
    ranges.push_back(0);
    return ranges.data();
}

const char* otherFont() {
    std::error_code none;
    for (const char* path : kOtherFonts)
        if (std::filesystem::is_regular_file(path, none)) return path;
    return nullptr;
}

/// The file's path; empty where it is not installed.
std::string installed(const std::string& name) {
    std::error_code none;
    if (const std::filesystem::path own = ownFolder("fonts", name.c_str()); !own.empty())
        return (own / name).string();
    for (const char* folder : kFolders) {
        const std::filesystem::path path = std::filesystem::path(folder) / name;
        if (std::filesystem::is_regular_file(path, none)) return path.string();
    }
    return {};
}

ImFont* nearest(const std::vector<ImFont*>& fonts, float pixels) {
    // By ratio: what is drawn too large suffers as much as what is drawn too small.
    const auto distance = [&](const ImFont* font) { return std::abs(std::log(font->FontSize / pixels)); };
    return *std::ranges::min_element(fonts, {}, distance);
}

}  // namespace

ImFont* Fonts::of(float pixels) const { return nearest(text, pixels); }
float Fonts::crisp(float pixels) const {
    constexpr float kNear = 1.08f;
    const float baked = of(pixels)->FontSize;
    return std::max(baked, pixels) < kNear * std::min(baked, pixels) ? baked : pixels;
}
void wantGlyphs(std::string_view text) {
    while (!text.empty()) {
        const char32_t letter = takeLetter(text);
        if (letter < 0x80 || letter > IM_UNICODE_CODEPOINT_MAX || usual(letter)) continue;
        if (asked().letters.insert(ImWchar(letter)).second) asked().fresh = true;
    }
}
bool glyphsAreWanted() { return asked().fresh; }

ImFont* Fonts::codeOf(float pixels) const { return nearest(code, pixels); }

Fonts readFonts(ImFontAtlas& atlas, float scale) {
    atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    atlas.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
    atlas.TexDesiredWidth = 2048;
    Fonts fonts;
    asked().fresh = false;
    const bool more = !asked().letters.empty();
    const ImWchar* const ranges = askedRanges();
    const char* const other = more ? otherFont() : nullptr;
    const std::string text = installed("DejaVuSans.ttf"), code = installed("DejaVuSansMono.ttf");
    const auto bake = [&](const std::string& path, float pixels) {
        ImFontConfig config;
        config.SizePixels = pixels;
        ImFont* font =
            path.empty() ? nullptr : atlas.AddFontFromFileTTF(path.c_str(), pixels, &config, kGlyphs);
        if (!font) font = atlas.AddFontDefault(&config);
        // What was asked for, from the first font that has it.
        ImFontConfig merged = config;
        merged.MergeMode = true;
        if (more && !path.empty()) atlas.AddFontFromFileTTF(path.c_str(), pixels, &merged, ranges);
        if (other) atlas.AddFontFromFileTTF(other, pixels, &merged, ranges);
        return font;
    };
    float before = 0;
    for (float size : kSizes) {
        const float pixels = std::round(std::min(size * scale, kLargest));
        if (std::exchange(before, pixels) == pixels) continue;
        fonts.text.push_back(bake(text, pixels));
        fonts.code.push_back(bake(code, pixels));
    }
    if (text.empty() || code.empty())
        fonts.missing =
            "the fonts DejaVu Sans and DejaVu Sans Mono are not installed (Debian: fonts-dejavu-core): "
            "text is coarser than it should be, and some signs are missing";
    return fonts;
}

void bakeFonts(ImFontAtlas& atlas) {
    atlas.Build();
    atlas.ClearInputData();  // the files, each as often as there are sizes
}

}  // namespace fw::editor
