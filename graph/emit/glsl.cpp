#include "graph/emit/glsl.h"

#include <algorithm>

#include "graph/emit/glsl_families.h"
#include "graph/emit/glsl_statements.h"

namespace fw {

namespace {

class Emitter : GlslStatements {
  public:
    explicit Emitter(const Program& program_)
        : GlslStatements(program_), program(program_), ir(program_.ir) {}

    std::string run() {
        for (IrId id = 0; id < ir.size(); ++id) {
            const Op op = ir[id].op;
            usesNoise |= op == Op::gradientNoise || op == Op::simplexNoise || op == Op::worleyNoise ||
                         op == Op::cellWall || op == Op::cellHash;
            usesSmoothMinimum |= op == Op::smoothMinimum;
        }
        parameters();
        images();
        texels();
        if (usesNoise) text += "#include \"lib/noise.glsl\"\n";
        if (usesSmoothMinimum) text += "#include \"lib/smooth_minimum.glsl\"\n";
        text +=
            "float fieldPower(float a, float b) { return a > 0.0 ? pow(a, b) : b > 0.0 ? 0.0 : b < 0.0 ? "
            "1e30 : 1.0; }\n"
            "float fieldArcTangent2(float y, float x) { return y == 0.0 && x == 0.0 ? 0.0 : atan(y, x); }\n";
        if (program.families.empty()) {
            text += "#ifdef FIELD_PRUNED\nbool fieldChoose(uint place) { return true; }\n#endif\n";
            valueFunction("FIELD_VALUE", "fieldValue", program.distance());
            gradientFunction("FIELD_GRADIENT", "fieldGradient", program.distance());
            intervalFunction();
            rows();
        } else {
            text += emitFamilies(program);
        }
        material("FIELD_MATERIAL", "fieldMaterial", program.surface);
        opaque();
        return std::move(text);
    }

