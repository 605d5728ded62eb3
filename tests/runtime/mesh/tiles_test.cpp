// Tiles joined are the mesh of the whole region, to the bit; and the commands that make, keep, share and join
// them.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <sys/file.h>
#include <unistd.h>
#include <cstdlib>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "graph/document/json.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/mesh/octahedral.h"
#include "runtime/play/tiled_mesh.h"
#include "tests/support/command.h"
#include "tests/support/gpu.h"
#include "tests/support/graph/random_graph.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::tiles_test {

namespace fs = std::filesystem;
using test::CommandOptions;
using test::CommandResult;
using test::expectRefusal;
using test::runCommand;
using test::TempDir;

/// Position, normal and colour of the corners of every triangle, sorted.
using Corners = std::array<float, 27>;
std::vector<Corners> trianglesOf(const Mesh& mesh) {
    std::vector<Corners> triangles;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        Corners corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const uint32_t v = mesh.indices[i + k];
            std::memcpy(&corners[9 * k], &mesh.positions[v], 12);
            std::memcpy(&corners[9 * k + 3], &mesh.normals[v], 12);
            if (!mesh.colors.empty()) std::memcpy(&corners[9 * k + 6], &mesh.colors[v], 12);
        }
        triangles.push_back(corners);
    }
    std::sort(triangles.begin(), triangles.end(),
              [](const Corners& a, const Corners& b) { return std::memcmp(&a, &b, sizeof a) < 0; });
    return triangles;
}

/// All pieces in one, and that each part tells the same of them.
Mesh gathered(const MeshPieces& pieces) {
    Mesh whole;
    for (std::size_t i = 0; i < pieces.count; ++i) {
        const Result<Mesh> piece = pieces.load(i, MeshPieces::numbered),
                           corners = pieces.load(i, MeshPieces::corners);
        if (!piece || !corners) throw SystemError("a tile cannot be loaded");
        whole.positions.insert(whole.positions.end(), piece->positions.begin(), piece->positions.end());
        whole.normals.insert(whole.normals.end(), piece->normals.begin(), piece->normals.end());
        whole.colors.insert(whole.colors.end(), piece->colors.begin(), piece->colors.end());
        EXPECT_EQ(piece->indices.size(), corners->indices.size());
        whole.indices.insert(whole.indices.end(), piece->indices.begin(), piece->indices.end());
    }
    EXPECT_EQ(whole.positions.size(), pieces.vertexCount);
    EXPECT_EQ(whole.indices.size(), 3 * pieces.triangleCount);
    return whole;
}

struct Tiled {
    Mesh mesh;
    std::size_t tiles = 0;
    bool capped = false;
};
Tiled tiledMesh(Session& session, const MeshRequest& request, int tileCells) {
    const TempDir folder;
    const Result<Box> region = meshRegion(session.program(), request);
    const Result<CellGrid> grid = cellGrid(*region, request.resolution);
    const TilePlan plan = planTiles(*grid, tileCells);
    const uint64_t key = tileKey(session, request, plan);
    Tiled result{{}, plan.tiles.size()};
    std::vector<TileRecord> tiles;
    for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
        const Result<TileRecord> tile =
            meshTile(session, request, plan, key, i, folder.folder.string(), nullptr);
        if (!tile) throw SystemError(format(tile.error()));
        result.capped = result.capped || tile->header.capped;
        tiles.push_back(*tile);
    }
    const Result<MeshPieces> pieces = joinTiles(std::move(tiles));
    if (!pieces) throw SystemError(format(pieces.error()));
    result.mesh = gathered(*pieces);

    // The same of tiles that are counted and meshed again.
    const Result<CountedTiles> counted = countTiles(session, request, plan);
    if (!counted) throw SystemError(format(counted.error()));
    const Mesh again = gathered(counted->mesh);
    EXPECT_EQ(counted->capped, result.capped);
    EXPECT_EQ(counted->mesh.least, pieces->least);
    EXPECT_EQ(counted->mesh.greatest, pieces->greatest);
    EXPECT_EQ(counted->mesh.colors, pieces->colors);
    EXPECT_EQ(counted->mesh.material.baseColor, pieces->material.baseColor);
    EXPECT_TRUE(again.positions == result.mesh.positions && again.normals == result.mesh.normals);
    EXPECT_TRUE(again.colors == result.mesh.colors && again.indices == result.mesh.indices);
    return result;
}

