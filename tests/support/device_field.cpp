#include "tests/support/device_field.h"

#include "graph/emit/glsl.h"
#include "tests/support/gpu.h"

namespace fw::test {

FieldResources::FieldResources(const Program& program) {
    const std::vector<float> numbers = program.numbers();
    parameters = createBuffer(device(), numbers.size() * sizeof(float), Memory::upload);
    upload(device(), parameters, numbers);
    const std::vector<uint32_t> words = imageWords(program.ir.images());
    images = createBuffer(device(), words.size() * sizeof(uint32_t));
    upload(device(), images, words);
    const std::vector<uint32_t> texels = fieldTexels(program.ir);
    volumes = createBuffer(device(), texels.size() * sizeof(uint32_t));
    upload(device(), volumes, texels);
}

std::vector<FieldSample> evaluateOnDevice(const Program& program,
                                          std::span<const std::array<float, 3>> points, float halfSize) {
    Device& gpu = device();
    const std::string field = emitField(program);
    const Pipeline pipeline = createComputePipeline(gpu, {.name = "field/evaluate.comp", .field = field});
    const Buffer in = createBuffer(gpu, points.size_bytes(), Memory::upload);
    const Buffer out = createBuffer(gpu, points.size() * sizeof(FieldSample), Memory::readback);
    const FieldResources resources(program);
    uploadBytes(gpu, in, points.data(), points.size_bytes());

    Commands commands(gpu);
    const struct {
        uint32_t count;
        float halfSize;
    } push{static_cast<uint32_t>(points.size()), halfSize};
    std::vector<Descriptor> descriptors = {{0, in}, {1, out}};
    addField(descriptors, resources.buffers());
    dispatch(commands, pipeline, {groupsFor(points.size(), 64), 1, 1}, push, descriptors);
    submit(commands);
    return download<FieldSample>(gpu, out, points.size());
}

}  // namespace fw::test
