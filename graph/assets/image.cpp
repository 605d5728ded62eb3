#include "graph/assets/image.h"

#include <algorithm>
#include <cmath>

namespace fw {

namespace {

const std::array<double, 256>& linearBytes() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> values;
        for (int i = 0; i < 256; ++i) values[std::size_t(i)] = decodeSrgb(i / 255.0);
        return values;
    }();
    return table;
}

double texel(const ImageLayer& layer, int x, int y) {
    const FieldImage& image = *layer.image;
    const uint32_t word = image.texels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
    const std::size_t byte = word >> (8 * layer.channel) & 255u;
    return layer.channel == kGreyLayer ? double(byte) / 255.0 : linearBytes()[byte];
}

/// A coordinate among `size` texels: the one before it, the one after it, and how far it is between their
/// centres.
struct Place {
    int before, after;
    double fraction;
};

Place place(double u, int size) {
    if (!(std::abs(u) < 1e15)) u = 0.0;  // too far for a fraction to be left, or no number
    const double x = (u - std::floor(u)) * size - 0.5;
    const double first = std::floor(x);
    const int i = static_cast<int>(first);
    return {i < 0 ? size - 1 : i, i + 1 >= size ? 0 : i + 1, x - first};
}

}  // namespace

double decodeSrgb(double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

double encodeSrgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

FieldImage::FieldImage(int width_, int height_, std::vector<uint32_t> texels_, std::string file_)
    : width(width_), height(height_), texels(std::move(texels_)), file(std::move(file_)) {
    hash = (uint64_t(uint32_t(width)) << 32 | uint32_t(height)) * 0x9E3779B97F4A7C15ull;
    for (uint32_t& word : texels) {
        const uint32_t sum = (word & 255u) + (word >> 8 & 255u) + (word >> 16 & 255u);
        word = (word & 0xFFFFFFu) | (sum + 1) / 3 << 24;
        hash = (hash ^ word) * 0x9E3779B97F4A7C15ull;
        hash ^= hash >> 32;
    }
    for (int channel = 0; channel < kImageLayers; ++channel) {
        ImageLayer& layer = layers[std::size_t(channel)];
        layer = {this, channel, 1.0, 0.0, 0.0, 0.0};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const double here = texel(layer, x, y);
                const double right = texel(layer, x + 1 < width ? x + 1 : 0, y);
                const double above = texel(layer, x, y + 1 < height ? y + 1 : 0);
                layer.least = std::min(layer.least, here);
                layer.most = std::max(layer.most, here);
                layer.slopeU = std::max(layer.slopeU, std::abs(right - here) * width);
                layer.slopeV = std::max(layer.slopeV, std::abs(above - here) * height);
            }
    }
}

double linearOfByte(int byte) { return linearBytes()[std::size_t(byte)]; }

ImageSample sampleImage(const ImageLayer& layer, double u, double v) {
    const Place x = place(u, layer.image->width), y = place(v, layer.image->height);
    const double a = texel(layer, x.before, y.before), b = texel(layer, x.after, y.before);
    const double c = texel(layer, x.before, y.after), d = texel(layer, x.after, y.after);
    const double below = a + (b - a) * x.fraction, above = c + (d - c) * x.fraction;
    return {below + (above - below) * y.fraction,
            layer.image->width * ((b - a) + ((d - c) - (b - a)) * y.fraction),
            layer.image->height * (above - below)};
}

Interval sampleImage(const ImageLayer& layer, Interval u, Interval v) {
    const double centre = sampleImage(layer, 0.5 * (u.lo + u.hi), 0.5 * (v.lo + v.hi)).value;
    const double far = std::max({-u.lo, u.hi, -v.lo, v.hi});
    const double least = layer.least - 1e-12, most = layer.most + 1e-12;
    if (far >= 1e12) return {least, most};
    // A coordinate is known up to its rounding.
    const double reach = layer.slopeU * (0.5 * (u.hi - u.lo) + 1e-15 * (1.0 + far)) +
                         layer.slopeV * (0.5 * (v.hi - v.lo) + 1e-15 * (1.0 + far));
    return {std::max(centre - reach - 1e-12, least), std::min(centre + reach + 1e-12, most)};
}

std::vector<uint32_t> imageWords(const std::vector<FieldImagePtr>& images) {
    std::vector<uint32_t> words;
    std::size_t count = 0;
    for (const FieldImagePtr& image : images) count += image->texels.size();
    words.reserve(std::max<std::size_t>(count, 1));
    for (const FieldImagePtr& image : images)
        words.insert(words.end(), image->texels.begin(), image->texels.end());
    if (words.empty()) words.push_back(0);
    return words;
}

const FieldImagePtr& plainImage() {
    static const FieldImagePtr image = [] {
        constexpr int side = 16;
        std::vector<uint32_t> texels;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                texels.push_back((x < side / 2) == (y < side / 2) ? 0xE0E0E0u : 0xB0B0B0u);
        return std::make_shared<const FieldImage>(side, side, std::move(texels));
    }();
    return image;
}

}  // namespace fw