/// Meshes both ways and compares; false if there is no surface.
bool expectTilesMakeUpTheWhole(Session& session, const MeshRequest& request, int tileCells = 64) {
    const Result<MesherResult> result = session.polygonise(request);
    if (!result) throw SystemError(format(result.error()));
    if (result->triangles == 0) return false;
    Mesh whole = session.download(*result);
    if (result->creases)  // whose normals tiles keep as the mesher packs them
        for (glm::vec3& normal : whole.normals) normal = unpackOctahedral(packOctahedral(normal));
    const Tiled tiled = tiledMesh(session, request, tileCells);
    EXPECT_GE(tiled.tiles, 2u);
    EXPECT_EQ(tiled.mesh.positions.size(), whole.positions.size());
    EXPECT_TRUE(trianglesOf(tiled.mesh) == trianglesOf(whole));
    EXPECT_EQ(tiled.capped, result->capped);
    const Report report = reportOnMesh(tiled.mesh.positions, tiled.mesh.indices);
    EXPECT_EQ(report.boundaryEdges + report.nonManifoldEdges + report.flippedEdges, 0u);
    return true;
}

Session sessionOf(Program program, FieldBy by = FieldBy::kernels) {
    Result<Device> device = createDevice({});
    if (!device) throw SystemError(format(device.error()));
    Session session(std::move(*device), by);
    session.setProgram(std::move(program));
    return session;
}

Program programOf(const Graph& graph) {
    Result<Program> program = compile(graph);
    if (!program) throw SystemError(format(program.error()));
    return std::move(*program);
}

std::string samplePath(const std::string& name) {
    return FIELDWRIGHT_SOURCE_DIR "/samples/" + name + ".field.json";
}

TEST(Tiles, MakeUpTheWholeMesh) {
    int number = 0;  // every other without FIELDWRIGHT_LONG
    for (const char* name : {"tower", "csg_part", "menger", "brick_block", "dusk_city", "gyroid_sphere"}) {
        if (number++ % 2 != 0 && !std::getenv("FIELDWRIGHT_LONG")) continue;
        const Result<Graph> graph = readGraph(samplePath(name), nullptr);
        ASSERT_TRUE(graph);
        Session session = sessionOf(programOf(*graph));
        for (const int cells : {96, 135, 193}) {
            if (cells == 193 && name != std::string("menger")) continue;
            SCOPED_TRACE(std::string(name) + " at " + std::to_string(cells));
            EXPECT_TRUE(expectTilesMakeUpTheWhole(session, {{}, cells}));
        }
        SCOPED_TRACE(std::string(name) + ", capped");
        const Box box = *meshRegion(session.program(), {{}, 96});
        Box part = box;
        for (int axis = 0; axis < 3; ++axis) {
            part.lo[axis] += 0.31 * (box.hi[axis] - box.lo[axis]);
            part.hi[axis] -= 0.12 * (box.hi[axis] - box.lo[axis]);
        }
        EXPECT_TRUE(expectTilesMakeUpTheWhole(session, {part, 128}));
        EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
    }
}

TEST(Tiles, OfRandomGraphsMakeUpTheWholeMesh) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const int most = std::getenv("FIELDWRIGHT_LONG") ? 8 : 4;
    int meshed = 0, capped = 0;
    for (uint32_t seed = 1; meshed < most; ++seed) {
        ASSERT_LT(seed, 200u);
        std::optional<Program> program = test::randomProgram(seed, 12);
        if (!program) continue;
        SCOPED_TRACE("seed " + std::to_string(seed));
        Session session = sessionOf(std::move(*program));
        MeshRequest request{Box{{-2.03, -1.98, -2.01}, {1.97, 2.02, 1.99}}, 97};
        if (!expectTilesMakeUpTheWhole(session, request)) continue;
        request.method = MeshMethod::dualContouring;
        EXPECT_TRUE(expectTilesMakeUpTheWhole(session, request));
        ++meshed;
        capped += session.polygonise(request)->capped ? 1 : 0;
    }
    EXPECT_GT(capped, 0);
}

