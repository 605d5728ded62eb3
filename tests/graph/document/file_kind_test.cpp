// Files that a graph names: what the node library says of them, what is read, and what check() says.
#include "graph/base/file_kind.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "graph/assets/image.h"
#include "graph/assets/particle_cache.h"
#include "graph/assets/particle_file.h"
#include "graph/assets/triangle_mesh.h"
#include "graph/check/check.h"
#include "graph/document/json.h"
#include "graph/document/named_files.h"
#include "graph/library/node_type.h"
#include "graph/outlines/drawing.h"
#include "graph/outlines/letters.h"
#include "tests/support/graph/temp_dir.h"

namespace fw::file_kind_test {

using test::TempDir;
using test::writeText;
using Code = Error::Code;

/// A picture of one pixel; its content tells that it is one.
const std::string kBitmap = std::string(
    "BM\x3A\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\x18\0\0\0"
    "\0\0\x04\0\0\0\x13\x0B\0\0\x13\x0B\0\0\0\0\0\0\0\0\0\0\x10\x20\x30\0",
    58);

/// Nothing, or why the file is not read.
using Refusal = std::function<std::optional<Error>(const std::string& graph, const std::string& path)>;
template <class Read>
Refusal refusal(Read read) {
    return [read](const std::string& graph, const std::string& path) -> std::optional<Error> {
        const auto made = read(graph, path);
        return made ? std::optional<Error>() : made.error();
    };
}
Result<OutlinePtr> readWholeDrawing(const std::string& graph, const std::string& path) {
    return readDrawing(graph, path, "");
}
Result<Painting> readFont(const std::string& graph, const std::string& path) {
    return paintText(graph, "x", {.fontFile = path});
}
const std::map<const FileKind*, Refusal> kReaders = {
    {&kPictureFile, refusal(readImage)},           {&kMeshFile, refusal(readTriangleMesh)},
    {&kParticleFile, refusal(readParticlePlaces)}, {&kParticleCacheFile, refusal(readParticleCache)},
    {&kDrawingFile, refusal(readWholeDrawing)},    {&kSvgFile, refusal(readWholeDrawing)},
    {&kDxfFile, refusal(readWholeDrawing)},        {&kFontFile, refusal(readFont)}};

TEST(FileKinds, EveryInputOfTheLibraryHasOneWithAReader) {
    std::size_t inputs = 0;
    for (const NodeType& type : nodeTypes())
        for (const InputSpec& input : type.inputs) {
            const std::string name = type.id + "." + input.name;
            EXPECT_TRUE(input.type != Type::image || input.file) << name;
            if (!input.file) continue;
            ++inputs;
            EXPECT_TRUE(input.type == Type::image || input.type == Type::string) << name;
            EXPECT_TRUE(kReaders.contains(input.file)) << name;
            EXPECT_GT(input.file->mostBytes, 0u) << name;
            EXPECT_FALSE(input.file->endings.empty()) << name;
            for (const std::string_view ending : input.file->endings)
                EXPECT_EQ(endingOf("a" + std::string(ending)), ending) << name;
        }
    EXPECT_GE(inputs, 4u);
}

TEST(FileKinds, ReadersTakeWhatEndsAsTheirKind) {
    const TempDir folder;
    const std::string graph = folder.path("a.field.json");
    const auto read = [&](const FileKind& kind, const std::string& name, const std::string& content) {
        writeText(folder.path(name), content);
        return kReaders.at(&kind)(graph, name);
    };
    for (const auto& [kind, reader] : kReaders) {
        for (const std::string_view ending : kind->endings)
            for (const std::string stem : {"a", "B."}) {
                std::string name = stem + std::string(ending);
                if (stem == "B.") std::ranges::transform(name, name.begin(), ::toupper);
                EXPECT_TRUE(endsAs(*kind, name)) << name;
                // What is no such file is refused for what it holds.
                const std::optional<Error> error = read(*kind, name, "nothing");
                ASSERT_TRUE(error) << kind->noun << " " << name;
                EXPECT_EQ(error->code, Code::other) << format(*error);
                EXPECT_EQ(error->message.find("of no format"), std::string::npos) << format(*error);
                if (kind == &kPictureFile) { EXPECT_FALSE(read(*kind, name, kBitmap)) << name; }
            }
        for (const char* name : {"a", "a.fbx", "a.png.zip"}) {
            EXPECT_FALSE(endsAs(*kind, name)) << name;
            const std::optional<Error> error =
                read(*kind, name, kind == &kPictureFile ? kBitmap : "v 0 0 0\n");
            EXPECT_EQ(bool(error), !kind->byContent) << name;
            if (!error) continue;
            EXPECT_EQ(error->code, Code::wrongFile);
            // One function reads drawings of both kinds.
            const FileKind& either = kind == &kSvgFile || kind == &kDxfFile ? kDrawingFile : *kind;
            EXPECT_NE(error->message.find("use " + anyOf(either)), std::string::npos) << error->message;
        }
    }
    EXPECT_FALSE(read(kMeshFile, "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    for (const char* name : {"t.csv", "t.txt", "t.xyz"})
        EXPECT_FALSE(read(kParticleFile, name, "1 2 3\n")) << name;
    EXPECT_EQ(anyOf(kMeshFile), "a .glb, .gltf, .obj, .stl or .ply file");
    EXPECT_EQ(anyOf({.noun = "buffer"}), "a buffer");
}

Graph graphOf(const std::string& text) {
    const Result<Graph> graph = parseGraph(text, "g.field.json", nullptr);
    EXPECT_TRUE(graph) << (graph ? "" : format(graph.error()));
    return *graph;
}

TEST(FileKinds, CheckTellsAWrongEndingByTheName) {
    const auto findings = [](const std::string& type, const std::string& input, const std::string& path) {
        return check(graphOf(R"({"fieldwright": 1, "nodes": [{"id": "out", "type": "output"},
            {"id": "file", "type": ")" +
                             type + R"(", "inputs": {")" + input + R"(": ")" + path + R"("}}]})"));
    };
    const auto first = [&](const std::string& type, const std::string& input, const std::string& path) {
        for (const Error& error : findings(type, input, path))
            if (error.severity == Error::Severity::error) return error;
        return Error{};
    };
    const Error mesh = first("mesh_file", "path", "sub/a.png");
    EXPECT_EQ(mesh.code, Code::wrongFile);
    EXPECT_EQ(
        format(mesh),
        "g.field.json:2:68: error: node 'file', input 'path': the mesh 'sub/a.png' is of no format that is "
        "read: use a .glb, .gltf, .obj, .stl or .ply file");
    EXPECT_EQ(first("particle_file", "path", "a.glb").message,
              "the particle file 'a.glb' is of no format that is read: use a .ply, .vtk, .bgeo, .obj, .csv, "
              ".txt or .xyz file");
    // What is missing or not named is told as such, whatever the case of the letters.
    EXPECT_NE(first("mesh_file", "path", "a.GLB").message.find("does not exist"), std::string::npos);
    EXPECT_EQ(first("mesh_file", "path", "").message,
              "no file is named: write the path of a .glb, .gltf, .obj, .stl or .ply file");
    EXPECT_EQ(first("particle_file", "path", "").message,
              "no file is named: write the path of a .ply, .vtk, .bgeo, .obj, .csv, .txt or .xyz file");
    // A picture may be called anything: what it holds tells.
    EXPECT_NE(first("triplanar", "image", "a.dat").message.find("does not exist"), std::string::npos);
    EXPECT_EQ(first("triplanar", "image", "").message, "");
}

TEST(FileKinds, InAGroupThatNothingShowsToo) {
    const std::vector<Error> findings = check(graphOf(R"({"fieldwright": 1,
        "nodes": [{"id": "out", "type": "output"}],
        "groups": [{"id": "g", "nodes": [{"id": "m", "type": "mesh_file", "inputs": {"path": "a.txt"}}]}]})"));
    EXPECT_TRUE(std::ranges::any_of(
        findings, [](const Error& e) { return e.code == Code::wrongFile && e.node == "g/m"; }));
}

TEST(Errors, HaveACodeWhereSomeCodeAsks) {
    const auto codeOf = [](const std::string& nodes, const std::string& groups = "") {
        for (const Error& error :
             check(graphOf(R"({"fieldwright": 1, "nodes": [)" + nodes + "]" + groups + "}")))
            if (error.severity == Error::Severity::error) return error.code;
        return Code::other;
    };
    const std::string out = R"({"id": "out", "type": "output"})";
    EXPECT_EQ(codeOf(""), Code::unfinished);
    EXPECT_EQ(codeOf(out + R"(, {"id": "m", "type": "mesh_to_field"})"), Code::unfinished);
    EXPECT_EQ(codeOf(out, R"(, "groups": [{"id": "g", "outputs": [{"name": "a", "type": "float"}]}])"),
              Code::unfinished);
    EXPECT_EQ(codeOf(out + R"(, {"id": "e", "type": "expression", "code": "return 1.0 / 0.0;"})"),
              Code::divisionByZero);
    EXPECT_EQ(codeOf(out + R"(, {"id": "e", "type": "expression", "code": "return what;"})"), Code::other);
}

const std::string kNaming = R"({"fieldwright": 1, "nodes": [
    {"id": "a", "type": "mesh_file", "inputs": {"path": "a.obj"}},
    {"id": "b", "type": "import", "inputs": {"path": "a.obj"}},
    {"id": "c", "type": "particle_file", "inputs": {"path": "sub/a.obj"}},
    {"id": "d", "type": "triplanar", "inputs": {"image": "d.png"}},
    {"id": "e", "type": "heightfield", "inputs": {"image": ""}},
    {"id": "f", "type": "parameter", "inputs": {"name": "no.png"}},
    {"id": "i", "type": "group", "group": "g", "inputs": {"look": "i.png", "size": 2}}],
    "groups": [{"id": "g", "inputs": [{"name": "look", "type": "image", "value": "h.png"},
        {"name": "size", "type": "float"}],
      "nodes": [{"id": "d", "type": "triplanar", "inputs": {"image": "g.png"}}]}]})";