  private:
    void parameters() {
        text +=
            "struct FieldMaterial { vec3 baseColor; float roughness; float metallic; vec3 emission; float "
            "transmission; float ior; vec3 absorption; };\n";
        const bool listsAlone = program.live.empty() && program.families.listed > 0;
        if (listsAlone) text += "#ifndef FIELD_PRUNED\n";
        if (!program.families.empty() || !program.live.empty())
            text += "layout(set = 0, binding = " + std::to_string(kFieldParametersBinding) +
                    ", std430) readonly buffer FieldParameters { float fieldParameters[]; };\n";
        if (listsAlone) text += "#endif\n";
        for (std::size_t slot = 0; slot < program.live.size(); ++slot)
            text += "float fieldP" + std::to_string(slot) + ";\n";
        begin("fieldBegin", "fieldParameters");
        if (program.live.empty()) return;
        text += "#ifdef FIELD_BEFORE\n#define FIELD_MOVES\nlayout(set = 0, binding = " +
                std::to_string(kFieldParametersBeforeBinding) +
                ", std430) readonly buffer FieldParametersBefore { float fieldParametersBefore[]; };\n";
        begin("fieldBeginBefore", "fieldParametersBefore");
        text += "#endif\n";
    }
    /// A function that loads the live parameters from a buffer.
    void begin(const char* name, const char* from) {
        text += "void " + std::string(name) + "() {\n";
        for (std::size_t slot = 0; slot < program.live.size(); ++slot)
            text += "    fieldP" + std::to_string(slot) + " = " + from + "[" + std::to_string(slot) + "];\n";
        text += "}\n";
    }
    /// Two functions for each layer that is sampled, its place, size and bounds folded in.
    void images() {
        if (ir.images().empty()) return;
        const bool paint = paintOnly(Op::image);
        if (paint) text += "#ifdef FIELD_MATERIAL\n";
        text += "layout(set = 0, binding = " + std::to_string(kFieldImagesBinding) +
                ", std430) readonly buffer FieldImages { uint fieldImages[]; };\n"
                "#include \"lib/image.glsl\"\n";
        const std::vector<bool> sampled = layersOf(Op::image, ir.images().size() * kImageLayers);
        std::size_t first = 0;
        for (std::size_t number = 0; number < sampled.size(); ++number) {
            const FieldImage& image = *ir.images()[number / kImageLayers];
            const ImageLayer& layer = image.layers[number % kImageLayers];
            if (sampled[number]) {
                const std::string where = std::to_string(first) + "u, ivec2(" + std::to_string(image.width) +
                                          ", " + std::to_string(image.height) + "), ";
                const std::string channel = std::to_string(layer.channel);
                text += "vec4 fieldImage" + std::to_string(number) + "(vec2 uv) { return imageSample(" +
                        where + "uv, " + channel + "); }\n" + "vec2 fieldImageRange" +
                        std::to_string(number) + "(vec2 u, vec2 v) { return imageRange(" + where + "u, v, " +
                        channel + ", " + pair(layer.slopeU, layer.slopeV) + ", " +
                        pair(layer.least, layer.most) + "); }\n";
            }
            if (layer.channel + 1 == kImageLayers) first += image.texels.size();
        }
        if (paint) text += "#endif\n";
    }
    /// The same for volumes, outlines and splines, which lie in one buffer of texels.
    void texels() {
        if (ir.volumes().empty() && ir.outlines().empty() && ir.splines().empty()) return;
        const bool paint = paintOnly(Op::volume) && paintOnly(Op::outline) && paintOnly(Op::spline);
        if (paint) text += "#ifdef FIELD_MATERIAL\n";
        text += "layout(set = 0, binding = " + std::to_string(kFieldVolumesBinding) +
                ", rgba32ui) restrict readonly uniform uimageBuffer fieldVolumes;\n";
        std::size_t first = 0;
        if (!ir.volumes().empty()) volumes(first);
        if (!ir.outlines().empty()) outlines(first);
        if (!ir.splines().empty()) splines(first);
        if (paint) text += "#endif\n";
    }
    /// Of a colour, only the value is asked for in shaders.
    void volumes(std::size_t& first) {
        text += "#include \"lib/volume.glsl\"\n";
        const std::vector<bool> sampled = layersOf(Op::volume, ir.volumes().size() * kVolumeLayers);
        for (std::size_t v = 0; v < ir.volumes().size(); ++v) {
            const FieldVolume& volume = *ir.volumes()[v];
            const VolumeGrid& grid = volume.grid;
            const std::string gridName = "fieldVolumeGrid" + std::to_string(v);
            text += "const VolumeGrid " + gridName + " = VolumeGrid(" + std::to_string(first) + ", ivec3" +
                    triple(grid.size, [](int n) { return std::to_string(n); }) + ", vec3" +
                    triple(grid.origin, glslLiteral) + ", vec3" + triple(grid.inset, glslLiteral) + ", " +
                    glslLiteral(grid.cell) + ", " + glslLiteral(1.0 / grid.cell) + ");\n";
            for (const VolumeLayer& layer : volume.layers) {
                const std::size_t number = v * kVolumeLayers + std::size_t(layer.channel);
                if (!sampled[number]) continue;
                const std::string name = std::to_string(number);
                const bool color = layer.channel >= redChannel;
                text +=
                    "vec4 fieldVolume" + name + "(vec3 p) { return " +
                    (layer.channel == tricubicChannel ? "volumeTricubic(" + gridName + ", p"
                     : layer.channel == trilinearChannel
                         ? "volumeTrilinear(" + gridName + ", p"
                         : "volumeColor(" + gridName + ", p, " + std::to_string(layer.channel - redChannel)) +
                    "); }\nvec2 fieldVolumeRange" + name + "(vec2 x, vec2 y, vec2 z) { return " +
                    (color ? "vec2(-1e-5, 1.00001)"
                     : volume.particles
                         ? "volumeBlockRange(" + gridName + ", fieldVolume" + name +
                               "(0.5 * vec3(x.x + x.y, y.x + y.y, z.x + z.y)).w, x, y, z, " +
                               glslLiteral(layer.rise) + ")"
                         : "volumeRange(" + gridName + ", fieldVolume" + name +
                               "(0.5 * vec3(x.x + x.y, y.x + y.y, z.x + z.y)).w, x, y, z, " + "vec4(" +
                               glslLiteral(layer.slope) + ", " + glslLiteral(layer.shift) + ", " +
                               glslLiteral(layer.scatter) + ", " + glslLiteral(layer.rise) + "), " +
                               pair(layer.least, layer.most) + ")") +
                    "; }\n";
            }
            first += texelCount(volume);
        }
    }
    void outlines(std::size_t& first) {
        text +=
            "#define OUTLINE_LEVELS " + std::to_string(kOutlineLevels) + "\n#include \"lib/outline.glsl\"\n";
        for (std::size_t number = 0; number < ir.outlines().size(); ++number) {
            const Outline& outline = *ir.outlines()[number];
            const std::string name = std::to_string(number), grid = "fieldOutlineGrid" + name;
            text += "const OutlineGrid " + grid + " = OutlineGrid(" + std::to_string(first) + ", " +
                    std::to_string(outline.cells) + ", " + std::to_string(outline.rows) + ", " +
                    std::to_string(outline.farCells) + ", " + pair(outline.centre.x, outline.centre.y) +
                    ", " + pair(outline.half.x, outline.half.y) + ", " + glslLiteral(outline.least) + ", " +
                    (outline.straight ? "true" : "false") + ");\nvec4 fieldOutline" + name +
                    "(vec2 p) { return outlineSample(" + grid + ", p); }\nvec2 fieldOutlineRange" + name +
                    "(vec2 x, vec2 y) { return outlineRange(" + grid + ", x, y); }\n";
            first += outline.texels.size();
        }
    }
    /// The coordinates beside a spline are found once for those that are asked for at one place.
    void splines(std::size_t first) {
        for (const auto& [name, number] : {std::pair("LEVELS", kSplineLevels),
                                           {"NEAR_LEVELS", kSplineNearLevels},
                                           {"NEAR_CELLS", kSplineNearCells},
                                           {"FAR_CELLS", kSplineFarCells},
                                           {"ARC_TEXELS", kArcTexels}})
            text += std::string("#define SPLINE_") + name + " " + std::to_string(number) + "\n";
        text += "#include \"lib/spline.glsl\"\n";
        const std::vector<bool> sampled = layersOf(Op::spline, ir.splines().size() * kSplineChannels);
        for (std::size_t s = 0; s < ir.splines().size(); ++s) {
            const SplineTable& table = *ir.splines()[s];
            const std::string own = std::to_string(s), grid = "fieldSplineGrid" + own;
            const std::size_t count = table.spline->arcs.size(),
                              arcs = first + table.texels.size() - kArcTexels * count,
                              runs = arcs - (table.runs.size() + 3) / 4;
            text += "const SplineGrid " + grid + " = SplineGrid(" + std::to_string(first) + ", " +
                    std::to_string(runs) + ", " + std::to_string(arcs) + ", ivec3" +
                    triple(table.cells, [](int n) { return std::to_string(n); }) + ", vec3" +
                    triple(table.centre, glslLiteral) + ", vec3" + triple(table.half, glslLiteral) + ", " +
                    glslLiteral(table.radius) + ", " + (table.tapered ? "true" : "false") + ", " +
                    (table.spline->closed ? "true" : "false") + ", " + glslLiteral(table.least) + ", " +
                    glslLiteral(table.spline->length) + ", vec3(" + glslLiteral(table.leastShare) + ", " +
                    glslLiteral(table.mostShare) + ", " + glslLiteral(table.shareSlope) + "));\n";
            const auto function = [&](int channel, const std::string& value, const std::string& range) {
                const std::string name = std::to_string(int(s) * kSplineChannels + channel);
                if (!sampled[s * kSplineChannels + std::size_t(channel)]) return;
                text += "vec4 fieldSpline" + name + "(vec3 p) { return " + value +
                        "; }\nvec2 fieldSplineRange" + name + "(vec2 x, vec2 y, vec2 z) { return " + range +
                        ", x, y, z); }\n";
            };
            function(0, "splineDistance(" + grid + ", p)", "splineDistanceRange(" + grid);
            first += table.texels.size();
            const auto from = sampled.begin() + std::ptrdiff_t(s) * kSplineChannels;
            if (std::find(from + 1, from + kSplineChannels, true) == from + kSplineChannels) continue;
            text += "vec3 fieldSplineAt" + own + " = vec3(1e38);\nSplineBeside fieldSplineBeside" + own +
                    ";\nSplineBeside fieldSplineThere" + own + "(vec3 p) {\n    if (p != fieldSplineAt" +
                    own + ") {\n        fieldSplineAt" + own + " = p;\n        fieldSplineBeside" + own +
                    " = splineBeside(" + grid + ", splineCell(" + grid +
                    ", p).words, p);\n    }\n    return fieldSplineBeside" + own + ";\n}\n";
            constexpr const char* kNames[] = {"", "across", "up", "along", "share"};
            for (int channel = 1; channel < kSplineChannels; ++channel)
                function(channel, "fieldSplineThere" + own + "(p)." + kNames[channel],
                         "splineRange(" + grid + ", " + std::to_string(channel));
        }
    }
    /// Three of anything that is counted, as a vector's arguments.
    template <class Of, class Literal>
    static std::string triple(const Of& of, Literal literal) {
        return "(" + literal(of[0]) + ", " + literal(of[1]) + ", " + literal(of[2]) + ")";
    }
    static std::string pair(double a, double b) {
        return "vec2(" + glslLiteral(a) + ", " + glslLiteral(b) + ")";
    }
    /// Whether the distance has no such operation. A shader that samples nothing must not declare the buffer,
    /// so that nothing need be bound there.
    bool paintOnly(Op op) {
        const IrId distance = program.distance();
        const std::vector<bool> needed = neededBy(std::span(&distance, 1));
        for (IrId id = 0; id < ir.size(); ++id)
            if (needed[id] && ir[id].op == op) return false;
        return true;
    }
    /// Which of the layers that `op` can sample are.
    std::vector<bool> layersOf(Op op, std::size_t count) const {
        std::vector<bool> sampled(count, false);
        for (IrId id = 0; id < ir.size(); ++id)
            if (ir[id].op == op) sampled[static_cast<std::size_t>(ir[id].number)] = true;
        return sampled;
    }

