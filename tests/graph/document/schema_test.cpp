// graph/field.schema.json is the text of fileSchema(). After a change of the node library write it anew with
//   FIELDWRIGHT_UPDATE_SCHEMA=1 build/ci/graph_document_tests --gtest_filter='Schema.*'

#include "graph/document/schema.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "graph/document/json.h"
#include "graph/library/node_type.h"
#include "tests/support/graph/json_schema.h"

namespace fw::schema_test {

using test::JsonSchema;

constexpr const char* kSchemaPath = FIELDWRIGHT_SOURCE_DIR "/graph/field.schema.json";

std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool valid(const std::string& text) {
    static const Json schema = Json::parse(fileSchema());
    return JsonSchema(schema).fits(schema, Json::parse(text));
}

std::string withNode(const std::string& node) { return "{\"fieldwright\": 1, \"nodes\": [" + node + "]}"; }

TEST(Schema, TheFileIsCurrent) {
    if (std::getenv("FIELDWRIGHT_UPDATE_SCHEMA"))
        std::ofstream(kSchemaPath, std::ios::binary) << fileSchema();
    EXPECT_EQ(contents(kSchemaPath), fileSchema())
        << "update it with FIELDWRIGHT_UPDATE_SCHEMA=1 graph_document_tests --gtest_filter='Schema.*'";
}

TEST(Schema, AcceptsTheSamples) {
    const std::filesystem::path source = FIELDWRIGHT_SOURCE_DIR;
    for (const char* folder : {"samples", "tests/data/bench"}) {
        if (!std::filesystem::exists(source / folder)) continue;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(source / folder)) {
            if (!entry.path().string().ends_with(".field.json")) continue;
            EXPECT_TRUE(valid(contents(entry.path()))) << entry.path();
        }
    }
}

TEST(Schema, AcceptsEveryDefault) {
    const Json schema = Json::parse(fileSchema());
    const JsonSchema validator(schema);
    for (const NodeType& type : nodeTypes()) {
        const Json& inputs = schema["$defs"]["inputs-" + type.id];
        EXPECT_TRUE(type.open || inputs["properties"].size() == type.inputs.size());
        if (type.open) continue;
        for (const auto& [name, input] : inputs["properties"].items())
            if (input.contains("default")) {
                EXPECT_TRUE(validator.fits(input, input["default"])) << type.id << "." << name;
            }
    }
}

TEST(Schema, KnowsHowFilesEnd) {
    const auto names = [](const std::string& type, const std::string& input, const std::string& path) {
        return valid(withNode(R"({"id": "a", "type": ")" + type + R"(", "inputs": {")" + input + R"(": ")" +
                              path + R"("}})"));
    };
    for (const char* path : {"", "a.glb", "sub/a b.STL"})
        EXPECT_TRUE(names("mesh_file", "path", path)) << path;
    for (const char* path : {"a", "glb", "a.glb.zip", "a.csv"})
        EXPECT_FALSE(names("mesh_file", "path", path)) << path;
    EXPECT_TRUE(names("particle_file", "path", "a.csv"));
    EXPECT_TRUE(names("triplanar", "image", "a.dat"));  // what a picture holds tells that it is one
}

TEST(Schema, TellsGoodFromBad) {
    EXPECT_TRUE(valid("{\"fieldwright\": 1, \"nodes\": []}"));
    EXPECT_TRUE(valid("{\"fieldwright\": 1, \"nodes\": [], \"unknown\": 5}"));
    EXPECT_FALSE(valid("{\"fieldwright\": 2, \"nodes\": []}"));
    EXPECT_FALSE(valid("{\"fieldwright\": 1}"));
    EXPECT_FALSE(valid("[]"));
    EXPECT_TRUE(valid(withNode(
        R"({"id": "a", "type": "sphere", "at": [0, 1], "inputs": {"radius": 2, "p": {"from": "b"}}})")));
    for (const char* node :
         {R"({"id": "A", "type": "sphere"})", R"({"id": "a", "type": "sphre"})", R"({"id": "a"})",
          R"({"id": "a", "type": "expression"})", R"({"id": "a", "type": "group"})",
          R"({"id": "a", "type": "sphere", "inputs": {"radius": -1}})",
          R"({"id": "a", "type": "sphere", "inputs": {"radius": "big"}})",
          R"({"id": "a", "type": "sphere", "inputs": {"radus": 1}})",
          R"({"id": "a", "type": "union", "inputs": {"profile": "rond"}})",
          R"({"id": "a", "type": "union", "inputs": {"a": 1}})",
          R"({"id": "a", "type": "box", "inputs": {"half_extents": [1, 2]}})",
          R"({"id": "a", "type": "sphere", "at": [1]})"})
        EXPECT_FALSE(valid(withNode(node))) << node;
    EXPECT_TRUE(valid(
        withNode(R"({"id": "a", "type": "expression", "code": "return k;", "inputs": {"k": [1, 2, 3]}})")));
    EXPECT_FALSE(
        valid(withNode(R"({"id": "a", "type": "expression", "code": "return k;", "inputs": {"k": null}})")));
    EXPECT_FALSE(valid(R"({"fieldwright": 1, "nodes": [], "parameters": [{"name": "a"}]})"));
    EXPECT_FALSE(valid(
        R"({"fieldwright": 1, "nodes": [], "groups": [{"id": "g", "inputs": [{"name": "r", "type": "flot"}]}]})"));
}

}  // namespace fw::schema_test