TEST(NamedFiles, AreThoseOfInputsWhoseKindTheLibraryTells) {
    Graph graph = graphOf(kNaming);
    const std::vector<NamedFile> expected = {{"a.obj", &kMeshFile},    {"sub/a.obj", &kParticleFile},
                                             {"d.png", &kPictureFile}, {"i.png", &kPictureFile},
                                             {"h.png", &kPictureFile}, {"g.png", &kPictureFile}};
    EXPECT_EQ(namedFiles(graph), expected);
    renameFiles(graph, [](const NamedFile& file) { return "to/" + file.path; });
    std::vector<NamedFile> moved = expected;
    for (NamedFile& file : moved) file.path.insert(0, "to/");
    EXPECT_EQ(namedFiles(graph), moved);
    EXPECT_EQ(std::get<std::string>(graph.node("f")->input("name")->value), "no.png");
    renameFiles(graph, [](const NamedFile& file) { return file.path.substr(3); });
    EXPECT_EQ(writeGraph(graph), writeGraph(graphOf(kNaming)));
}

TEST(NamedFiles, AMeshNamesItsPieces) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(
        gltfPieces(
            R"({"buffers": [{"uri": "a%20b.bin"}, {"uri": "data:,x"}, {"byteLength": 4}, {"uri": "c%"}]})"),
        (Names{"a b.bin", "c%"}));
    for (const char* broken : {"", "[]", "{", R"({"buffers": 1})", R"({"buffers": [1, {"uri": 2}]})"})
        EXPECT_EQ(gltfPieces(broken), Names{}) << broken;
    EXPECT_EQ(objPieces("v 0 0 0\n mtllib  my colours.mtl \r\nusemtl red\n"), Names{"my colours.mtl"});

    const TempDir folder;
    writeText(folder.path("a.OBJ"), "mtllib a.mtl\n");
    writeText(folder.path("a.ply"), "mtllib a.mtl\n");
    EXPECT_EQ(piecesOfMesh(folder.path("a.OBJ")), Names{"a.mtl"});
    EXPECT_EQ(piecesOfMesh(folder.path("a.ply")), Names{});
    EXPECT_EQ(piecesOfMesh(folder.path("gone.gltf")), Names{});
}

}  // namespace fw::file_kind_test