    void valueFunction(std::string_view section, std::string_view name, IrId root) {
        text += "#ifdef " + std::string(section) + "\nfloat " + std::string(name) + "(vec3 p) {\n";
        valueStatements(neededBy(std::span(&root, 1)));
        text += "    return " + value(root) + ";\n}\n#endif\n";
    }

    void gradientFunction(std::string_view section, std::string_view name, IrId root) {
        const std::vector<bool> needed = neededBy(std::span(&root, 1));
        Derivatives known = noDerivatives();
        text += "#ifdef " + std::string(section) + "\nvec4 " + std::string(name) + "(vec3 p) {\n";
        for (IrId id = 0; id < ir.size(); ++id)
            if (needed[id] && !isInline(ir[id])) gradientStatement(id, known);
        text += "    return vec4(";
        for (int axis = 0; axis < 3; ++axis) {
            const std::string& slope = known[axis][root];
            text += (slope.empty() ? "0.0" : slope) + ", ";
        }
        text += value(root) + ");\n}\n#endif\n";
    }

    void intervalFunction() {
        const IrId root = program.distance();
        const std::vector<bool> needed = neededBy(std::span(&root, 1));
        text +=
            "#ifdef FIELD_INTERVAL\n#include \"lib/interval.glsl\"\nvec2 fieldInterval(vec3 lo, vec3 hi) {\n";
        for (IrId id = 0; id < ir.size(); ++id)
            if (needed[id] && !isInline(ir[id])) intervalStatement(id);
        text += "    vec3 reach = max(abs(lo), abs(hi));\n    return iMargin(" + interval(root) +
                ", reach.x + reach.y + reach.z);\n}\n#endif\n";
    }

