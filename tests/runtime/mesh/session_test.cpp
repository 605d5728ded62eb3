// A session whose program is replaced while it works: a mesh at once, the kernels' own mesh when they are
// ready.
#include "runtime/play/session.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <glm/geometric.hpp>
#include <thread>

#include "graph/compile/effort.h"
#include "graph/document/json.h"
#include "runtime/measure/mesh_report.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/expression_graph.h"

namespace fw::session_test {

Program sample(const std::string& name) {
    const Result<Graph> graph = readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/" + name + ".field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

/// A session on a device of its own, as a program has it.
Session openSession(FieldBy by = FieldBy::sooner) {
    Result<Device> device = createDevice({});
    if (!device) throw SystemError(format(device.error()));
    return Session(std::move(*device), by);
}

/// A ball under as many waves of unlike directions: about fourteen operations each.
Program wavyBall(int waves) {
    std::string code = "return length(p) - 1.0";
    for (int i = 0; i < waves; ++i) {
        char wave[120];
        std::snprintf(wave, sizeof wave, " + %.6f * sin(dot(p, vec3(%.3f, %.3f, %.3f)))", 0.3 / waves,
                      1 + 0.01 * i, 8 - 0.013 * i, 3 + 0.017 * (i % 37));
        code += wave;
    }
    const Result<Graph> graph =
        parseGraph(R"({"fieldwright": 1, "nodes": [{"id": "ball", "type": "expression", "code": ")" + code +
                       R"(;"}, {"id": "out", "type": "output", "inputs": {"surface": {"from": "ball"}}}]})",
                   "waves.field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

Mesh meshOf(Session& session) {
    const Result<MesherResult> result = session.polygonise({std::nullopt, 48});
    if (!result) throw SystemError(format(result.error()));
    return session.download(*result);
}

void expectClosed(const Mesh& mesh) {
    const Report report = reportOnMesh(mesh.positions, mesh.indices);
    EXPECT_GT(report.triangles, 100u);
    EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges + report.nonManifoldVertices, 0u);
}

