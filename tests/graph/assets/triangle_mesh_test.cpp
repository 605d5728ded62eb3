// Mesh files: what is read of each format, what of real files, and how damaged ones are refused.
#include "graph/assets/triangle_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <sstream>

#include "tests/support/graph/temp_dir.h"

namespace fw::triangle_mesh_test {

using test::TempDir;
using test::writeText;

Result<TriangleMesh> parse(const std::string& name, const std::string& bytes) {
    return parseTriangleMesh({bytes, name, name});
}
std::string refusal(const std::string& name, const std::string& bytes) {
    const Result<TriangleMesh> mesh = parse(name, bytes);
    return mesh ? "it was read" : mesh.error().message;
}

double volumeOf(const TriangleMesh& mesh) {
    double volume = 0;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[t]]), b(mesh.positions[mesh.indices[t + 1]]),
            c(mesh.positions[mesh.indices[t + 2]]);
        volume += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return volume;
}
double areaOf(const TriangleMesh& mesh) {
    double area = 0;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[t]]), b(mesh.positions[mesh.indices[t + 1]]),
            c(mesh.positions[mesh.indices[t + 2]]);
        area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return area;
}

template <class T>
void put(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The corners and faces of a tetrahedron of volume 1/6.
constexpr std::array<std::array<float, 3>, 4> kCorners = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr std::array<std::array<uint32_t, 3>, 4> kFaces = {{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

void expectTetrahedron(const Result<TriangleMesh>& mesh, std::size_t vertices) {
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->indices.size(), 12u);
    EXPECT_EQ(mesh->positions.size(), vertices);
    EXPECT_NEAR(volumeOf(*mesh), 1.0 / 6, 1e-7);
    EXPECT_NE(mesh->hash, 0u);
}

// ---- STL

std::string stlText() {
    std::ostringstream text;
    text << "solid made by hand\n";
    for (const auto& face : kFaces) {
        text << "facet normal 0 0 0\n outer loop\n";
        for (uint32_t v : face)
            text << "  vertex " << kCorners[v][0] << " " << kCorners[v][1] << " +" << kCorners[v][2]
                 << "e0\r\n";
        text << " endloop\nendfacet\n";
    }
    return text.str() + "endsolid\n";
}

std::string stlBinary(const std::string& header = "binary") {
    std::string bytes = header;
    bytes.resize(80);
    put(bytes, uint32_t(kFaces.size()));
    for (const auto& face : kFaces) {
        bytes.append(12, '\0');
        for (uint32_t v : face)
            for (float x : kCorners[v]) put(bytes, x);
        bytes.append(2, '\0');
    }
    return bytes;
}

TEST(TriangleMeshFile, Stl) {
    expectTetrahedron(parse("a.stl", stlText()), 12);
    expectTetrahedron(parse("a.STL", stlBinary()), 12);
    expectTetrahedron(parse("a.stl", stlBinary("solid, although it is binary")), 12);
    expectTetrahedron(parse("a.stl", stlBinary() + "what some programs put behind"), 12);
    const std::string text = stlText();
    for (const auto& [bytes, why] :
         {std::pair(stlBinary().substr(0, 200), "is cut off"),
          {stlBinary().substr(0, 84), "is cut off"},
          {stlBinary("solid, although it is binary").substr(0, 200), "is cut off"},
          {stlBinary().substr(0, 40), "is no STL file"},
          {std::string("solid nothing\nendsolid"), "no triangles"},
          {text.substr(0, text.rfind("vertex")), "is cut off"},
          {std::string(5000, '\0'), "is no STL file"},
          {std::string("solid\nfacet\nvertex 1 2\n"), "no three numbers, in line 3"},
          {std::string("solid\nvertex 1 2 nan\n"), "no three numbers, in line 2"},
          {std::string("solid\nvertex 1 2 3\nendfacet"), "ends after 1 corners, in line 3"}})
        EXPECT_NE(refusal("a.stl", bytes).find(why), std::string::npos)
            << refusal("a.stl", bytes) << " / " << why;
}

// ---- OBJ

TEST(TriangleMeshFile, Obj) {
    const std::string corners = "# by hand\nv 0 0 0\nv 1 0 0 \nv 0 1 0 1.0\nv 0 0 \\\n 1\nv 9 9 9\n";
    expectTetrahedron(parse("a.obj", corners + "f 1 3 2\nf 1/1 2/2/2 4//3\nf -5 -2 -3\nf 2 3 4\n"), 4);
    const Result<TriangleMesh> quad = parse("a.obj", "v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4\r");
    ASSERT_TRUE(quad);
    EXPECT_EQ(quad->indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_TRUE(quad->colors.empty());
    for (const auto& [bytes, why] : {std::pair("v 0 0 0\nf 1 2 3\n", "vertex 2 of 1 in line 2"),
                                     {"v 0 0\n", "fewer than three"},
                                     {"v 0 zero 0\n", "'zero' where a number should be, in line 1"},
                                     {"v 0 0 0\nf 1 1 0", "'0' for a vertex"},
                                     {"v 0 inf 0\n", "'inf'"},
                                     {"v 0 1e39 0\n", "'1e39'"},
                                     {"vn 0 0 1\n", "has no faces"},
                                     {"v 0 0 0\nf 1 -2 1", "vertex -2 of 1"},
                                     {"f\n", "has no faces"}})
        EXPECT_NE(refusal("a.obj", bytes).find(why), std::string::npos)
            << refusal("a.obj", bytes) << " / " << why;
}

TEST(TriangleMeshFile, ObjColors) {
    const TempDir folder;
    writeText(folder.path("a.mtl"), "newmtl deep red\nKd 0.5 0 0\nnewmtl blue\r\nKd 0 0 1\nKd x\n");
    const std::string text =
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0 1 0.5 0.25\nv 0 0 1\n"
        "usemtl deep red\nf 1 3 2\nf 1 2 4\nusemtl blue\nf 1 4 3\n";
    const std::string path = folder.path("a.obj");
    const Result<TriangleMesh> mesh = parseTriangleMesh({text, "a.obj", path});
    ASSERT_TRUE(mesh) << mesh.error().message;
    ASSERT_EQ(mesh->colors.size(), mesh->positions.size());
    EXPECT_EQ(mesh->positions.size(), 7u);  // those of both colours twice
    const auto colorOf = [&](std::size_t corner) { return mesh->colors[mesh->indices[corner]]; };
    EXPECT_EQ(colorOf(0), glm::vec3(0.5f, 0, 0));
    EXPECT_EQ(colorOf(1), glm::vec3(0.5f, 0, 0));  // its own times the material's
    EXPECT_EQ(colorOf(6), glm::vec3(0, 0, 1));
    EXPECT_EQ(colorOf(8), glm::vec3(0, 0, 0.25f));
    // What is missing, or outside the folder, costs the colours alone.
    writeText(folder.path("other.mtl"), "newmtl blue\nKd 0 1 0\n");
    std::filesystem::create_directory(folder.path("in"));
    const Result<TriangleMesh> plain = parseTriangleMesh(
        {"mtllib ../other.mtl\nmtllib none.mtl\nusemtl blue\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
         "in/a.obj", folder.path("in/a.obj")});
    ASSERT_TRUE(plain);
    EXPECT_TRUE(plain->colors.empty());
}

// ---- PLY

std::string plyHeader(const std::string& form, const std::string& more = "") {
    return "ply\nformat " + form +
           " 1.0\ncomment by hand\nelement vertex 4\nproperty double x\nproperty float y\n" + more +
           "property int z\nelement edge 1\nproperty list uchar short ends\nelement face 4\n" +
           "property uchar flag\nproperty list uchar uint vertex_indices\nend_header\n";
}

template <class T>
T turned(T value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

std::string plyBinary(bool big) {
    std::string bytes = plyHeader(big ? "binary_big_endian" : "binary_little_endian");
    const auto add = [&](auto value) { put(bytes, big ? turned(value) : value); };
    for (const auto& corner : kCorners) add(double(corner[0])), add(corner[1]), add(int32_t(corner[2]));
    add(uint8_t(2)), add(int16_t(0)), add(int16_t(1));
    for (const auto& face : kFaces) {
        add(uint8_t(7)), add(uint8_t(3));
        for (uint32_t v : face) add(v);
    }
    return bytes;
}

std::string plyText(bool colored) {
    std::ostringstream text;
    text << plyHeader("ascii",
                      colored ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "");
    for (const auto& corner : kCorners)
        text << corner[0] << " " << corner[1] << (colored ? " 255 0 188 " : " ") << corner[2] << "\n";
    text << "2 0 1\n";
    for (const auto& face : kFaces) text << "7 3 " << face[0] << " " << face[1] << " " << face[2] << "\n";
    return text.str();
}

TEST(TriangleMeshFile, Ply) {
    expectTetrahedron(parse("a.ply", plyText(false)), 4);
    expectTetrahedron(parse("a.ply", plyBinary(false)), 4);
    expectTetrahedron(parse("a.ply", plyBinary(true)), 4);
    const Result<TriangleMesh> colored = parse("a.ply", plyText(true));
    expectTetrahedron(colored, 4);
    ASSERT_EQ(colored->colors.size(), 4u);
    EXPECT_NEAR(colored->colors[0].x, 1.0, 1e-6);
    EXPECT_NEAR(colored->colors[0].z, 0.5029, 1e-3);  // 188 of 255 by the curve of sRGB
    const std::string text = plyText(false), binary = plyBinary(false);
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string other = text;
        return other.replace(other.find(from), from.size(), to);
    };
    for (const auto& [bytes, why] : {std::pair(text.substr(0, text.size() - 4), "is cut off"),
                                     {binary.substr(0, binary.size() - 1), "is cut off"},
                                     {text.substr(0, text.find("element edge")), "ends within its header"},
                                     {std::string("plx\n"), "is no PLY file"},
                                     {with("ascii", "utf8"), "a format"},
                                     {with("double x", "double q"), "without x, y and z"},
                                     {with("vertex_indices", "corners"), "without corners"},
                                     {with("vertex 4", "vertex 4000000000"), "is cut off"},
                                     {with("vertex 4", "vertex four"), "without a count"},
                                     {with("7 3 0 2 1", "7 3 0 2 4"), "vertex 4 of 4"},
                                     {with("7 3 0 2 1", "7 3 0 2 -1"), "vertex -1"},
                                     {with("7 3 0 2 1", "7 3 0 nan 1"), "vertex"},
                                     {with("7 3 0 2 1", "7 3e9 0 2 1"), "impossible length"},
                                     {with("7 3 0 2 1", "7 x 0 2 1"), "'x'"}})
        EXPECT_NE(refusal("a.ply", bytes).find(why), std::string::npos)
            << refusal("a.ply", bytes) << " / " << why;
}

// ---- glTF

/// One file with everything that is read: interleaved, sparse and quantised numbers, strips and fans, no
/// indices, a mirrored node and a mesh in two nodes.
std::string gltfText(const std::string& head = "", const std::string& version = "2.0") {
    return R"({"asset": {"version": ")" + version + R"("}, )" + head + R"(
        "buffers": [{"byteLength": 100, "uri": "a.bin"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 64, "byteStride": 16},
                        {"buffer": 0, "byteOffset": 64, "byteLength": 12},
                        {"buffer": 0, "byteOffset": 76, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 0, "byteOffset": 12, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4"},
                      {"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"},
                      {"bufferView": 2, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3", "byteOffset": 0},
                      {"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 1,
                          "indices": {"bufferView": 1, "byteOffset": 1, "componentType": 5121},
                          "values": {"bufferView": 0, "byteOffset": 16}}}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 1, 1]}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2, "material": 0}]},
                   {"primitives": [{"attributes": {"POSITION": 3}, "mode": 5}, {"attributes": {"POSITION": 3}, "mode": 6},
                                   {"attributes": {"POSITION": 4}}, {"attributes": {"POSITION": 0}, "mode": 0}]}],
        "nodes": [{"mesh": 0, "translation": [10, 0, 0], "children": [1]}, {"mesh": 0, "scale": [-2, 2, 2]}, {"mesh": 1}],
        "scenes": [{"nodes": [2]}, {"nodes": [0]}], "scene": 1})";
}

