#include "tests/support/editor/reader.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

namespace fw::editor::test {

namespace {

constexpr int kAround = 2;            // pixels of nothing about a text
constexpr double kAlike = 0.93;       // correlation of a text with itself, however it was blended
constexpr float kLeastContrast = 40;  // of 255, between ink and paper

/// Of each pixel.
void lightOf(const Picture& picture, std::vector<float>& light) {
    light.resize(picture.pixels.size() / 4);
    const uint8_t* p = picture.pixels.data();
    for (float& each : light) each = 0.3f * p[0] + 0.59f * p[1] + 0.11f * p[2], p += 4;
}

/// The texture between its pixels, as a sampler reads it.
float sampled(const unsigned char* alpha, int width, int height, float u, float v) {
    const float x = u * float(width) - 0.5f, y = v * float(height) - 0.5f;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    const float fx = x - float(x0), fy = y - float(y0);
    const auto at = [&](int i, int j) {
        i = std::clamp(i, 0, width - 1), j = std::clamp(j, 0, height - 1);
        return float(alpha[std::size_t(j) * std::size_t(width) + std::size_t(i)]) / 255.0f;
    };
    return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0)) +
           fy * ((1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1));
}

}  // namespace

Reader::Reader() : atlas(std::make_unique<ImFontAtlas>()) {
    ImGuiContext* before = ImGui::GetCurrentContext();
    ImGuiContext* own = ImGui::CreateContext(atlas.get());
    ImGui::SetCurrentContext(own);
    fonts = readFonts(*atlas, 1.0f);
    bakeFonts(*atlas);
    ImGui::SetCurrentContext(before ? before : own);
    ImGui::DestroyContext(own);
}

const Reader::Mask& Reader::maskOf(const std::string& words, float size, Face face) {
    const auto [found, fresh] = masks.try_emplace({words, size, face});
    Mask& mask = found->second;
    if (!fresh) return mask;
    ImFont* font = face == Face::code ? fonts.codeOf(size) : fonts.of(size);
    const float scale = size / font->FontSize;
    const ImVec2 extent = font->CalcTextSizeA(size, FLT_MAX, 0.0f, words.c_str());
    mask.width = int(std::ceil(extent.x)) + 2 * kAround;
    mask.height = int(std::ceil(extent.y)) + 2 * kAround;
    mask.cover.assign(std::size_t(mask.width) * std::size_t(mask.height), 0.0f);
    unsigned char* alpha = nullptr;
    int width = 0, height = 0;
    atlas->GetTexDataAsAlpha8(&alpha, &width, &height);
    float pen = kAround;
    for (const char* at = words.c_str(); *at;) {
        unsigned character = 0;
        at += ImTextCharFromUtf8(&character, at, nullptr);
        const ImFontGlyph* glyph = font->FindGlyph(ImWchar(character));
        const float left = pen + glyph->X0 * scale, right = pen + glyph->X1 * scale;
        const float top = kAround + glyph->Y0 * scale, bottom = kAround + glyph->Y1 * scale;
        for (int y = 0; y < mask.height; ++y)
            for (int x = 0; x < mask.width; ++x) {
                const float px = float(x) + 0.5f, py = float(y) + 0.5f;
                if (px < left || px >= right || py < top || py >= bottom) continue;
                const float u = glyph->U0 + (glyph->U1 - glyph->U0) * (px - left) / (right - left);
                const float v = glyph->V0 + (glyph->V1 - glyph->V0) * (py - top) / (bottom - top);
                float& cover = mask.cover[std::size_t(y) * std::size_t(mask.width) + std::size_t(x)];
                cover = std::max(cover, sampled(alpha, width, height, u, v));
            }
        pen += glyph->AdvanceX * scale;
    }
    return mask;
}

std::optional<Area> Reader::find(const Picture& picture, const std::string& words, float size,
                                 const std::optional<Area>& within, Face face) {
    const Mask& mask = maskOf(words, size, face);
    const std::size_t count = mask.cover.size();
    double sum = 0, squares = 0;
    for (float c : mask.cover) sum += double(c), squares += double(c) * double(c);
    const double spread = squares - sum * sum / double(count);

    // Most places are told apart by a few pixels: the darkest and, beside each, one without ink. None below
    // the line, where small buttons cut off what hangs down.
    struct Probe {
        std::ptrdiff_t ink, paper;  // from the place's first pixel
    };
    const std::ptrdiff_t row = picture.width;
    std::vector<Probe> all;
    for (int y = 0; y < mask.height - kAround; ++y)
        for (int x = 1; x + 1 < mask.width; ++x) {
            const float* cover = &mask.cover[std::size_t(y) * std::size_t(mask.width)];
            if (cover[x] < 0.75f) continue;
            for (int side : {x - 1, x + 1, x - 2, x + 2})
                if (side >= 0 && side < mask.width && cover[side] < 0.05f) {
                    all.push_back({y * row + x, y * row + side});
                    break;
                }
        }
    const std::size_t step = std::max<std::size_t>(all.size() / 12, 1);
    std::vector<Probe> probes;
    for (std::size_t i = 0; i < all.size(); i += step) probes.push_back(all[i]);

    lightOf(picture, light);
    const int left = within ? std::max(int(within->lo.x), 0) : 0,
              top = within ? std::max(int(within->lo.y), 0) : 0;
    const int right = (within ? std::min(int(within->hi.x), picture.width) : picture.width) - mask.width,
              bottom = (within ? std::min(int(within->hi.y), picture.height) : picture.height) - mask.height;
    const auto alike = [&](const float* place) {
        int brighter = 0;
        for (const Probe& probe : probes) {
            const float off = place[probe.ink] - place[probe.paper];
            const int sign = off > 0.5f * kLeastContrast ? 1 : off < -0.5f * kLeastContrast ? -1 : 0;
            if (sign == 0 || (brighter != 0 && brighter != sign)) return false;
            brighter = sign;
        }
        return true;
    };
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
            const float* place = &light[std::size_t(y) * std::size_t(row) + std::size_t(x)];
            if (!alike(place)) continue;
            double seen = 0, seenSquares = 0, product = 0;
            for (int j = 0; j < mask.height; ++j)
                for (int i = 0; i < mask.width; ++i) {
                    const double c =
                        double(mask.cover[std::size_t(j) * std::size_t(mask.width) + std::size_t(i)]);
                    const double l = double(place[j * row + i]);
                    seen += l, seenSquares += l * l, product += c * l;
                }
            const double seenSpread = seenSquares - seen * seen / double(count);
            const double covariance = product - sum * seen / double(count);
            if (seenSpread <= 0 || std::abs(covariance) < kAlike * std::sqrt(seenSpread * spread)) continue;
            return Area{{float(x + kAround), float(y + kAround)},
                        {float(x + mask.width - kAround), float(y + mask.height - kAround)}};
        }
    return std::nullopt;
}

}  // namespace fw::editor::test