void waitForKernels(Session& session) {
    for (int i = 0; i < 6000 && session.compiling(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_FALSE(session.compiling());
    EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
}

TEST(Session, AReplacedProgramIsMeshedAtOnceAndThenByItsKernels) {
    Session waiting = openSession();
    waiting.setProgram(sample("csg_part"));
    const Mesh expected = meshOf(waiting);

    Session session = openSession();
    session.setProgram(sample("tower"));
    meshOf(session);
    session.replaceProgram(sample("csg_part"));
    EXPECT_TRUE(session.compiling());
    const Mesh first = meshOf(session);
    expectClosed(first);
    EXPECT_NEAR(double(first.positions.size()), double(expected.positions.size()),
                0.05 * double(expected.positions.size()));
    waitForKernels(session);
    const Mesh second = meshOf(session);
    EXPECT_EQ(second.positions, expected.positions);
    EXPECT_EQ(second.indices, expected.indices);
}

TEST(Session, OfManyReplacementsTheLastOneHolds) {
    Session session = openSession();  // that never had a program
    for (const char* name : {"tower", "menger", "csg_part", "tower", "gyroid_sphere"}) {
        session.replaceProgram(sample(name));
        expectClosed(meshOf(session));
    }
    Session moved = std::move(session);
    waitForKernels(moved);
    const Mesh last = meshOf(moved);
    Session waiting = openSession();
    waiting.setProgram(sample("gyroid_sphere"));
    EXPECT_EQ(last.positions, meshOf(waiting).positions);
}

TEST(Session, AReplacementOfTheSameStructureCompilesNothing) {
    Session session = openSession();
    session.setProgram(sample("tower"));
    session.replaceProgram(sample("tower"));
    EXPECT_FALSE(session.compiling());
}

TEST(Session, StagesRunBeforeTheKernelsAreThereAndAgainByThem) {
    Session waiting = openSession();
    waiting.setProgram(sample("worn_steps"));
    const Mesh expected = meshOf(waiting);
    Session session = openSession();
    session.replaceProgram(sample("worn_steps"));
    EXPECT_TRUE(session.compiling());
    const Mesh first = meshOf(session);
    expectClosed(first);
    EXPECT_EQ(first.triangleCount() % 4, 0u);
    waitForKernels(session);
    const Mesh second = meshOf(session);
    EXPECT_EQ(second.positions, expected.positions);
    EXPECT_EQ(second.colors, expected.colors);
    EXPECT_EQ(second.indices, expected.indices);
}

TEST(Session, TapesTakeWhatTheDriverWouldCompileForMinutes) {
    const Program program = wavyBall(1000);
    ASSERT_GT(secondsToCompile(program), kMostSecondsBehind);
    Session waiting = openSession();
    const std::size_t pipelines = waiting.device().record->pipelines;
    EXPECT_FALSE(waiting.setProgram(program));
    EXPECT_EQ(waiting.device().record->pipelines, pipelines);
    expectClosed(meshOf(waiting));
    EXPECT_TRUE(waiting.byTapes());

    Session behind = openSession();
    behind.replaceProgram(program);
    EXPECT_FALSE(behind.compiling() || behind.drafting()) << "nothing better will come";
    const Result<MesherResult> result = behind.polygonise({std::nullopt, 48});
    ASSERT_TRUE(result);
    Picture picture;
    RenderOptions options{.width = 64, .height = 48};
    EXPECT_TRUE(behind.renderLive(*result, options, &picture));
    options.show = RENDER_SLICE;
    const Result<bool> slice = behind.renderLive(*result, options, &picture);
    ASSERT_FALSE(slice);
    EXPECT_NE(slice.error().message.find("keep the driver busy"), std::string::npos);
    // A field of another size is the kernels' again.
    EXPECT_TRUE(waiting.setProgram(sample("tower")));
    expectClosed(meshOf(waiting));
    EXPECT_FALSE(waiting.byTapes());
}

TEST(Session, WhatWouldBeTracedForLongIsADraft) {
    std::string code = "d = 1e3;";
    for (int i = 0; i < 120; ++i)
        code += " d = min(d, max(length(p) - 1, perlin(p * " + std::to_string(2 + 0.01 * i) + ") + 0.2));";
    const Result<Program> program = compile(test::expressionGraph(code + " return d;"));
    ASSERT_TRUE(program) << format(program.error());
    ASSERT_FALSE(program->families.empty());
    Session sooner = openSession(), full = openSession(FieldBy::kernels);
    if (!sooner.device().software) GTEST_SKIP() << "a hardware device traces it at once";
    sooner.setProgram(*program);
    full.setProgram(*program);
    expectClosed(meshOf(sooner));
    expectClosed(meshOf(full));
    EXPECT_FALSE(sooner.byTapes());
    EXPECT_NE(sooner.whyDraft().find("light that is traced"), std::string::npos);
    EXPECT_EQ(full.whyDraft(), "");
    const Result<MesherResult> result = sooner.polygonise({std::nullopt, 32});
    ASSERT_TRUE(result);
    RenderOptions options{.width = 64, .height = 48, .samples = 2};
    EXPECT_TRUE(sooner.render(*result, options));
    options.show = RENDER_SLICE;  // always evaluates the field; a traced shadow would take a minute
    options.scene.sun.reset();
    EXPECT_TRUE(sooner.render(*result, options));
    sooner.setProgram(sample("tower"));
    meshOf(sooner);
    EXPECT_EQ(sooner.whyDraft(), "");
}

TEST(Session, KernelsAreCompiledWhereTapesWouldTakeLonger) {
    const Program program = wavyBall(120);
    const double compiling = secondsToCompile(program);
    ASSERT_GT(compiling, kMostSecondsToCompile);
    EXPECT_LT(secondsByTapes(program, 64), compiling);
    EXPECT_GT(secondsByTapes(program, kMostResolution), compiling);
}

TEST(Session, ColorsByTapesAreTheKernelsColors) {
    for (const char* name : {"mushroom", "island", "worn_steps"}) {
        SCOPED_TRACE(name);
        Session kernels = openSession(FieldBy::kernels), tapes = openSession(FieldBy::tapes);
        kernels.setProgram(sample(name));
        tapes.setProgram(sample(name));
        const Mesh expected = meshOf(kernels), ours = meshOf(tapes);
        EXPECT_TRUE(tapes.byTapes());
        ASSERT_EQ(ours.colors.size(), ours.positions.size());
        // Where a face lies on samples, its side is up to the last bits, which other devices round their way.
        if (!test::device().software && ours.positions.size() != expected.positions.size()) {
            EXPECT_NEAR(double(ours.indices.size()), double(expected.indices.size()),
                        0.01 * double(expected.indices.size()));
            continue;
        }
        ASSERT_EQ(ours.positions.size(), expected.positions.size());
        std::size_t other = 0;  // next to a border of two colours, a vertex may be of the other one
        for (std::size_t v = 0; v < ours.colors.size(); ++v)
            other += glm::distance(ours.colors[v], expected.colors[v]) > 0.01f;
        EXPECT_LT(double(other), 0.01 * double(ours.colors.size()));
    }
}

TEST(Session, ClosesWhileKernelsAreBeingCompiled) {
    Session session = openSession();
    session.replaceProgram(sample("menger"));
    EXPECT_TRUE(session.compiling());
}

}  // namespace fw::session_test