TEST(Tiles, ByTapesMakeUpTheWholeMesh) {
    for (const char* name : {"mushroom", "brick_block", "worn_steps"}) {
        SCOPED_TRACE(name);
        const Result<Graph> graph = readGraph(samplePath(name), nullptr);
        ASSERT_TRUE(graph);
        Program program = programOf(*graph);
        program.method = MeshMethod::marchingCubes;
        program.stages.clear();
        Session session = sessionOf(std::move(program), FieldBy::tapes);
        for (const MeshMethod method : {MeshMethod::marchingCubes, MeshMethod::dualContouring})
            EXPECT_TRUE(expectTilesMakeUpTheWhole(session, {{}, 135, method}));
        EXPECT_TRUE(session.byTapes());
    }
}

TEST(Tiles, OfDualContouringMakeUpTheWholeMesh) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    int number = 0;  // every other without FIELDWRIGHT_LONG
    for (const char* name : {"tower", "csg_part", "menger", "gyroid_sphere", "dusk_city", "island"}) {
        if (number++ % 2 != 0 && !std::getenv("FIELDWRIGHT_LONG")) continue;
        SCOPED_TRACE(name);
        const Result<Graph> graph = readGraph(samplePath(name), nullptr);
        ASSERT_TRUE(graph);
        Session session = sessionOf(programOf(*graph));
        EXPECT_TRUE(expectTilesMakeUpTheWhole(session, {{}, 135, MeshMethod::dualContouring}));
        const Box box = *meshRegion(session.program(), {{}, 96});
        Box part = box;
        for (int axis = 0; axis < 3; ++axis) part.hi[axis] -= 0.32 * (box.hi[axis] - box.lo[axis]);
        EXPECT_TRUE(expectTilesMakeUpTheWhole(session, {part, 129, MeshMethod::dualContouring}));
        EXPECT_EQ(session.device().validationMessages(), std::vector<std::string>());
    }
}

TEST(Tiles, BlocksAreCulledInTilesToo) {
    // A tile long enough for blocks to be culled before bricks, of a region that is not a cube.
    const Result<Graph> graph = readGraph(samplePath("tower"), nullptr);
    Session session = sessionOf(programOf(*graph));
    EXPECT_TRUE(expectTilesMakeUpTheWhole(session, {Box{{-2, -0.4, -0.3}, {2, 0.4, 0.4}}, 1100}, 576));
}

TEST(Tiles, ThatDoNotMeetAreRefused) {
    const Result<Graph> graph = readGraph(samplePath("gyroid_sphere"), nullptr);
    Session session = sessionOf(programOf(*graph));
    const TempDir folder;
    const MeshRequest request{Box{{-1, -1, -1}, {1, 1, 1}}, 128};
    const TilePlan plan = planTiles(*cellGrid(*request.region, request.resolution), 64);
    std::vector<TileRecord> tiles;
    for (std::size_t i = 0; i < plan.tiles.size(); ++i) {
        const Result<TileRecord> tile =
            meshTile(session, request, plan, 1, i, folder.folder.string(), nullptr);
        ASSERT_TRUE(tile);
        tiles.push_back(*tile);
    }
    EXPECT_TRUE(joinTiles(tiles));
    tiles.erase(tiles.begin() + 5);
    const Result<MeshPieces> hole = joinTiles(tiles);
    ASSERT_FALSE(hole);
    EXPECT_NE(hole.error().message.find("do not fit together"), std::string::npos);
}

TEST(Tiles, OfAnotherVersionOfTheAlgorithmsAreNotUsed) {
    const Result<Graph> graph = readGraph(samplePath("gyroid_sphere"), nullptr);
    Session session = sessionOf(programOf(*graph));
    const TempDir folder;
    const MeshRequest request{Box{{-1, -1, -1}, {1, 1, 1}}, 128};
    const TilePlan plan = planTiles(*cellGrid(*request.region, request.resolution), 64);
    const uint64_t present = tileKey(session, request, plan);
    const uint64_t former = tileKey(session, request, plan, kAlgorithmVersion + 1);
    ASSERT_TRUE(meshTile(session, request, plan, former, 0, folder.folder.string(), nullptr));
    EXPECT_TRUE(doneTile(folder.folder.string(), plan, former, 0));
    EXPECT_FALSE(doneTile(folder.folder.string(), plan, present, 0));
}

