// Lipschitz constants by which rays step: which one is used, and pictures of fields whose constant is proven,
// against values of the field on the CPU at many points of each ray.
#include "runtime/play/step_constant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <optional>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/evaluate/tape.h"
#include "runtime/measure/field_measure.h"
#include "runtime/play/session.h"
#include "runtime/render/view.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/expression_graph.h"

namespace fw::step_constant_test {

constexpr int kWidth = 96, kHeight = 72;
constexpr Box kCube{{-1, -1, -1}, {1, 1, 1}};

/// The distance of a ball in its box, times 0.05; with the square of the distance from it outside of the box.
const char* const kSteepOutside =
    "float r = length(p); return 0.05 * (r - 0.5) * (1.0 + 400.0 * max(r - 0.98, 0.0));";
/// A disc 0.04 m thick in its box. Above and below of it the field grows with the square of the distance.
const char* const kDisc =
    "float d = max(length(p.xz) - 0.8, abs(p.y) - 0.02); return d * (1.0 + 400.0 * max(abs(p.y) - 0.1, "
    "0.0));";

Program programOf(const Graph& graph, const std::map<std::string, std::string>& live = {}) {
    CompileOptions options;
    for (const auto& [node, input] : live) options.live.insert(node + "." + input);
    Result<Program> program = compile(graph, options);
    EXPECT_TRUE(program) << format(program.error());
    return std::move(*program);
}

Graph parsed(const std::string& nodes) {
    Result<Graph> graph = parseGraph(R"({"fieldwright": 1, "nodes": [)" + nodes + "]}", "", nullptr);
    EXPECT_TRUE(graph) << format(graph.error());
    return std::move(*graph);
}

const char* const kTwistedBlade = R"(
    {"id": "blade", "type": "box", "inputs": {"half_extents": [0.45, 0.8, 0.02]}},
    {"id": "twisted", "type": "twist", "inputs": {"surface": {"from": "blade"}, "rate": 720}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "twisted"}}})";

/// Values of a program's field in double along straight lines.
class Lines {
  public:
    explicit Lines(const Program& program)
        : tape(makeTape(program.ir, program.distance(), program.parameters())) {}

    /// The first of the points from `near` to `far` along the ray, `step` apart, at which the field is below
    /// `limit`.
    std::optional<double> firstBelow(double limit, const glm::dvec3& origin, const glm::dvec3& ray,
                                     double near, double far, double step) {
        constexpr std::size_t kPoints = TapeMachine<double>::kPoints;
        for (double from = near; from < far; from += step * double(kPoints)) {
            for (std::size_t i = 0; i < kPoints; ++i) {
                const glm::dvec3 p = origin + std::min(from + step * double(i), far) * ray;
                for (int axis = 0; axis < 3; ++axis) machine.position(axis)[i] = p[axis];
            }
            const double* values = machine.value(tape, kPoints);
            for (std::size_t i = 0; i < kPoints; ++i)
                if (values[i] < limit) return std::min(from + step * double(i), far);
        }
        return std::nullopt;
    }
    double at(const glm::dvec3& p) {
        for (int axis = 0; axis < 3; ++axis) machine.position(axis)[0] = p[axis];
        return machine.value(tape, 1)[0];
    }

  private:
    Tape tape;
    TapeMachine<double> machine;
};

/// Where a ray is within a box.
std::optional<std::pair<double, double>> within(const Box& box, const glm::dvec3& origin,
                                                const glm::dvec3& ray) {
    double near = 0.0, far = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.lo[std::size_t(axis)] - origin[axis]) / ray[axis],
                     b = (box.hi[std::size_t(axis)] - origin[axis]) / ray[axis];
        near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    return near < far ? std::optional(std::pair(near, far)) : std::nullopt;
}

struct Drawn {
    Picture picture;
    LightPicture light;
    gpu::View view;
    double constant;

    glm::dvec3 ray(int x, int y) const {
        const double u = (x + 0.5) / kWidth * 2 - 1, v = (y + 0.5) / kHeight * 2 - 1;
        return glm::dvec3(view.forward) + u * glm::dvec3(view.right) - v * glm::dvec3(view.up);
    }
};

Drawn draw(const Program& program, const Box& box, const Camera& camera, uint32_t show = RENDER_PICTURE) {
    Drawn drawn;
    drawn.constant = stepConstantWithin(program, box, kMaxStillConstant);
    Result<Device> device = createDevice({.validation = true});
    EXPECT_TRUE(device);
    const auto record = device->record;
    {
        Session session(std::move(*device), FieldBy::kernels);
        session.setProgram(program);
        const Result<MesherResult> mesh = session.polygonise({box, 96});
        EXPECT_TRUE(mesh) << format(mesh.error());
        const auto points =
            download<gpu::MeshVertex>(session.device(), session.meshBuffers().vertices, mesh->vertices);
        RenderOptions options{
            .width = kWidth, .height = kHeight, .samples = 1, .light = &drawn.light, .show = show};
        options.scene.camera = camera;
        if (show == RENDER_PICTURE)
            options.scene.ground.reset();
        else
            options.scene.ground->height = -0.4;
        options.scene.sun->traced = true, options.scene.sun->size = 0.1;
        drawn.view = cameraView(camera, boundsOf(points), float(kWidth) / kHeight);
        Result<Picture> picture = session.render(*mesh, options);
        EXPECT_TRUE(picture) << format(picture.error());
        drawn.picture = std::move(*picture);
    }
    for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
    return drawn;
}

