#include "runtime/render/bloom.h"

#include <algorithm>
#include <cmath>

namespace fw {

namespace {

constexpr int kGaussians = 5;
constexpr double kMostVariance = 4.0;  // of a Gaussian, texels, as far as the kernel reaches

/// By which halving to a level and enlarging again blur, pixels.
double varianceOf(int level) { return 0.5 * (std::ldexp(1.0, 2 * level) - 1.0); }

Pipeline bloomPipeline(const Device& device, std::vector<std::string> defines) {
    return createComputePipeline(device, {.name = "render/bloom.comp", .defines = std::move(defines)});
}

void pass(Commands& commands, const Pipeline& pipeline, const Image& to, const gpu::BloomPush& push,
          std::span<const Descriptor> bound) {
    dispatch(commands, pipeline,
             {groupsFor(to.extent.width, RENDER_TILE), groupsFor(to.extent.height, RENDER_TILE), 1}, &push,
             sizeof push, bound);
    barrier(commands);
}

}  // namespace

std::vector<BloomLevel> bloomLevels(const Bloom& bloom, int width, int height) {
    const int most = std::max(int(std::log2(std::max(width, height))), 2);
    std::vector<BloomLevel> levels(std::size_t(most) + 1);
    levels[0].plain = float(1.0 - bloom.strength);
    const float share = float(bloom.strength / kGaussians);
    std::size_t used = 1;
    for (int i = 0; i < kGaussians; ++i) {
        const double wide = std::ldexp(bloom.radius * height, -i), variance = wide * wide;  // pixels
        if (variance < 4.0) {
            // Of two levels, by the variance that they have.
            const std::size_t below = variance < varianceOf(1) ? 0 : 1;
            const double least = varianceOf(int(below)), next = varianceOf(int(below) + 1);
            const float above = float((variance - least) / (next - least));
            levels[below].plain += (1.0f - above) * share;
            levels[below + 1].plain += above * share;
            if (above > 0.0f) used = std::max(used, below + 1);
            continue;
        }
        const int level = std::min(int(std::log2(wide)), most);
        BloomLevel& blurred = levels[std::size_t(level)];
        const double left = std::ldexp(variance - varianceOf(level), -2 * level);
        blurred.variance = float(std::min(left, kMostVariance));
        blurred.blurred += share;
        used = std::max(used, std::size_t(level));
    }
    levels.resize(used + 1);
    return levels;
}

void drawBloom(Commands& commands, BloomPasses& passes, const Bloom& bloom, const Image& light,
               const Buffer& frame, bool neutral, bool cutout, const Image& pixels) {
    beginStage(commands, "bloom");
    const Device& device = commands.device;
    if (!passes.down) {
        passes.down = bloomPipeline(device, {"DOWN"});
        passes.across = bloomPipeline(device, {"ACROSS"});
        passes.up = bloomPipeline(device, {"UP"});
    }
    Pipeline& show = passes.show[neutral][cutout];
    if (!show) {
        std::vector<std::string> defines;
        if (neutral) defines.push_back("NEUTRAL");
        if (cutout) defines.push_back("CUTOUT");
        show = bloomPipeline(device, std::move(defines));
    }
    const std::vector<BloomLevel> levels =
        bloomLevels(bloom, int(light.extent.width), int(light.extent.height));
    const std::size_t count = levels.size();
    if (passes.levels.size() < count) passes.levels.resize(count), passes.rows.resize(count);
    VkExtent3D extent = light.extent;
    for (std::size_t i = 0; i < count; ++i) {
        resizeImage(commands, passes.levels[i], extent, VK_FORMAT_R32G32B32A32_SFLOAT);
        if (i > 0) resizeImage(commands, passes.rows[i], extent, VK_FORMAT_R32G32B32A32_SFLOAT);
        extent = {(extent.width + 1) / 2, (extent.height + 1) / 2, 1};
    }
    for (std::size_t i = 1; i < count; ++i) {
        const Descriptor bound[] = {storage(1, i == 1 ? light : passes.levels[i - 1]),
                                    storage(2, passes.levels[i])};
        pass(commands, passes.down, passes.levels[i], {}, bound);
    }
    for (std::size_t i = count; i-- > 1;) {
        const BloomLevel& level = levels[i];
        const bool last = i + 1 == count;
        const Image &to = passes.levels[i], &rows = passes.rows[i];
        const gpu::BloomPush push{level.plain, level.blurred, last ? 0.0f : 1.0f, level.variance};
        const Descriptor blurred[] = {storage(1, to), storage(2, rows)};
        pass(commands, passes.across, rows, push, blurred);
        const Descriptor bound[] = {storage(1, last ? rows : passes.levels[i + 1]), storage(2, to),
                                    storage(4, rows)};
        pass(commands, passes.up, to, push, bound);
    }
    const Descriptor bound[] = {{0, frame},
                                storage(1, passes.levels[1]),
                                storage(2, light),
                                storage(3, passes.levels[0]),
                                storage(10, pixels)};
    pass(commands, show, light, {levels[0].plain, 0.0f, 1.0f, 1.0f}, bound);
}

}  // namespace fw