TEST(Tiles, PlansCoverTheGrid) {
    for (const glm::ivec3 cells :
         {glm::ivec3(1), {63, 64, 65}, {95, 96, 97}, {127, 128, 129}, {2048, 7, 1300}}) {
        for (const int size : {1, 64, 100, 512}) {
            const TilePlan plan = planTiles({{}, glm::vec3(1), cells}, size);
            EXPECT_EQ(plan.tileCells % kLeastTile, 0);
            int64_t blocks = 0;
            const glm::ivec3 all = (cells + 2 + 63) / 64;
            for (const MesherTile& tile : plan.tiles) {
                int64_t own = 1;
                for (int axis = 0; axis < 3; ++axis) {
                    const int end = tile.end[axis] ? tile.end[axis] : all[axis];
                    EXPECT_LT(tile.begin[axis], end);
                    EXPECT_LE(tile.begin[axis] * 64, cells[axis]);  // a face is never on the region's own
                    own *= end - tile.begin[axis];
                }
                blocks += own;
            }
            EXPECT_EQ(blocks, int64_t(all.x) * all.y * all.z);
        }
    }
}

struct TilesCommand : testing::Test {
    TempDir folder;
    std::string graph = samplePath("gyroid_sphere");
    std::vector<std::string> to(const std::string& name, std::vector<std::string> more = {},
                                const std::string& resolution = "130") const {
        std::vector<std::string> words = {"export",       graph,      "-o",      folder.path(name),
                                          "--resolution", resolution, "--tiles", "2"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    void expectDone(const std::vector<std::string>& words, const CommandOptions& options = {}) const {
        const CommandResult result = runCommand(words, options);
        EXPECT_EQ(result.status, 0) << result.errors;
        EXPECT_EQ(result.errors, "");
    }
    std::string bytes(const std::string& name) const { return test::readText(folder.path(name)); }
    /// What one export in tiles gives.
    std::string expected(const std::string& name = "a.ply") const {
        expectDone(to(name));
        const std::string content = bytes(name);
        fs::remove(folder.path(name));
        EXPECT_TRUE(folder.names().empty());
        return content;
    }
};

/// Of one format without FIELDWRIGHT_LONG.
TEST_F(TilesCommand, FilesHoldTheSameMeshAsWithoutTiles) {
    fs::create_directory(folder.path("whole"));
    for (const char* name : {"a.ply", "a.stl", "a.glb", "a.gltf", "a.obj"}) {
        if (name != std::string("a.gltf") && !std::getenv("FIELDWRIGHT_LONG")) continue;
        SCOPED_TRACE(name);
        const std::string path = folder.path(name), other = folder.path(std::string("whole/") + name);
        expectDone(to(name));
        expectDone({"export", graph, "-o", other, "--resolution", "130"});
        const Result<Report> tiled = reportOnFile(path, {}), whole = reportOnFile(other, {});
        ASSERT_TRUE(tiled && whole);
        EXPECT_EQ(tiled->triangles, whole->triangles);
        EXPECT_EQ(tiled->vertices, whole->vertices);
        EXPECT_EQ(tiled->boundaryEdges + tiled->nonManifoldEdges + tiled->flippedEdges, 0u);
        EXPECT_NEAR(tiled->volume, whole->volume, 1e-9);
        if (name != std::string("a.obj")) {  // whose numbers are text
            EXPECT_EQ(fs::file_size(path), fs::file_size(other));
        }
    }
    expectRefusal(runCommand(to("a.3mf")), 2, {"a.3mf: error", ".ply, .stl, .obj, .glb or .gltf"});
    expectDone(to("b.ply", {"--method", "dual-contouring", "--require", "closed,manifold"}));
    EXPECT_FALSE(fs::exists(folder.path("b.ply.tiles")));
}

TEST_F(TilesCommand, AreMeasuredAsTheWholeIs) {
    if (!std::getenv("FIELDWRIGHT_LONG")) GTEST_SKIP() << "a quarter of a minute: with FIELDWRIGHT_LONG";
    const auto content = [&](const char* name) { return nlohmann::json::parse(bytes(name)); };
    expectDone({"export", graph, "-o", folder.path("whole.ply"), "--resolution", "130", "--report",
                folder.path("whole.json")});
    expectDone(to("a.ply", {"--report", folder.path("a.json"), "--require", "closed,manifold,error=0.1"}));
    expectDone(to("all.part", {"--tile", "1/1"}));
    expectDone({"merge", folder.path("all.part"), "-o", folder.path("merged.ply"), "--report",
                folder.path("merged.json"), "--require", "closed"});
    const nlohmann::json whole = content("whole.json"), tiled = content("a.json"),
                         merged = content("merged.json");
    for (const char* key : {"vertices", "triangles", "shells", "cavities", "boundaryEdges",
                            "nonManifoldEdges", "eulerCharacteristic", "selfIntersections", "capped"}) {
        EXPECT_EQ(tiled[key], whole[key]) << key;
        EXPECT_EQ(merged[key], whole[key]) << key;
    }
    EXPECT_NEAR(tiled["area"], whole["area"], 1e-9);
    EXPECT_TRUE(tiled["surfaceToMeshMean"].is_number());
    EXPECT_TRUE(merged["surfaceToMeshMean"].is_null());

    // What is not as it must be is written all the same, and told.
    const CommandResult loose = runCommand(to("b.ply", {"--require", "error=1e-9"}));
    EXPECT_EQ(loose.status, 1);
    EXPECT_NE(loose.errors.find("not error=1e-09"), std::string::npos) << loose.errors;
    EXPECT_TRUE(fs::exists(folder.path("b.ply")));
    // A part is no mesh, and holds no field.
    expectRefusal(runCommand(to("b.part", {"--tile", "1/2", "--require", "closed"})), 2,
                  {"fieldwright merge"});
    expectRefusal(
        runCommand({"merge", folder.path("all.part"), "-o", folder.path("c.ply"), "--require", "error=0.1"}),
        2, {"c.ply: error", "fieldwright export"});
    expectRefusal(runCommand({"merge", folder.path("all.part"), "-o", folder.path("c.ply"), "--report",
                              folder.path("c.ply")}),
                  2, {"two outputs"});
    EXPECT_FALSE(fs::exists(folder.path("c.ply")));
}

TEST_F(TilesCommand, PartsMergeToTheSameBytes) {
    const std::string whole = expected();
    std::vector<std::string> parts;
    for (const char* part : {"3", "1", "2"}) {
        const std::string name = std::string(part) + ".part";
        expectDone(to(name, {"--tile", std::string(part) + "/3"}));
        parts.push_back(folder.path(name));
    }
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"1.part", "2.part", "3.part"}));
    const auto merge = [&](const std::vector<std::string>& of) {
        std::vector<std::string> words{"merge", "-o", folder.path("a.ply")};
        words.insert(words.end(), of.begin(), of.end());
        return words;
    };
    expectDone(merge(parts));
    EXPECT_TRUE(bytes("a.ply") == whole);
    fs::remove(folder.path("a.ply"));

    expectRefusal(runCommand(merge({parts[1]})), 1, {"2 of the 3 parts are missing: 2, 3"});
    expectRefusal(runCommand(merge({parts[0], parts[1], parts[0]})), 1, {"part 3 is also in"});
    expectDone({"export", graph, "-o", folder.path("foreign.part"), "--resolution", "131", "--tiles", "2",
                "--tile", "2/3"});
    expectRefusal(runCommand(merge({parts[0], parts[1], folder.path("foreign.part")})), 1,
                  {"foreign.part: error", "another mesh"});
    expectRefusal(runCommand(merge({graph})), 1, {"not a part"});
    expectRefusal(runCommand(merge({folder.path("none.part")})), 1, {"none.part: error", "cannot read"});
    const std::string part = bytes("2.part");
    for (const std::size_t size :
         {std::size_t(0), std::size_t(10), std::size_t(100), part.size() / 2, part.size() - 1}) {
        test::writeText(folder.path("cut.part"), part.substr(0, size));
        expectRefusal(runCommand(merge({parts[0], parts[1], folder.path("cut.part")})), 1,
                      {"cut.part: error", "cut short"});
    }
    for (const std::size_t at : {std::size_t(50), std::size_t(100), part.size() / 3, part.size() - 3}) {
        std::string flipped = part;
        flipped[at] ^= 8;
        test::writeText(folder.path("flipped.part"), flipped);
        expectRefusal(runCommand(merge({parts[0], parts[1], folder.path("flipped.part")})), 1,
                      {"flipped.part: error", "make it again"});
    }
    CommandOptions quota;
    quota.maxFileBytes = 100'000;
    test::writeText(folder.path("a.ply"), "before");
    expectRefusal(runCommand(merge(parts), quota), 3, {"a.ply: error"});
    EXPECT_EQ(bytes("a.ply"), "before");

    expectRefusal(runCommand(to("a.ply", {"--tile", "1/3"})), 2, {"a.ply: error", ".part"});
    expectRefusal(runCommand(to("a.part", {"--tile", "0/3"})), 2, {"--tile '0/3'", "i/n"});
    expectRefusal(runCommand(to("a.part", {"--tile", "1/9"})), 2, {"too few tiles, 8, for 9 parts"});
    EXPECT_FALSE(fs::exists(folder.path("a.part.tiles")));
}

