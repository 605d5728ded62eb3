// Files of particles, out and in: the same particles in every format, read again by this program and by
// others; sequences of them; what is damaged.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "graph/assets/particle_file.h"
#include "runtime/export/points.h"
#include "tests/support/command.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::particle_files_test {

namespace fs = std::filesystem;

using test::CommandResult;
using test::expectRefusal;
using test::readText;
using test::runCommand;
using test::TempDir;

const std::string kFountain = R"({"fieldwright": 1, "nodes": [
    {"id": "jet", "type": "emitter", "inputs": {"rate": 400, "burst": 20, "lifetime": 0.5, "spread": 1}},
    {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "jet"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}],
  "timeline": {"length": 2, "fps": 30}})";

std::string readerOf(const std::string& path, const std::string& more = "") {
    return R"({"fieldwright": 1, "nodes": [
    {"id": "points", "type": "particle_file", "inputs": {"path": ")" +
           path + "\"" + more + R"(}},
    {"id": "field", "type": "particles_to_field", "inputs": {"particles": {"from": "points"}}},
    {"id": "out", "type": "output", "inputs": {"surface": {"from": "field"}}}],
  "timeline": {"length": 2, "fps": 30}})";
}

struct ParticleFiles : testing::Test {
    TempDir folder;
    std::string graph = folder.path("a.field.json");
    void SetUp() override { test::writeText(graph, kFountain); }
    CommandResult exported(const std::string& node, const std::string& file,
                           const std::vector<std::string>& more) const {
        std::vector<std::string> words = {"export", graph, "--particles", node, "-o", folder.path(file)};
        words.insert(words.end(), more.begin(), more.end());
        return runCommand(words);
    }
    Result<ParticlePlacesPtr> read(const std::string& file) const { return readParticlePlaces(graph, file); }
};

TEST_F(ParticleFiles, OfEveryFormatAreReadAgainBitForBit) {
    ASSERT_EQ(exported("jet", "p.ply", {"--time", "0.4"}).status, 0);
    const Result<ParticlePlacesPtr> ply = read("p.ply");
    ASSERT_TRUE(ply) << format(ply.error());
    EXPECT_GT((*ply)->places.size(), 100u);
    EXPECT_EQ((*ply)->velocities.size(), (*ply)->places.size());
    for (const char* file : {"p.vtk", "p.bgeo", "p.csv"}) {
        ASSERT_EQ(exported("jet", file, {"--time", "0.4"}).status, 0);
        const Result<ParticlePlacesPtr> other = read(file);
        ASSERT_TRUE(other) << format(other.error());
        EXPECT_EQ((*other)->places, (*ply)->places) << file;
        EXPECT_EQ((*other)->velocities, (*ply)->velocities) << file;
        EXPECT_EQ((*other)->ids, (*ply)->ids) << file;
        // What was read leaves again as it came.
        test::writeText(folder.path("b.field.json"), readerOf(file));
        const CommandResult again = runCommand(
            {"export", folder.path("b.field.json"), "--particles", "points", "-o", folder.path("again.ply")});
        ASSERT_EQ(again.status, 0) << again.errors;
        EXPECT_TRUE(readText(folder.path("again.ply")) == readText(folder.path("p.ply"))) << file;
    }
    // None at all.
    for (const char* file : {"n.ply", "n.vtk", "n.bgeo"}) {
        ASSERT_TRUE(exportPoints({}, folder.path(file)));
        const Result<ParticlePlacesPtr> none = read(file);
        ASSERT_FALSE(none);
        EXPECT_NE(none.error().message.find("has no places of particles"), std::string::npos)
            << none.error().message;
    }
}

TEST_F(ParticleFiles, AreReadByMeshio) {
    for (const char* file : {"p.ply", "p.vtk", "p.csv"})
        ASSERT_EQ(exported("jet", file, {"--time", "0.4"}).status, 0);
    test::writeText(folder.path("look.py"), R"(import sys, csv, numpy, meshio
rows = list(csv.DictReader(open(sys.argv[1] + "/p.csv")))
column = lambda *names: numpy.array([[float(row[n]) for n in names] for row in rows], dtype=numpy.float32)
vtk, ply = meshio.read(sys.argv[1] + "/p.vtk"), meshio.read(sys.argv[1] + "/p.ply")
assert len(rows) > 100
assert numpy.array_equal(vtk.points, column("x", "y", "z"))
assert numpy.array_equal(vtk.point_data["velocity"], column("vx", "vy", "vz"))
assert numpy.array_equal(vtk.point_data["id"].ravel(), column("id").ravel())
assert [(c.type, len(c.data)) for c in vtk.cells] == [("vertex", len(rows))]
assert numpy.array_equal(ply.points, column("x", "y", "z"))
assert numpy.array_equal(ply.point_data["vx"], column("vx").ravel())
assert numpy.array_equal(ply.point_data["id"], column("id").ravel())
# And what meshio writes comes in.
for binary in (True, False):
    meshio.vtk.write(sys.argv[1] + ("/b.vtk" if binary else "/t.vtk"), vtk, binary=binary)
print("fine")
)");
    const test::ProgramResult looked =
        test::runProgram("/usr/bin/python3 " + folder.path("look.py") + " " + folder.path("") + " 2>&1");
    EXPECT_NE(looked.output.find("fine"), std::string::npos) << looked.output;
    const Result<ParticlePlacesPtr> wanted = read("p.vtk");
    for (const char* file : {"b.vtk", "t.vtk"}) {
        const Result<ParticlePlacesPtr> other = read(file);
        ASSERT_TRUE(other) << format(other.error());
        EXPECT_EQ((*other)->places, (*wanted)->places) << file;
        EXPECT_EQ((*other)->velocities, (*wanted)->velocities) << file;
        EXPECT_EQ((*other)->ids, (*wanted)->ids) << file;
    }
}

