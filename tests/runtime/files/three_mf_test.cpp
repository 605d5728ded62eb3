// 3MF files: what lib3mf and other programs read in them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <random>

#include "runtime/export/export.h"
#include "runtime/export/formats.h"
#include "runtime/measure/mesh_report.h"
#include "runtime/mesh/corners.h"
#include "tests/support/graph/temp_dir.h"
#include "tests/support/meshes.h"

namespace fw::three_mf_test {

using test::TempDir;

void mustExport(const Mesh& mesh, const std::string& path, const ExportOptions& options = {}) {
    const Result<ExportedFiles> written = exportMesh(mesh, path, options);
    ASSERT_TRUE(written) << format(written.error());
    EXPECT_EQ(written->bytes, std::filesystem::file_size(path));
}

/// The model's XML, unpacked by another program.
std::string modelOf(const std::string& path) {
    const auto unpacked = test::runProgram("unzip -p '" + path + "' 3D/3dmodel.model");
    EXPECT_EQ(unpacked.status, 0) << unpacked.output;
    return unpacked.output;
}

/// What an XPath expression gives in the model, by another program's parser.
std::string ask(const std::string& path, const std::string& expression) {
    const auto answer = test::runProgram("unzip -p '" + path + "' 3D/3dmodel.model | xmllint --xpath \"" +
                                         expression + "\" -");
    EXPECT_EQ(answer.status, 0) << answer.output;
    return answer.output.substr(0, answer.output.find_last_not_of('\n') + 1);
}

std::string all(const std::string& element) { return "//*[local-name()='" + element + "']"; }

TEST(ThreeMf, HoldsTheSolidInMillimetres) {
    const TempDir folder;
    // With vertices doubled: equal positions are one vertex in the file.
    Mesh mesh = test::unshared(test::join(test::torus(60, 31, 1.0 / 3.0, 0.07), test::cube()));
    mustExport(mesh, folder.path("mesh.3mf"));
    const WeldedMesh wanted = weld(mesh.positions, mesh.indices);
    const Result<WeldedMesh> read = readWelded({folder.path("mesh.3mf"), folder.path("mesh.3mf")});
    ASSERT_TRUE(read) << format(read.error());
    EXPECT_EQ(read->indices, wanted.indices);
    ASSERT_EQ(read->positions.size(), wanted.positions.size());
    for (std::size_t i = 0; i < wanted.positions.size(); ++i)
        EXPECT_LT(glm::distance(read->positions[i], wanted.positions[i]), 1e-7f);
    const Result<Report> report = reportOnFile(folder.path("mesh.3mf"));
    ASSERT_TRUE(report);
    EXPECT_TRUE(report->closedManifold());
    EXPECT_NEAR(report->volume, reportOnMesh(mesh.positions, mesh.indices).volume, 1e-6);

    EXPECT_EQ(ask(folder.path("mesh.3mf"), "string(/*/@unit)"), "millimeter");
    EXPECT_EQ(ask(folder.path("mesh.3mf"), "count(" + all("vertex") + ")"),
              std::to_string(wanted.positions.size()));
    EXPECT_EQ(ask(folder.path("mesh.3mf"), "count(" + all("triangle") + ")"),
              std::to_string(mesh.triangleCount()));
    EXPECT_EQ(ask(folder.path("mesh.3mf"), "count(" + all("vertex") + "[@y='1000' or @y='1000.000000'])"),
              "4");
}

TEST(ThreeMf, TrianglesThatCollapseAreLeftOut) {
    const TempDir folder;
    Mesh mesh = test::cube();
    mesh.positions.push_back(mesh.positions[0]);
    mesh.indices.insert(mesh.indices.end(), {0, 8, 3});
    mustExport(mesh, folder.path("mesh.3mf"));
    const Result<Report> report = reportOnFile(folder.path("mesh.3mf"));
    ASSERT_TRUE(report);
    EXPECT_EQ(report->triangles, 12u);
    EXPECT_TRUE(report->closedManifold());
}

TEST(ThreeMf, EveryCornerHasTheColourOfItsVertex) {
    const TempDir folder;
    Mesh mesh = test::torus(12, 7);
    test::paint(mesh);
    mustExport(mesh, folder.path("mesh.3mf"));
    const std::string text = modelOf(folder.path("mesh.3mf"));
    std::vector<std::string> colors;
    for (std::size_t at = 0; (at = text.find(" color=\"", at)) != std::string::npos; ++at)
        colors.push_back(text.substr(at + 8, 9));
    std::size_t triangle = 0;
    for (std::size_t at = 0; (at = text.find("<triangle ", at)) != std::string::npos; ++at, ++triangle) {
        const std::string line = text.substr(at, text.find("/>", at) - at);
        const auto number = [&](const std::string& key) {
            const std::size_t found = line.find(" " + key + "=\"");
            return found == std::string::npos ? -1 : std::stoi(line.substr(found + key.size() + 3));
        };
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3 color = mesh.colors[mesh.indices.at(triangle * 3 + k)];
            char wanted[16];
            std::snprintf(wanted, sizeof wanted, "#%02X%02X%02XFF", encodeSrgb(color.x), encodeSrgb(color.y),
                          encodeSrgb(color.z));
            // One that is not stated is the first's.
            int index = number("p" + std::to_string(k + 1));
            if (index < 0) index = number("p1");
            EXPECT_EQ(colors.at(static_cast<std::size_t>(index)), wanted) << triangle << " corner " << k;
        }
    }
    EXPECT_EQ(triangle, mesh.triangleCount());
}

