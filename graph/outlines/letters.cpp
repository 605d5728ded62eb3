#include "graph/outlines/letters.h"

#include <fontconfig/fontconfig.h>
#include <fribidi.h>
#include <hb-ot.h>
#include <hb.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "graph/base/asset_file.h"
#include "graph/base/own_files.h"
#include "graph/base/words.h"

namespace fw {

namespace {

constexpr double kTextTolerance = 8e-6;         // em
constexpr std::size_t kMostTextArcs = 400'000;  // arcs, before those that are covered go
constexpr std::size_t kKeptFonts = 4;

template <auto free>
struct Freed {
    template <class T>
    void operator()(T* held) const {
        free(held);
    }
};
using Pattern = std::unique_ptr<FcPattern, Freed<FcPatternDestroy>>;
using FontSet = std::unique_ptr<FcFontSet, Freed<FcFontSetDestroy>>;
using Buffer = std::unique_ptr<hb_buffer_t, Freed<hb_buffer_destroy>>;

/// A font in memory; its unit is 1 / unitsPerEm.
struct Font {
    std::string bytes, name;
    std::unique_ptr<hb_face_t, Freed<hb_face_destroy>> face;
    std::unique_ptr<hb_font_t, Freed<hb_font_destroy>> font;
    double em = 1000;
};
using FontPtr = std::shared_ptr<const Font>;

Result<FontPtr> fontFrom(std::string bytes, unsigned index, const std::string& name) {
    auto made = std::make_shared<Font>();
    made->bytes = std::move(bytes);
    made->name = name;
    const std::unique_ptr<hb_blob_t, Freed<hb_blob_destroy>> blob(hb_blob_create(
        made->bytes.data(), unsigned(made->bytes.size()), HB_MEMORY_MODE_READONLY, nullptr, nullptr));
    made->face.reset(hb_face_create(blob.get(), index));
    if (hb_face_get_glyph_count(made->face.get()) == 0)
        return Error{"the font " + inQuotes(name) + " is none, or is damaged"};
    made->em = hb_face_get_upem(made->face.get());
    made->font.reset(hb_font_create(made->face.get()));
    hb_font_make_immutable(made->font.get());
    return FontPtr(std::move(made));
}

std::string wordOf(const Pattern& pattern, const char* property) {
    FcChar8* found = nullptr;
    return pattern && FcPatternGetString(pattern.get(), property, 0, &found) == FcResultMatch
               ? std::string(reinterpret_cast<const char*>(found))
               : std::string();
}

bool isGeneric(std::string_view family) {
    return family == "sans-serif" || family == "serif" || family == "monospace" || family == "sans" ||
           family == "mono";
}

/// Fonts that came with the program join the system's. Where fontconfig has no file that says where those
/// lie, as in a system without a desktop, they lie where they mostly do.
void findFonts() {
    constexpr char kMostly[] =
        "<fontconfig><dir>/usr/share/fonts</dir><dir>/usr/local/share/fonts</dir>"
        "<dir prefix='xdg'>fonts</dir><cachedir prefix='xdg'>fontconfig</cachedir></fontconfig>";
    FcConfig* const plain = FcConfigCreate();
    FcChar8* const file = FcConfigGetFilename(plain, nullptr);  // asked of another it would be a message
    if (!file && FcConfigParseAndLoadFromMemory(plain, reinterpret_cast<const FcChar8*>(kMostly), FcTrue))
        FcConfigSetCurrent(plain);  // and holds on to it
    FcStrFree(file);
    FcConfigDestroy(plain);
    if (const std::filesystem::path own = ownFolder("fonts", "DejaVuSans.ttf"); !own.empty())
        FcConfigAppFontAddDir(nullptr, reinterpret_cast<const FcChar8*>(own.c_str()));
}

/// The font that fontconfig knows by a name.
Result<FontPtr> fontOfFamily(const std::string& family) {
    static std::mutex mutex;
    static std::once_flag looked;
    static std::deque<std::pair<std::string, FontPtr>> known;
    std::call_once(looked, findFonts);
    const std::lock_guard lock(mutex);
    for (const auto& [name, font] : known)
        if (name == family) return font;
    const Pattern wanted(FcNameParse(reinterpret_cast<const FcChar8*>(family.c_str())));
    if (!wanted)
        return Error{"the font " + inQuotes(family) +
                     " is no name of one: write a family, as in 'DejaVu Sans:bold'"};
    const std::string asked = wordOf(wanted, FC_FAMILY);
    FcPatternAddBool(wanted.get(), FC_SCALABLE, FcTrue);
    FcConfigSubstitute(nullptr, wanted.get(), FcMatchPattern);
    FcDefaultSubstitute(wanted.get());
    FcResult result = FcResultMatch;
    const Pattern match(FcFontMatch(nullptr, wanted.get(), &result));
    const std::string file = wordOf(match, FC_FILE), found = wordOf(match, FC_FAMILY);
    bool same = isGeneric(asked) || asked.empty();
    for (int i = 0; match && !same; ++i) {
        FcChar8* name = nullptr;
        if (FcPatternGetString(match.get(), FC_FAMILY, i, &name) != FcResultMatch) break;
        same = FcStrCmpIgnoreCase(name, reinterpret_cast<const FcChar8*>(asked.c_str())) == 0;
    }
    if (file.empty()) return Error{"there is no font on this machine: install some, or name a font's file"};
    if (!same)
        return Error{"there is no font " + inQuotes(asked) +
                     " on this machine: install it, name another, as " + inQuotes(found) +
                     ", or name a font's file"};
    int index = 0;
    FcPatternGetInteger(match.get(), FC_INDEX, 0, &index);
    std::ifstream in(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    // A number of a variable font's style stands in the upper half.
    Result<FontPtr> font = fontFrom(std::move(bytes), unsigned(index) & 0xFFFF, family);
    if (!font) return font;
    known.emplace_back(family, *font);
    if (known.size() > kKeptFonts) known.pop_front();
    return font;
}

Result<FontPtr> fontOfFile(const std::string& graphPath, const std::string& path) {
    if (!endsAs(kFontFile, path)) return wrongEnding(path, kFontFile);
    return readAsset<Font>(graphPath, path, kFontFile, [&](const std::string& bytes, const std::string&) {
        return fontFrom(bytes, 0, path);
    });
}

/// A family with this letter, on this machine; empty if there is none.
std::string familyWith(uint32_t letter) {
    const std::unique_ptr<FcCharSet, Freed<FcCharSetDestroy>> letters(FcCharSetCreate());
    FcCharSetAddChar(letters.get(), letter);
    const Pattern wanted(FcPatternCreate());
    FcPatternAddCharSet(wanted.get(), FC_CHARSET, letters.get());
    FcPatternAddBool(wanted.get(), FC_SCALABLE, FcTrue);
    const std::unique_ptr<FcObjectSet, Freed<FcObjectSetDestroy>> properties(
        FcObjectSetBuild(FC_FAMILY, nullptr));
    const FontSet fonts(FcFontList(nullptr, wanted.get(), properties.get()));
    std::vector<std::string> names;
    for (int i = 0; fonts && i < fonts->nfont; ++i) {
        FcChar8* name = nullptr;
        if (FcPatternGetString(fonts->fonts[i], FC_FAMILY, 0, &name) == FcResultMatch)
            names.emplace_back(reinterpret_cast<const char*>(name));
    }
    return names.empty() ? std::string() : *std::ranges::min_element(names);
}

/// UTF-8 as code points; none if it is damaged.
std::optional<std::vector<uint32_t>> codePoints(std::string_view text) {
    std::vector<uint32_t> points;
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const int more = byte < 0x80       ? 0
                         : byte >> 5 == 6  ? 1
                         : byte >> 4 == 14 ? 2
                         : byte >> 3 == 30 ? 3
                                           : -1;
        if (more < 0 || i + std::size_t(more) >= text.size()) return std::nullopt;
        uint32_t point = more == 0 ? byte : byte & (0x3Fu >> more);
        for (int k = 1; k <= more; ++k) {
            const auto next = static_cast<unsigned char>(text[i + std::size_t(k)]);
            if (next >> 6 != 2) return std::nullopt;
            point = point << 6 | (next & 0x3F);
        }
        if (point > 0x10FFFF || (point >= 0xD800 && point < 0xE000) || (more == 1 && point < 0x80) ||
            (more == 2 && point < 0x800) || (more == 3 && point < 0x10000))
            return std::nullopt;
        points.push_back(point);
        i += std::size_t(more) + 1;
    }
    return points;
}

/// A part of a line with one direction and one script.
struct Run {
    std::size_t from, count;
    int level;  ///< odd: from right to left
    hb_script_t script;
};

/// The runs of a line in the order in which they are seen, from the left.
std::vector<Run> runsOf(const std::vector<uint32_t>& line) {
    const auto length = FriBidiStrIndex(line.size());
    std::vector<FriBidiCharType> types(line.size());
    std::vector<FriBidiBracketType> brackets(line.size());
    std::vector<FriBidiLevel> levels(line.size());
    fribidi_get_bidi_types(line.data(), length, types.data());
    fribidi_get_bracket_types(line.data(), length, types.data(), brackets.data());
    FriBidiParType direction = FRIBIDI_PAR_ON;
    if (fribidi_get_par_embedding_levels_ex(types.data(), brackets.data(), length, &direction,
                                            levels.data()) == 0)
        std::ranges::fill(levels, FriBidiLevel(0));
    hb_unicode_funcs_t* const unicode = hb_unicode_funcs_get_default();
    std::vector<Run> runs;
    for (std::size_t i = 0; i < line.size(); ++i) {
        hb_script_t script = hb_unicode_script(unicode, line[i]);
        const bool common =
            script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED || script == HB_SCRIPT_UNKNOWN;
        if (!runs.empty() && runs.back().level == levels[i] &&
            (common || runs.back().script == script || runs.back().script == HB_SCRIPT_COMMON)) {
            ++runs.back().count;
            if (!common) runs.back().script = script;
        } else {
            runs.push_back({i, 1, levels[i], common ? HB_SCRIPT_COMMON : script});
        }
    }
    // Runs of a level and above are turned around, from the highest level down. (Unicode Annex 9, L2)
    int highest = 0;
    for (const Run& run : runs) highest = std::max(highest, run.level);
    for (int level = highest; level > 0; --level)
        for (std::size_t i = 0; i < runs.size(); ++i) {
            std::size_t end = i;
            while (end < runs.size() && runs[end].level >= level) ++end;
            if (end > i)
                std::reverse(runs.begin() + std::ptrdiff_t(i), runs.begin() + std::ptrdiff_t(end)), i = end;
        }
    return runs;
}

struct Glyph {
    hb_codepoint_t id;
    glm::dvec2 at;  ///< font units
};

/// The pen of HarfBuzz's callbacks, in em.
struct Drawer {
    Pen pen{kTextTolerance};
    glm::dvec2 origin{0};
    double scale = 1;
    glm::dvec2 at(float x, float y) const { return origin + scale * glm::dvec2(x, y); }
};

hb_draw_funcs_t* drawFunctions() {
    static hb_draw_funcs_t* const functions = [] {
        hb_draw_funcs_t* made = hb_draw_funcs_create();
        using State = hb_draw_state_t;
        hb_draw_funcs_set_move_to_func(
            made,
            [](hb_draw_funcs_t*, void* data, State*, float x, float y, void*) {
                auto& drawer = *static_cast<Drawer*>(data);
                drawer.pen.moveTo(drawer.at(x, y));
            },
            nullptr, nullptr);
        hb_draw_funcs_set_line_to_func(
            made,
            [](hb_draw_funcs_t*, void* data, State*, float x, float y, void*) {
                auto& drawer = *static_cast<Drawer*>(data);
                drawer.pen.lineTo(drawer.at(x, y));
            },
            nullptr, nullptr);
        hb_draw_funcs_set_quadratic_to_func(
            made,
            [](hb_draw_funcs_t*, void* data, State*, float cx, float cy, float x, float y, void*) {
                auto& drawer = *static_cast<Drawer*>(data);
                drawer.pen.curveTo(drawer.at(cx, cy), drawer.at(x, y));
            },
            nullptr, nullptr);
        hb_draw_funcs_set_cubic_to_func(
            made,
            [](hb_draw_funcs_t*, void* data, State*, float cx, float cy, float sx, float sy, float x, float y,
               void*) {
                auto& drawer = *static_cast<Drawer*>(data);
                drawer.pen.curveTo(drawer.at(cx, cy), drawer.at(sx, sy), drawer.at(x, y));
            },
            nullptr, nullptr);
        hb_draw_funcs_set_close_path_func(
            made,
            [](hb_draw_funcs_t*, void* data, State*, void*) { static_cast<Drawer*>(data)->pen.close(); },
            nullptr, nullptr);
        hb_draw_funcs_make_immutable(made);
        return made;
    }();
    return functions;
}

/// "'é' (U+00E9)"
std::string letterNamed(uint32_t letter, std::string_view text) {
    char code[16];
    std::snprintf(code, sizeof code, "U+%04X", unsigned(letter));
    // Its bytes in the text itself.
    for (std::size_t i = 0; i < text.size(); ++i)
        for (std::size_t length = 1; length <= 4 && i + length <= text.size(); ++length)
            if (const auto points = codePoints(text.substr(i, length));
                points && points->size() == 1 && points->front() == letter)
                return inQuotes(std::string(text.substr(i, length))) + " (" + code + ")";
    return code;
}

/// The height of a capital, em.
double capHeight(const Font& font) {
    hb_position_t height = 0;
    if (hb_ot_metrics_get_position(font.font.get(), HB_OT_METRICS_TAG_CAP_HEIGHT, &height) && height > 0)
        return height / font.em;
    hb_codepoint_t glyph = 0;
    hb_glyph_extents_t extents{};
    if (hb_font_get_nominal_glyph(font.font.get(), 'H', &glyph) &&
        hb_font_get_glyph_extents(font.font.get(), glyph, &extents))
        return extents.y_bearing / font.em;
    return 0.7;
}

}  // namespace

Result<Painting> paintText(const std::string& graphPath, const std::string& text, const TextLayout& layout) {
    if (text.size() > kMostTextBytes)
        return Error{"a text of " + std::to_string(text.size()) + " bytes: at most " +
                     std::to_string(kMostTextBytes) + " are allowed"};
    const Result<FontPtr> found =
        layout.fontFile.empty() ? fontOfFamily(layout.family) : fontOfFile(graphPath, layout.fontFile);
    if (!found) return found.error();
    const Font& font = **found;
    const auto points = codePoints(text);
    if (!points) return Error{"the text is no UTF-8"};

    std::vector<std::vector<uint32_t>> lines(1);
    for (const uint32_t point : *points)
        if (point == '\n')
            lines.emplace_back();
        else if (point != '\r')
            lines.back().push_back(point == '\t' ? uint32_t(' ') : point);

    hb_font_extents_t extents{};
    hb_font_get_h_extents(font.font.get(), &extents);
    double lineHeight = (extents.ascender - extents.descender + extents.line_gap) / font.em;
    if (!(lineHeight > 0)) lineHeight = 1.2;
    lineHeight *= layout.lineSpacing;
    const double top = capHeight(font), bottom = -lineHeight * double(lines.size() - 1);
    const double lifted = layout.anchor == TextLayout::Anchor::baseline ? 0
                          : layout.anchor == TextLayout::Anchor::top    ? -top
                          : layout.anchor == TextLayout::Anchor::bottom ? -bottom
                                                                        : -0.5 * (top + bottom);
    Drawer drawer;
    drawer.scale = 1 / font.em;
    const std::array<hb_feature_t, 1> features = {
        {{HB_TAG('k', 'e', 'r', 'n'), layout.kerning ? 1u : 0u, 0, unsigned(-1)}}};
    for (std::size_t row = 0; row < lines.size(); ++row) {
        const std::vector<uint32_t>& line = lines[row];
        if (line.empty()) continue;
        std::vector<Glyph> glyphs;
        glm::dvec2 at{0};
        double visible = 0;  // without the space behind the last letter
        for (const Run& run : runsOf(line)) {
            const Buffer buffer(hb_buffer_create());
            hb_buffer_add_utf32(buffer.get(), line.data(), int(line.size()), unsigned(run.from),
                                int(run.count));
            hb_buffer_set_direction(buffer.get(), run.level % 2 != 0 ? HB_DIRECTION_RTL : HB_DIRECTION_LTR);
            hb_buffer_set_script(buffer.get(), run.script);
            hb_buffer_guess_segment_properties(buffer.get());
            hb_shape(font.font.get(), buffer.get(), features.data(), unsigned(features.size()));
            unsigned count = 0;
            const hb_glyph_info_t* const infos = hb_buffer_get_glyph_infos(buffer.get(), &count);
            const hb_glyph_position_t* const places = hb_buffer_get_glyph_positions(buffer.get(), &count);
            for (unsigned i = 0; i < count; ++i) {
                const uint32_t letter = line[std::min<std::size_t>(infos[i].cluster, line.size() - 1)];
                if (infos[i].codepoint == 0) {
                    const std::string family = familyWith(letter);
                    return Error{
                        "the font " + inQuotes(font.name) + " has no letter for " +
                        letterNamed(letter, text) +
                        (family.empty() ? ": name one that has it" : ": " + inQuotes(family) + " has it")};
                }
                glyphs.push_back(
                    {infos[i].codepoint, at + glm::dvec2(places[i].x_offset, places[i].y_offset)});
                at += glm::dvec2(places[i].x_advance, places[i].y_advance);
                visible = at.x;
                if (i + 1 == count || infos[i + 1].cluster != infos[i].cluster)
                    at.x += layout.letterSpacing * font.em;
            }
        }
        const double width = visible / font.em;
        const double shift = layout.align == TextLayout::Align::left     ? 0
                             : layout.align == TextLayout::Align::center ? -0.5 * width
                                                                         : -width;
        for (const Glyph& glyph : glyphs) {
            drawer.origin = glm::dvec2(shift, lifted - lineHeight * double(row)) + glyph.at / font.em;
            hb_font_get_glyph_shape(font.font.get(), glyph.id, drawFunctions(), &drawer);
            if (drawer.pen.arcs() > kMostTextArcs)
                return Error{"a text that draws more than " + std::to_string(kMostTextArcs) +
                             " arcs: use fewer letters"};
        }
    }
    Painting painting;
    painting.fills.push_back({drawer.pen.taken()});
    return painting;
}

Result<OutlinePtr> outlineOfText(const std::string& graphPath, const std::string& text,
                                 const TextLayout& layout) {
    const double numbers[] = {double(layout.align), double(layout.anchor), layout.letterSpacing,
                              layout.lineSpacing, double(layout.kerning)};
    std::string key = outlineKey({"text", text, layout.family, layout.fontFile}, numbers);
    if (!layout.fontFile.empty()) {
        const Result<Asset> asset = openAsset(graphPath, layout.fontFile, kFontFile);
        if (!asset) return asset.error();
        key += asset->file;
        for (const int64_t part : asset->stamp) key += '\0' + std::to_string(part);
    }
    return keptOutline(key, [&]() -> Result<OutlinePtr> {
        const Result<Painting> painting = paintText(graphPath, text, layout);
        if (!painting) return painting.error();
        return outlineOf(*painting, "the text", "use fewer letters");
    });
}

}  // namespace fw