/// What partio's writer makes of two particles with an attribute of text between their own.
TEST_F(ParticleFiles, OfPartioAreRead) {
    const auto big = [](std::initializer_list<uint32_t> words) {
        std::string bytes;
        for (const uint32_t word : words)
            for (int shift = 24; shift >= 0; shift -= 8) bytes += char(word >> shift);
        return bytes;
    };
    constexpr uint32_t kOne = 0x3f800000, kTwo = 0x40000000;
    const std::string kinds = std::string("\0\4kind\0\1", 8) + big({4, 1}) + std::string("\0\3wet", 5);
    const std::string file = "BgeoV" + big({5, 2, 0, 0, 0, 3, 0, 0, 0}) +
                             std::string("\0\10velocity\0\3", 12) + big({5, 0, 0, 0}) + kinds +
                             std::string("\0\2id\0\1", 6) + big({1, 0}) +
                             big({kOne, 0, 0, kOne, 0, kTwo, 0, 0, 40}) +
                             big({0, kTwo, 0, kOne, 0, 0, 0, 0, 41}) + std::string("\0\377", 2);
    const Result<FilePoints> points = parseParticlePlaces(file, "a.bgeo");
    ASSERT_TRUE(points) << format(points.error());
    EXPECT_EQ(points->places, (std::vector<glm::vec3>{{1, 0, 0}, {0, 2, 0}}));
    EXPECT_EQ(points->velocities, (std::vector<glm::vec3>{{0, 2, 0}, {0, 0, 0}}));
    EXPECT_EQ(points->ids, (std::vector<uint32_t>{40, 41}));
    for (std::size_t size = 0; size + 2 < file.size(); ++size)
        EXPECT_FALSE(parseParticlePlaces(file.substr(0, size), "a.bgeo")) << size;
}

TEST_F(ParticleFiles, ThatAreDamagedAreRefused) {
    for (const auto& [name, bytes, what] : std::vector<std::tuple<std::string, std::string, std::string>>{
             {"a.vtk", "ply\n", "is no legacy VTK file"},
             {"a.vtk", "# vtk DataFile Version 3.0\nt\nHEX\n", "neither ASCII nor BINARY"},
             {"a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n", "has no POINTS"},
             {"a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 9000000000 float\n", "is cut off"},
             {"a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 1 float\n0 0", "is cut off"},
             {"a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 1 float\n0 0 x\n",
              "where a number should be"},
             {"a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 1 colour\n0 0 0\n", "'colour'"},
             {"a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 1 float\n0 0 nan\n", "not a number"},
             {"a.vtk",
              "# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 1 float\n0 0 0\nPOINTS 2 float\n0 0 0 1 1 1\n",
              "POINTS twice"},
             {"a.bgeo", "x", "is no geometry of Houdini"},
             {"a.bgeo", "\x7fNSJ....", "newer form"},
             {"a.bgeo", "\x1f\x8b\x08", "is compressed"},
             {"a.bgeo", std::string("BgeoV\0\0\0\4", 9), "is of version 4"},
             {"a.bgeo", std::string("BgeoV\0\0\0\5\x7f", 10), "is cut off"},
             {"a.csv", "x,y,z,id\n1,2,3,cat\n", "has no id that is a whole number from 0 in line 2"},
             {"a.csv", "x,y,z,vx,vy,vz\n1,2,3,4,5\n", "has no velocity in line 2"},
             {"a.ply",
              "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
              "z\n"
              "property double id\nend_header\n0 0 0 1e30\n",
              "an id beyond 32 bits"}}) {
        const Result<FilePoints> points = parseParticlePlaces(bytes, name);
        ASSERT_FALSE(points) << what;
        EXPECT_NE(points.error().message.find(what), std::string::npos) << points.error().message;
        EXPECT_NE(points.error().message.find("'" + name + "'"), std::string::npos) << points.error().message;
    }
}