std::string gltfBuffer() {
    std::string bytes;
    for (const auto& corner : kCorners) {
        for (float x : corner) put(bytes, x);
        bytes += std::string("\xFF\x80\x00\xFF", 4);
    }
    for (const auto& face : kFaces)
        for (uint32_t v : face) put(bytes, uint8_t(v));
    for (const std::array<int, 3>& p : {std::array{0, 0, 0}, {127, 0, 0}, {0, 127, 0}, {127, 127, 0}})
        for (int x : p) put(bytes, int8_t(x));
    bytes.resize(100);
    return bytes;
}

Result<TriangleMesh> parseGltf(const std::string& text, const std::string& buffer = gltfBuffer()) {
    const TempDir folder;
    writeText(folder.path("a.bin"), buffer);
    return parseTriangleMesh({text, "a.gltf", folder.path("a.gltf")});
}

TEST(TriangleMeshFile, Gltf) {
    const Result<TriangleMesh> mesh = parseGltf(gltfText());
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->positions.size(), 8u);
    EXPECT_NEAR(volumeOf(*mesh), (1.0 + 8.0) / 6, 1e-5);  // the mirrored one is turned right
    EXPECT_EQ(mesh->positions[5], glm::vec3(8, 0, 0));
    ASSERT_EQ(mesh->colors.size(), 8u);
    EXPECT_NEAR(glm::distance(mesh->colors[0], glm::vec3(0.5f, 128 / 255.0f, 0)), 0, 1e-6);

    std::string other = gltfText();
    other.replace(other.find("\"scene\": 1"), 10, "\"scene\": 0");
    const Result<TriangleMesh> strips = parseGltf(other);
    ASSERT_TRUE(strips) << strips.error().message;
    EXPECT_EQ(strips->indices.size(), 3u * (2 + 2 + 1));
    for (std::size_t t = 0; t < 2; ++t) {  // a strip turns every other of its triangles: both face +z
        const glm::vec3 a = strips->positions[strips->indices[3 * t]],
                        b = strips->positions[strips->indices[3 * t + 1]],
                        c = strips->positions[strips->indices[3 * t + 2]];
        EXPECT_GT(glm::cross(b - a, c - a).z, 0.9f) << t;
    }
    EXPECT_EQ(strips->positions[strips->indices[12 + 2]], glm::vec3(1, 0, 0));  // sparse: the others are zero
}