/// Faults of a picture's depths: pixels in which the solid is missing or too far away, and pixels with a
/// depth at which the field is not 0.
struct Faults {
    int solid = 0, missing = 0, misplaced = 0;
};
Faults faultsOf(const Drawn& drawn, const Program& program, const Box& box) {
    Lines lines(program);
    Faults faults;
    const glm::dvec3 eye(drawn.view.eye);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const std::size_t at = std::size_t(y) * kWidth + std::size_t(x);
            const double depth = drawn.light.id[at] > kGroundId ? double(drawn.light.depth[at]) : 1e10;
            const glm::dvec3 ray = drawn.ray(x, y);
            const double length = glm::length(ray);
            const auto inside = within(box, eye, ray);
            if (!inside) continue;
            const double step = 0.002 / length;
            const auto first = lines.firstBelow(-5e-4, eye, ray, inside->first, inside->second, step);
            faults.solid += bool(first);
            faults.missing += first && depth > *first + step;
            if (depth < 1e9) faults.misplaced += lines.at(eye + depth * ray) > 0.03 * drawn.constant;
        }
    return faults;
}

TEST(StepConstant, PicturesHaveNoHoles) {
    struct Case {
        const char* name;
        Graph graph;
        Box box;
        double distance;
    };
    const Case cases[] = {{"twisted", parsed(kTwistedBlade), {{-0.55, -0.9, -0.55}, {0.55, 0.9, 0.55}}, 2.5},
                          {"steep outside",
                           test::expressionGraph(kSteepOutside),
                           {{-0.56, -0.56, -0.56}, {0.56, 0.56, 0.56}},
                           40.0}};
    for (const auto& [name, graph, box, distance] : cases) {
        SCOPED_TRACE(name);
        const Program program = programOf(graph);
        ASSERT_TRUE(std::isinf(program.exactness.lipschitz));
        Camera camera{.position = {0.62 * distance, 0.35 * distance, 0.7 * distance}};
        camera.fov = 360 / 3.14159265 * std::atan(1.0 / distance);
        const Drawn drawn = draw(program, box, camera);
        ASSERT_TRUE(std::isfinite(drawn.constant));
        const Faults faults = faultsOf(drawn, program, box);
        std::printf("%s: constant %.3f, %d pixels of the solid, %d missing, %d misplaced\n", name,
                    drawn.constant, faults.solid, faults.missing, faults.misplaced);
        EXPECT_GT(faults.solid, 500);
        EXPECT_EQ(faults.missing, 0);
        EXPECT_EQ(faults.misplaced, 0);
    }
}

/// Rays from the ground begin outside of the box in which the constant holds.
TEST(StepConstant, ShadowsOnTheGroundAreThoseOfTheSolid) {
    const Box box{{-0.9, -0.06, -0.9}, {0.9, 0.06, 0.9}};
    const Program program = programOf(test::expressionGraph(kDisc));
    const Drawn drawn = draw(program, box, {.position = {0.8, -0.1, 2.6}}, RENDER_SHADOW);
    ASSERT_NEAR(drawn.constant, 1.0, 1e-6);
    Lines lines(program);
    const Sun sun;
    const double azimuth = glm::radians(sun.azimuth), elevation = glm::radians(sun.elevation);
    const glm::dvec3 toSun(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                           std::cos(azimuth) * std::cos(elevation));
    const glm::dvec3 eye(drawn.view.eye);
    int shadowed = 0, lit = 0, wrong = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const std::size_t at = std::size_t(y) * kWidth + std::size_t(x);
            if (drawn.light.id[at] != kGroundId) continue;
            const glm::dvec3 p = eye + double(drawn.light.depth[at]) * drawn.ray(x, y);
            if (glm::length(glm::dvec2(p.x, p.z)) > 0.9) continue;  // the ground fades
            const auto inside = within(box, p, toSun);
            const bool hits =
                inside && lines.firstBelow(-0.01, p, toSun, inside->first, inside->second, 0.004);
            const bool misses =
                !inside || !lines.firstBelow(0.04, p, toSun, inside->first, inside->second, 0.01);
            const int shown = drawn.picture.pixels[4 * at];
            shadowed += hits, lit += misses;
            wrong += (hits && shown > 64) || (misses && shown < 192);
        }
    std::printf("%d pixels in the shadow, %d lit, %d wrong\n", shadowed, lit, wrong);
    EXPECT_GT(shadowed, 100);
    EXPECT_GT(lit, 100);
    EXPECT_EQ(wrong, 0);
}

