// A session whose program is replaced while it works: a mesh at once, the kernels' own mesh when they are
// ready.
#include "runtime/play/session.h"

#include <gtest/gtest.h>

#include <thread>

#include "graph/document/json.h"
#include "runtime/measure/mesh_report.h"
#include "tests/support/gpu.h"

namespace fw {
namespace {

Program sample(const std::string& name) {
    const Result<Graph> graph = readGraph(FIELDWRIGHT_SOURCE_DIR "/samples/" + name + ".field.json", nullptr);
    if (!graph) throw SystemError(format(graph.error()));
    Result<Program> program = compile(*graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

/// A session on a device of its own, as a program has it.
Session openSession() {
    Result<Device> device = createDevice({});
    if (!device) throw SystemError(format(device.error()));
    return Session(std::move(*device));
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

TEST(Session, ClosesWhileKernelsAreBeingCompiled) {
    Session session = openSession();
    session.replaceProgram(sample("menger"));
    EXPECT_TRUE(session.compiling());
}

}  // namespace
}  // namespace fw