TEST_F(TilesCommand, OfAPartGoOnWhereTheyWereStopped) {
    const std::string name = "a.part";
    const auto part = [&](const char* resolution = "130") { return to(name, {"--tile", "1/1"}, resolution); };
    expectDone(part());
    const std::string whole = bytes(name);
    fs::remove(folder.path(name));
    // The tiles fit, the part does not.
    CommandOptions quota;
    quota.maxFileBytes = static_cast<long>(whole.size() / 2);
    const auto stop = [&] {
        const CommandResult result = runCommand(part(), quota);
        EXPECT_EQ(result.status, 3);
        EXPECT_NE(result.errors.find("goes on from there"), std::string::npos) << result.errors;
        EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.part.tiles"}));
    };
    const auto files = [&] {
        std::vector<fs::path> tiles;
        for (const auto& entry : fs::directory_iterator(folder.path("a.part.tiles")))
            tiles.push_back(entry.path());
        std::sort(tiles.begin(), tiles.end());
        return tiles;
    };
    stop();
    ASSERT_EQ(files().size(), 8u);
    fs::remove(files()[3]);
    fs::resize_file(files()[1], 1000);
    test::writeText(folder.path("a.part.tiles/.64-000002.tile.1-1.tmp"), "of a killed process");
    expectDone(part());
    EXPECT_TRUE(bytes(name) == whole);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.part"}));
    fs::remove(folder.path(name));

    // What is there is taken, but for a tile that is damaged.
    stop();
    std::fstream(files()[0], std::ios::in | std::ios::out | std::ios::binary)
        .seekp(static_cast<std::streamoff>(fs::file_size(files()[0]) - 12))
        .write("\0\0\0\0\0\0\0\0\0\0\0\0", 12);
    std::vector<fs::file_time_type> written;
    for (const fs::path& file : files()) written.push_back(fs::last_write_time(file));
    stop();
    for (std::size_t i = 0; i < written.size(); ++i)
        EXPECT_EQ(fs::last_write_time(files()[i]) == written[i], i != 0) << i;
    expectDone(part());
    EXPECT_TRUE(bytes(name) == whole);
    fs::remove(folder.path(name));

    // Unless it is of another mesh.
    stop();
    expectDone(part("129"));
    EXPECT_FALSE(bytes(name) == whole);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.part"}));
}