TEST(StepConstant, FollowsLiveValuesAndTheBox) {
    Graph graph = parsed(R"(
        {"id": "field", "type": "expression", "inputs": {"k": 2.0},
         "code": "return k * (length(p) - 0.5) + max(length(p) - 2.0, 0.0) * 1000.0;"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}})");
    Program program = programOf(graph, {{"field", "k"}});
    ASSERT_EQ(program.live.size(), 1u);
    StepConstant constants;
    EXPECT_NEAR(constants.of(program, kCube, 8.0, true), 2.0, 1e-6);
    program.live[0].value = 4.0;
    EXPECT_NEAR(constants.of(program, kCube, 8.0, false), 4.0, 1e-6);
    program.live[0].value = 9.0;
    EXPECT_TRUE(std::isinf(constants.of(program, kCube, 8.0, true)));
    EXPECT_NEAR(constants.of(program, kCube, 16.0, true), 9.0, 1e-6);
    program.live[0].value = 2.0;
    EXPECT_TRUE(std::isinf(constants.of(program, {{-3, -3, -3}, {3, 3, 3}}, 8.0, true)));
    EXPECT_NEAR(constants.of(program, kCube, 8.0, true), 2.0, 1e-6);
    // A declared constant is used as it is.
    program.exactness.lipschitz = 100.0;
    EXPECT_EQ(constants.of(program, kCube, 8.0, true), 100.0);
}

/// The terms of this field's sum are 0, which intervals only show over small boxes. So a live frame of a
/// changed value finds a constant that is too large, and a view that rests begins again with the thorough
/// one.
TEST(StepConstant, ALiveViewThatRestsStepsByTheThoroughOne) {
    Program program = programOf(parsed(R"(
        {"id": "field", "type": "expression", "inputs": {"k": 0.5},
         "code": "float d = length(p) - k; for (int i = 0; i < 8; i++) { float x = p.x + 0.1 * i; d += 1.2 * ((x + 1) * (x + 1) - x * x - 2 * x - 1); } return d;"},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}})"),
                                {{"field", "k"}});
    ASSERT_GT(lipschitzWithin(program, kCube, kQuickSteps), kMaxLiveConstant);
    ASSERT_LT(lipschitzWithin(program, kCube), kMaxLiveConstant);
    Result<Device> device = createDevice({.validation = true});
    ASSERT_TRUE(device);
    const auto record = device->record;
    {
        Session session(std::move(*device), FieldBy::kernels);
        session.setProgram(std::move(program));
        RenderOptions options{.width = 32, .height = 24, .primary = Primary::measured};
        for (const double value : {0.5, 0.4}) {
            session.setParameter(0, value);
            const Result<MesherResult> mesh = session.polygonise({kCube, 16});
            ASSERT_TRUE(mesh) << format(mesh.error());
            const uint64_t moved = session.contentNumber();
            for (int frame = 0; frame < 7; ++frame) {
                const Result<bool> drawn = session.renderLive(*mesh, options, nullptr);
                ASSERT_TRUE(drawn) << format(drawn.error());
                EXPECT_TRUE(*drawn);
                EXPECT_EQ(session.contentNumber(), moved + (frame < 4 ? 0 : 1)) << frame;
            }
        }
    }
    for (const std::string& message : record->messages) ADD_FAILURE() << "validation layer: " << message;
}

TEST(StepConstant, ReportsHaveTheProvenOne) {
    const Program program = programOf(test::expressionGraph("return 2.3 * length(p) - 1.0;"));
    const MeasureOptions measure = measureOf(program, kCube);
    ASSERT_TRUE(measure.lipschitz);
    EXPECT_NEAR(*measure.lipschitz, 2.3, 1e-6);
    const std::vector<glm::vec3> positions = {{0.4f, 0, 0}, {0, 0.4f, 0}, {0, 0, 0.4f}};
    const std::vector<uint32_t> indices = {0, 1, 2};
    const Report report = reportOnMesh(positions, indices, measure);
    EXPECT_NE(reportWords(report).find("Field: at most 2.3-Lipschitz within the region"), std::string::npos)
        << reportWords(report);
    EXPECT_NE(writeReport(report).find("\"lipschitz\": 2.3"), std::string::npos);
    const Program jumps = programOf(test::expressionGraph("return length(p) - 0.5 + 0.1 * floor(p.x);"));
    const Report unknown = reportOnMesh(positions, indices, measureOf(jumps, kCube));
    EXPECT_EQ(reportWords(unknown).find("Lipschitz"), std::string::npos);
    EXPECT_EQ(writeReport(unknown).find("lipschitz"), std::string::npos);
}

}  // namespace fw::step_constant_test
