#include "tests/support/golden.h"

#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace fw::test {

namespace {

constexpr int kStrong = 32;  // of 255

std::string pathOf(const std::string& name) {
    return FIELDWRIGHT_SOURCE_DIR "/tests/data/golden/" + name + ".png";
}

struct Comparison {
    bool sameSize = false;
    double mean = 0, strong = 0;
    Picture difference = {};
};

Comparison compare(const Picture& picture, const std::string& name) {
    int width = 0, height = 0, channels = 0;
    uint8_t* kept = stbi_load(pathOf(name).c_str(), &width, &height, &channels, 3);
    Comparison found;
    found.sameSize = kept && width == picture.width && height == picture.height;
    if (found.sameSize) {
        found.difference = {width, height, std::vector<uint8_t>(picture.pixels.size(), 255)};
        const std::size_t pixels = std::size_t(width) * std::size_t(height);
        for (std::size_t i = 0; i < pixels; ++i) {
            int most = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                const int off = picture.pixels[4 * i + c] - kept[3 * i + c];
                found.difference.pixels[4 * i + c] = uint8_t(std::clamp(128 + 4 * off, 0, 255));
                found.mean += std::abs(off);
                most = std::max(most, std::abs(off));
            }
            found.strong += most > kStrong;
        }
        found.mean /= 3.0 * double(pixels);
        found.strong /= double(pixels);
    }
    stbi_image_free(kept);
    return found;
}

bool within(const Comparison& found, const Tolerance& tolerance) {
    return found.sameSize && found.mean <= tolerance.mean && found.strong <= tolerance.mostStrong;
}

}  // namespace

bool remakesGolden() { return std::getenv("FIELDWRIGHT_UPDATE_GOLDEN") != nullptr; }

bool isGolden(const Picture& picture, const std::string& name, const Tolerance& tolerance) {
    return within(compare(picture, name), tolerance);
}

void expectGolden(const Picture& picture, const std::string& name, const Tolerance& tolerance) {
    if (remakesGolden()) {
        std::filesystem::create_directories(std::filesystem::path(pathOf(name)).parent_path());
        ASSERT_TRUE(savePicture(picture, pathOf(name)));
    }
    const Comparison found = compare(picture, name);
    if (within(found, tolerance)) return;
    std::string beside = name;
    std::ranges::replace(beside, '/', '.');
    beside = FIELDWRIGHT_BINARY_DIR "/" + beside;
    (void)savePicture(picture, beside + ".now.png");
    if (!found.sameSize) {
        ADD_FAILURE() << pathOf(name) << " is missing or of another size: look at " << beside
                      << ".now.png, then keep it with FIELDWRIGHT_UPDATE_GOLDEN=1";
        return;
    }
    (void)savePicture(found.difference, beside + ".difference.png");
    ADD_FAILURE() << name << " differs by " << found.mean << " of 255 on average and strongly in "
                  << 100 * found.strong << " % of the pixels: see " << beside
                  << ".now.png and .difference.png";
}

}  // namespace fw::test