TEST(ThreeMf, StatesTheBaseColourAndTheName) {
    const TempDir folder;
    const std::string path = folder.path("Größe 100% <#1>.3mf");
    Mesh mesh = test::cube();
    mesh.baseColor = {1.0f, 0.5f, 0.0f};
    mustExport(mesh, path);
    EXPECT_EQ(ask(path, "string(" + all("base") + "/@displaycolor)"), "#FFBC00FF");
    EXPECT_EQ(ask(path, "string(" + all("object") + "/@name)"), "Größe_100%_<#1>");
    EXPECT_EQ(ask(path, "string(" + all("object") + "/@pid)"),
              ask(path, "string(" + all("basematerials") + "/@id)"));
    EXPECT_EQ(ask(path, "string(" + all("metadata") + "[@name='Application'])"),
              "Fieldwright " FIELDWRIGHT_VERSION);
    mustExport(mesh, path, {.name = "'a' \xff \x01 & \"<b>\""});
    EXPECT_EQ(ask(path, "string(" + all("object") + "/@name)"), "'a'_____&_\"<b>\"");
}

TEST(ThreeMf, TheSameMeshGivesTheSameBytes) {
    const TempDir folder;
    Mesh mesh = test::torus(30, 20);
    mustExport(mesh, folder.path("a.3mf"), {.name = "part"});
    mustExport(mesh, folder.path("b.3mf"), {.name = "part"});
    EXPECT_EQ(test::readText(folder.path("a.3mf")), test::readText(folder.path("b.3mf")));
    mesh.positions[7].x += 0.001f;
    mustExport(mesh, folder.path("c.3mf"), {.name = "part"});
    const std::string identity = "string(" + all("object") + "/@*[local-name()='UUID'])";
    EXPECT_NE(ask(folder.path("a.3mf"), identity), ask(folder.path("c.3mf"), identity));
    EXPECT_EQ(ask(folder.path("a.3mf"), "string-length(" + identity + ")"), "36");
}

TEST(ThreeMf, LargerThanTheFormatIsRefused) {
    const TempDir folder;
    Mesh mesh = test::cube();
    for (glm::vec3& p : mesh.positions) p *= 2e6f;  // 2,000 km
    const Result<ExportedFiles> written = exportMesh(mesh, folder.path("mesh.3mf"));
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find("cannot write: "), std::string::npos) << written.error().message;
    EXPECT_TRUE(folder.names().empty());
}

TEST(ThreeMf, WhatIsNoneIsRefused) {
    const TempDir folder;
    mustExport(test::cube(), folder.path("mesh.3mf"));
    const std::string whole = test::readText(folder.path("mesh.3mf"));
    std::mt19937 random(3);
    std::string noise(5000, ' ');
    for (char& c : noise) c = static_cast<char>(random());
    for (const std::string& text : {std::string(), std::string("PK"), whole.substr(0, whole.size() / 2),
                                    whole.substr(0, whole.size() - 1), noise, "PK\3\4" + noise}) {
        test::writeText(folder.path("bad.3mf"), text);
        const Result<WeldedMesh> read = readWelded({folder.path("bad.3mf"), folder.path("bad.3mf")});
        ASSERT_FALSE(read) << text.size();
        EXPECT_EQ(read.error().file, folder.path("bad.3mf"));
        EXPECT_NE(read.error().message.find("not a 3MF"), std::string::npos) << read.error().message;
    }
}

}  // namespace fw::three_mf_test