TEST_F(TilesCommand, AFullQuotaLeavesNothing) {
    test::writeText(folder.path("a.ply"), "before");
    CommandOptions quota;
    quota.maxFileBytes = 20'000;
    expectRefusal(runCommand(to("a.ply"), quota), 3, {"a.ply: error", "cannot write"});
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.ply"}));
    EXPECT_EQ(bytes("a.ply"), "before");
    expectRefusal(runCommand(to("none/b.ply")), 3, {"none/b.ply: error", "cannot create"});

    const auto part = [&](const std::string& name) { return to(name, {"--tile", "1/1"}); };
    expectRefusal(runCommand(part("a.part"), quota), 3,
                  {"a.part.tiles/64-000000.tile: error", "cannot write"});
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.ply"}));
    test::writeText(folder.path("b.part.tiles"), "a file in the way");
    expectRefusal(runCommand(part("b.part")), 3, {"b.part.tiles: error", "folder for the tiles"});
    expectRefusal(runCommand(part("none/b.part")), 3, {"none/b.part: error", "cannot create"});
}

TEST_F(TilesCommand, AreTakenAboveAThousandCellsWhereTheyCanBe) {
    // In tiles vertices come in another order.
    const auto written = [&](const std::string& name, const char* resolution,
                             const std::vector<std::string>& more = {}) {
        std::vector<std::string> words = {"export",   graph,      "-o",  folder.path(name), "--resolution",
                                          resolution, "--region", "-1",  "-0.03",           "-0.03",
                                          "1",        "0.03",     "0.03"};
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_EQ(runCommand(words).status, 0);
        return bytes(name);
    };
    EXPECT_TRUE(written("a.ply", "1200") == written("a.ply", "1200", {"--tiles", "5"}));
    EXPECT_FALSE(written("a.ply", "1024") == written("a.ply", "1024", {"--tiles", "4"}));
}