    void rows() {
        GlslStages stages(*this, program, false);
        text += "#ifdef FIELD_ROWS\n" + along();
        stages.planeFunction();
        stages.rowFunction();
        text += "float fieldAt(FieldRow row, float at) {\n";
        stages.unpack(1, "row");
        stages.define(2);
        text += "    return " + value(program.distance()) + ";\n}\n#endif\n";
    }

    void material(std::string_view section, std::string_view name,
                  const std::array<IrId, kSurfaceComponents>& surface) {
        const std::span<const IrId> roots(surface.data() + 1, painterComponent - 1);
        text += "#ifdef " + std::string(section) + "\nFieldMaterial " + std::string(name) + "(vec3 p) {\n";
        valueStatements(neededBy(roots));
        const auto scalar = [&](int component) { return value(surface[std::size_t(component)]); };
        const auto vector = [&](int first) {
            return "vec3(" + scalar(first) + ", " + scalar(first + 1) + ", " + scalar(first + 2) + ")";
        };
        text += "    return FieldMaterial(" + vector(baseColorComponent) + ", " + scalar(roughnessComponent) +
                ", " + scalar(metallicComponent) + ", " + vector(emissionComponent) + ", " +
                scalar(transmissionComponent) + ", " + scalar(iorComponent) + ", " +
                vector(absorptionComponent) + ");\n}\n#endif\n";
    }

    /// The part through which no light passes, where there is another.
    void opaque() {
        if (!program.transmits()) return;
        text += "#define FIELD_TRANSMITS\n";
        const std::span<const IrId> medium(program.surface.data() + iorComponent, 4);
        if (!std::ranges::all_of(medium, [&](IrId id) { return ir[id].op == Op::constant; }))
            text += "#define FIELD_MEDIA\n";
        valueFunction("FIELD_OPAQUE", "fieldOpaque", program.opaque[distanceComponent]);
        gradientFunction("FIELD_OPAQUE", "fieldOpaqueGradient", program.opaque[distanceComponent]);
        material("FIELD_OPAQUE", "fieldOpaqueMaterial", program.opaque);
    }

    const Program& program;
    const Ir& ir;
    bool usesNoise = false, usesSmoothMinimum = false;
};

}  // namespace

std::vector<uint32_t> fieldTexels(const Ir& ir) {
    if (ir.outlines().empty() && ir.splines().empty()) return volumeTexels(ir.volumes());
    std::vector<uint32_t> words;
    if (!ir.volumes().empty()) words = volumeTexels(ir.volumes());
    for (const OutlinePtr& outline : ir.outlines())
        for (const OutlineTexel& texel : outline->texels)
            words.insert(words.end(), texel.begin(), texel.end());
    for (const SplineTablePtr& spline : ir.splines())
        for (const SplineTexel& texel : spline->texels) words.insert(words.end(), texel.begin(), texel.end());
    return words;
}

std::string emitField(const Program& program) { return Emitter(program).run(); }

}  // namespace fw