TEST(TriangleMeshFile, GltfPartsShareTheirVertices) {
    const std::string part = R"({"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2, "material": 0})";
    const auto withSecond = [&](const std::string& second) {
        std::string text = gltfText();
        text.insert(text.find(part) + part.size(), ", " + second);
        return parseGltf(text);
    };
    const Result<TriangleMesh> shared = withSecond(part);
    std::string other = part;
    other.erase(other.find(", \"COLOR_0\": 1"), 14);
    const Result<TriangleMesh> separate = withSecond(other);
    ASSERT_TRUE(shared && separate);
    EXPECT_EQ(shared->positions.size(), 8u);  // in two nodes
    EXPECT_EQ(separate->positions.size(), 16u);
    EXPECT_EQ(shared->indices.size(), separate->indices.size());
    for (std::size_t i = 0; i < shared->indices.size(); ++i)
        EXPECT_EQ(shared->positions[shared->indices[i]], separate->positions[separate->indices[i]]);
}

TEST(TriangleMeshFile, GltfRefused) {
    const auto with = [](const std::string& from, const std::string& to) {
        std::string text = gltfText();
        return text.replace(text.find(from), from.size(), to);
    };
    const auto needing = [](const std::string& name) {
        return gltfText(R"("extensionsRequired": [")" + name + R"("],)");
    };
    EXPECT_TRUE(parseGltf(needing("KHR_mesh_quantization")));
    EXPECT_TRUE(parseGltf(needing("KHR_materials_sheen")));
    for (const auto& [text, why] :
         {std::pair(needing("KHR_draco_mesh_compression"), "compression that is not read"),
          {needing("EXT_meshopt_compression"), "'EXT_meshopt_compression', a compression"},
          {needing("ACME_gizmo"), "the extension 'ACME_gizmo', which is not read"},
          {gltfText("", "1.0"), "glTF version '1.0'"},
          {with("\"a.bin\"", "\"../a.bin\""), "lies outside the folder"},
          {with("\"a.bin\"", "\"/etc/passwd\""), "lies outside the folder"},
          {with("\"a.bin\"", "\"file:///etc/passwd\""), "does not exist"},
          {with("\"a.bin\"", "\"https://example.com/a.bin\""), "does not exist"},
          {with("\"a.bin\"", "\"b.bin\""), "'b.bin' does not exist"},
          {with("\"byteLength\": 12}", "\"byteLength\": 11}"), "beyond the end of buffer view 1"},
          {with("\"byteLength\": 12}", "\"byteLength\": 37}"), "beyond the end of its buffer"},
          {with("\"indices\": 2,", "\"indices\": 4,"), "invalid bufferView"},
          {with("\"children\": [1]", "\"children\": [0]"), "below itself"},
          {with("\"children\": [1]", "\"children\": [7]"), "node 7"},
          {with("\"mode\": 5}, ", "\"mode\": 8}, ")
               .replace(with("\"mode\": 5}, ", "\"mode\": 8}, ").find("\"scene\": 1"), 10, "\"scene\": 0"),
           "mode 8"},
          {with("\"byteOffset\": 64", "\"byteOffset\": -48"), "buffer view 1 with \"byteOffset\": -48"},
          {with("\"byteOffset\": 12", "\"byteOffset\": -12"), "accessor 1 with \"byteOffset\": -12"},
          {with("\"count\": 12", "\"count\": 4.5"), "accessor 2 with \"count\": 4.5"},
          {with("\"scene\": 1", "\"scene\": \"hello\""),
           "has \"scene\": \"hello\", which is no whole number"},
          {with("\"bufferView\": 0, \"componentType\": 5126, \"count\": 4",
                "\"componentType\": 5126, \"count\": 30000000"),
           "accessor 0 of 30000000 elements without data"},
          {with("\"nodes\": [0]}]", "\"nodes\": []}]"), "no triangles"}}) {
        const Result<TriangleMesh> mesh = parseGltf(text);
        ASSERT_FALSE(mesh) << why;
        EXPECT_NE(mesh.error().message.find(why), std::string::npos) << mesh.error().message << " / " << why;
        EXPECT_EQ(mesh.error().message.find("root:"), std::string::npos);
    }
    std::string buffer = gltfBuffer();
    buffer[64] = 9;
    EXPECT_NE(parseGltf(gltfText(), buffer).error().message.find("index 9 with 4 vertices"),
              std::string::npos);
    buffer = gltfBuffer();
    const float inf = INFINITY;
    std::memcpy(buffer.data(), &inf, 4);
    EXPECT_NE(parseGltf(gltfText(), buffer).error().message.find("not finite"), std::string::npos);
    EXPECT_NE(
        refusal("a.glb", std::string("glTF\1\0\0\0\x0c\0\0\0", 12)).find("version 1 of the binary form"),
        std::string::npos);
    EXPECT_NE(refusal("a.gltf", std::string(200'000, '[')).find("nested too deeply"), std::string::npos);
}

// ---- Files

TEST(TriangleMeshFile, IsReadOnceUntilItChanges) {
    const TempDir folder;
    const std::string graph = folder.path("g.field.json");
    writeText(folder.path("a.stl"), stlText());
    const Result<TriangleMeshPtr> first = readTriangleMesh(graph, "a.stl");
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(*readTriangleMesh(graph, "./a.stl"), *first);
    EXPECT_EQ((*first)->file, std::filesystem::canonical(folder.path("a.stl")));
    writeText(folder.path("a.stl"), stlText() + " ");
    const Result<TriangleMeshPtr> second = readTriangleMesh(graph, "a.stl");
    ASSERT_TRUE(second);
    EXPECT_NE(*second, *first);
    EXPECT_EQ((*second)->hash, (*first)->hash);
    EXPECT_EQ(readTriangleMesh(graph, "../a.stl").error().message.substr(0, 20), "the mesh '../a.stl' ");
    writeText(folder.path("a.fbx"), "x");
    EXPECT_NE(readTriangleMesh(graph, "a.fbx").error().message.find("of no format that is read"),
              std::string::npos);
}

// ---- Real files, where they are

/// A row of a table in Markdown.
std::vector<std::string> cellsOf(const std::string& row) {
    std::vector<std::string> cells;
    std::istringstream stream(row);
    for (std::string cell; std::getline(stream, cell, '|');) {
        const std::size_t first = cell.find_first_not_of(' ');
        cells.push_back(first == cell.npos ? "" : cell.substr(first, cell.find_last_not_of(' ') + 1 - first));
    }
    return cells;
}

TEST(TriangleMeshCorpus, MeshesAreWhatTheManifestSays) {
    const char* corpus = std::getenv("FIELDWRIGHT_CORPUS");
    if (!corpus) GTEST_SKIP() << "no corpus here (FIELDWRIGHT_CORPUS)";
    const std::string folder = std::string(corpus) + "/meshes/";
    std::istringstream manifest(test::readText(folder + "MANIFEST.md"));
    int read = 0;
    for (std::string row; std::getline(manifest, row) && row.find("## Sources") != 0;) {
        const std::vector<std::string> cells = cellsOf(row);
        if (cells.size() < 12 || !std::filesystem::is_regular_file(folder + cells[1])) continue;
        const Result<TriangleMeshPtr> mesh = readTriangleMesh(folder + "g.field.json", cells[1]);
        const bool none = cells[3] == "-" || cells[3] == "0" || cells[1].starts_with("gltf_unsupported");
        EXPECT_EQ(bool(mesh), !none) << cells[1] << (mesh ? "" : ": " + mesh.error().message);
        if (!mesh) continue;
        ++read;
        // The manifest leaves out triangles with the same corner twice.
        const std::size_t triangles = (*mesh)->indices.size() / 3;
        EXPECT_NEAR(double(triangles), std::stod(cells[3]), 2.0) << cells[1];
        const double volume = std::stod(cells[10]), area = std::stod(cells[11]);
        EXPECT_NEAR(areaOf(**mesh), area, 1e-4 * area + 1e-12) << cells[1];
        EXPECT_NEAR(volumeOf(**mesh), volume, 1e-3 * std::abs(volume) + 1e-3 * std::pow(area, 1.5))
            << cells[1];
    }
    EXPECT_GT(read, 40);
}

TEST(TriangleMeshCorpus, MalformedFilesAreAsTheManifestSays) {
    const char* corpus = std::getenv("FIELDWRIGHT_CORPUS");
    if (!corpus) GTEST_SKIP() << "no corpus here (FIELDWRIGHT_CORPUS)";
    const std::string folder = std::string(corpus) + "/malformed/";
    std::istringstream manifest(test::readText(folder + "MANIFEST.md"));
    int refused = 0;
    for (std::string row; std::getline(manifest, row);) {
        const std::vector<std::string> cells = cellsOf(row);
        if (cells.size() < 5 || !std::filesystem::is_regular_file(folder + cells[1])) continue;
        const std::string& expected = cells[4];
        const auto start = std::chrono::steady_clock::now();
        const Result<TriangleMeshPtr> mesh = readTriangleMesh(folder + "g.field.json", cells[1]);
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2)) << cells[1];
        refused += !mesh;
        const bool open = expected.find(" or ") != expected.npos || expected.starts_with("tolerate");
        if (open || expected.starts_with("reject*")) continue;
        EXPECT_EQ(bool(mesh), expected.starts_with("accept")) << cells[1];
    }
    EXPECT_GT(refused, 50);
}

}  // namespace fw::triangle_mesh_test