TEST_F(TilesCommand, AreTakenWhereTheSurfaceIsTooMuchAtOnce) {
    const std::string dense = folder.path("dense.field.json"), mesh = folder.path("a.ply");
    test::writeText(dense, R"({"fieldwright": 1, "nodes": [
        {"id": "weave", "type": "gyroid", "inputs": {"period": 0.03, "thickness": 0.008}},
        {"id": "out", "type": "output", "inputs": {"surface": {"from": "weave"}}}]})");
    const std::vector<std::string> box = {"--resolution", "1024", "--region", "-1",  "-1",
                                          "-0.35",        "1",    "1",        "0.35"};
    const auto to = [&](const std::string& name) {
        std::vector<std::string> words{"export", dense, "-o", folder.path(name)};
        words.insert(words.end(), box.begin(), box.end());
        return runCommand(words);
    };
    const CommandResult whole = to("a.3mf");
    if (whole.status == 0) GTEST_SKIP() << "this device can number more bricks";
    EXPECT_EQ(whole.status, 1);
    EXPECT_NE(whole.errors.find("bricks"), std::string::npos) << whole.errors;
    EXPECT_NE(whole.errors.find("in tiles"), std::string::npos) << whole.errors;
    EXPECT_EQ(to("a.ply").status, 0);
    EXPECT_GT(fs::file_size(mesh), 50'000'000u);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.ply", "dense.field.json"}));
}

TEST_F(TilesCommand, TwoThatMakeOnePartDoNotMeet) {
    const std::vector<std::string> part = to("a.part", {"--tile", "1/1"});
    fs::create_directory(folder.path("a.part.tiles"));
    const int other = ::open(folder.path("a.part.tiles").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    ASSERT_EQ(::flock(other, LOCK_EX), 0);
    test::expectRefusal(runCommand(part), 3,
                        {"a.part.tiles", "another command is writing this mesh's tiles"});
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.part.tiles"}));
    ::close(other);
    expectDone(part);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.part"}));
}

TEST_F(TilesCommand, InterruptedLeaveNothingOrThePartsThatAreDone) {
    const auto interrupted = [&](const std::vector<std::string>& words, int signal, const char* at) {
        CommandOptions options;
        options.signal = signal;
        options.interruptAt = at;
        return runCommand(words, options);
    };
    for (const auto& [signal, status] : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)})
        for (const char* at : {"tile 1 of", "tile 8 of", "write"}) {
            SCOPED_TRACE(at);
            const CommandResult result = interrupted(to("a.ply"), signal, at);
            EXPECT_EQ(result.status, status) << result.errors;
            EXPECT_TRUE(folder.names().empty());
        }
    const std::vector<std::string> part = to("a.part", {"--tile", "1/1"});
    expectDone(part);
    const std::string whole = bytes("a.part");
    fs::remove(folder.path("a.part"));
    const CommandResult result = interrupted(part, SIGINT, "tile 8 of");
    EXPECT_EQ(result.status, 130) << result.errors;
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.part.tiles"}));
    expectDone(part);
    EXPECT_TRUE(bytes("a.part") == whole);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.part"}));
}

}  // namespace fw::tiles_test