TEST_F(ParticleFiles, SequencesAreShownByTheirTime) {
    for (const std::string format : {"ply", "bgeo"}) {
        ASSERT_EQ(exported("jet", "frames", {"--to", "0.5", "--fps", "30", "--format", format}).status, 0);
        std::vector<std::string> wanted;
        for (int frame = 0; frame < 15; ++frame) {
            std::string number = std::to_string(frame);
            const std::string file = "frames/" + std::string(6 - number.size(), '0') + number + "." + format;
            if (format != "ply") {
                test::writeText(folder.path("c.field.json"), readerOf(file));
                ASSERT_EQ(runCommand({"export", folder.path("c.field.json"), "--particles", "points", "-o",
                                      folder.path("c.ply")})
                              .status,
                          0);
                wanted.push_back(readText(folder.path("c.ply")));
            } else {
                wanted.push_back(readText(folder.path(file)));
            }
        }
        fs::remove(folder.path("frames/000007." + format));
        fs::remove(folder.path("frames/000008." + format));
        for (const std::string pattern : {"frames/######.", "frames/%06d."}) {
            test::writeText(folder.path("b.field.json"), readerOf(pattern + format, R"(, "fps": 10)"));
            const CommandResult out =
                runCommand({"export", folder.path("b.field.json"), "--particles", "points", "-o",
                            folder.path("again"), "--to", "1.8", "--fps", "10", "--format", "ply"});
            ASSERT_EQ(out.status, 0) << out.errors;
            const std::string lacks = "the sequence lacks 2 of its files, the first 'frames/000007." + format;
            EXPECT_NE(out.errors.find(lacks), std::string::npos) << out.errors;
            EXPECT_EQ(out.errors.find(lacks), out.errors.rfind(lacks)) << "said once: " << out.errors;
            for (int frame = 0; frame < 18; ++frame) {
                const std::string number = std::to_string(frame);
                const int file = frame == 7 || frame == 8 ? 6 : std::min(frame, 14);
                EXPECT_TRUE(readText(folder.path("again/" + std::string(6 - number.size(), '0') + number +
                                                 ".ply")) == wanted[std::size_t(file)])
                    << pattern << frame;
            }
            fs::remove_all(folder.path("again"));
        }
        fs::remove_all(folder.path("frames"));
    }
}

TEST_F(ParticleFiles, ASequenceIsASolidThatMoves) {
    ASSERT_EQ(exported("jet", "frames", {"--to", "0.5", "--format", "vtk"}).status, 0);
    test::writeText(folder.path("b.field.json"), readerOf("frames/######.vtk"));
    std::map<std::string, std::string> meshes;
    for (const char* time : {"0", "0.2", "0.4"}) {
        const std::string one = folder.path("one.ply"), direct = folder.path("direct.ply");
        ASSERT_EQ(runCommand({"export", folder.path("b.field.json"), "-o", one, "--time", time,
                              "--resolution", "24"})
                      .status,
                  0);
        EXPECT_TRUE(meshes.emplace(readText(one), time).second) << time;
    }
}

TEST_F(ParticleFiles, SequencesThatCannotBeAreRefused) {
    const auto refused = [&](const std::string& text, const std::vector<std::string>& parts) {
        test::writeText(folder.path("b.field.json"), text);
        expectRefusal(runCommand({"export", folder.path("b.field.json"), "--particles", "points", "-o",
                                  folder.path("x.ply")}),
                      1, parts);
    };
    refused(readerOf("none/####.ply"), {"'none/####.ply'", "has no files", "as many #"});
    refused(readerOf("####.png"), {"of no format"});
    fs::create_directory(folder.path("s"));
    test::writeText(folder.path("s/0001.xyz"), "1 2 3\n");
    test::writeText(folder.path("s/1.xyz"), "not shown\n");
    test::writeText(folder.path("s/00x2.xyz"), "not shown\n");
    test::writeText(folder.path("s/0003.xyz"), "no numbers\n");
    refused(readerOf("s/####.xyz"), {"s/0003.xyz", "has no"});
    refused(readerOf("../####.xyz"), {"####.xyz"});
    std::string moved = readerOf("s/####.xyz");
    fs::remove(folder.path("s/0003.xyz"));
    moved.replace(
        moved.find(R"({"id": "field")"), 0,
        R"({"id": "moved", "type": "particle_dynamics", "inputs": {"particles": {"from": "points"}}},)");
    moved.replace(moved.find(R"("particles": {"from": "points"}}},
    {"id": "out")"),
                  31, R"("particles": {"from": "moved"})");
    refused(moved, {"'moved'", "a sequence of files moves its particles itself"});
}

}  // namespace fw::particle_files_test
