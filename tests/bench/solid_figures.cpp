#include "tests/bench/solid_figures.h"

#include "graph/document/json.h"
#include "runtime/play/player.h"
#include "runtime/play/session.h"

namespace fw::bench {
namespace {

constexpr int kSolidPoints = 100'000, kPictureSamples = 2;
int solidsMade = 0;

template <class Value>
Value orThrow(Result<Value> result) {
    if (!result) throw SystemError(format(result.error()));
    return std::move(*result);
}

}  // namespace

SolidFigures measureSolid(const Bench& bench, const SolidToMeasure& solid) {
    SolidFigures figures;
    const auto next = [&] {
        return orThrow(parseGraph(solid.text(1e-4 * ++solidsMade), solid.file, nullptr));
    };
    figures.compiling = measure(bench.options.repeats, [&] {
        const Graph graph = next();
        const auto start = Clock::now();
        Program program = orThrow(compile(graph));
        const double took = millisecondsSince(start);
        figures.program = std::move(program);
        return took;
    });
    std::vector<Point> points;
    for (int i = 0; i < kSolidPoints; ++i) points.push_back(solid.point(i));
    std::vector<double> values(points.size());
    figures.sampling = measure(bench.options.repeats, [&] {
        const auto start = Clock::now();
        evaluate(figures.program.ir, figures.program.distance(), {}, points, values);
        return 1e6 * millisecondsSince(start) / kSolidPoints;
    });
    Session session(orThrow(createDevice({.pick = bench.options.device})), FieldBy::kernels);
    session.setProgram(figures.program);
    figures.meshing = measure(bench.options.repeats, [&] {
        const auto start = Clock::now();
        figures.triangles = orThrow(session.polygonise({.region = {}, .resolution = solid.cells})).triangles;
        return millisecondsSince(start);
    });
    if (!solid.picture) return figures;
    Player player = orThrow(Player::create(next(), orThrow(createDevice({.pick = bench.options.device}))));
    const RenderOptions options{.width = 400, .height = 300, .samples = kPictureSamples};
    figures.picturing = measure(bench.options.repeats, [&] {
        const auto start = Clock::now();
        orThrow(player.frame(options));
        return millisecondsSince(start) / kPictureSamples;
    });
    return figures;
}

}  // namespace fw::bench
