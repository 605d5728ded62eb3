// graph/field.schema.json is the text of fileSchema(). After a change of the node library write it anew with
//   FIELDWRIGHT_UPDATE_SCHEMA=1 build/ci/graph_tests --gtest_filter='Schema.*'

#include "graph/document/schema.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "graph/document/json.h"
#include "graph/library/node_type.h"

namespace fw::schema_test {

constexpr const char* kSchemaPath = FIELDWRIGHT_SOURCE_DIR "/graph/field.schema.json";

std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// As much of JSON Schema as the schema uses. A keyword that is not known here throws, so that none goes
/// untested.
class Validator {
  public:
    explicit Validator(const Json& schema) : root(schema) {}

    bool fits(const Json& schema, const Json& value) const {
        for (const auto& [keyword, rule] : schema.items())
            if (!obeys(keyword, rule, schema, value)) return false;
        return true;
    }

  private:
    bool obeys(const std::string& keyword, const Json& rule, const Json& schema, const Json& value) const {
        static const std::set<std::string> remarks = {"$schema", "$defs",      "title", "description",
                                                      "default", "deprecated", "then"};
        if (remarks.contains(keyword)) return true;
        const auto fitsOne = [&](const Json& one) { return fits(one, value); };
        if (keyword == "$ref")
            return fits(root.at(Json::json_pointer(rule.get<std::string>().substr(1))), value);
        if (keyword == "type") return isOfType(rule, value);
        if (keyword == "const") return value == rule;
        if (keyword == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
        if (keyword == "anyOf") return std::any_of(rule.begin(), rule.end(), fitsOne);
        if (keyword == "oneOf") return std::count_if(rule.begin(), rule.end(), fitsOne) == 1;
        if (keyword == "allOf") return std::all_of(rule.begin(), rule.end(), fitsOne);
        if (keyword == "if") return !fits(rule, value) || fits(schema.at("then"), value);
        if (keyword == "minimum") return !value.is_number() || value.get<double>() >= rule.get<double>();
        if (keyword == "maximum") return !value.is_number() || value.get<double>() <= rule.get<double>();
        if (keyword == "exclusiveMinimum")
            return !value.is_number() || value.get<double>() > rule.get<double>();
        if (keyword == "minItems") return !value.is_array() || value.size() >= rule.get<std::size_t>();
        if (keyword == "maxItems") return !value.is_array() || value.size() <= rule.get<std::size_t>();
        if (keyword == "pattern")
            return !value.is_string() ||
                   std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>()));
        if (keyword == "items")
            return !value.is_array() || std::all_of(value.begin(), value.end(),
                                                    [&](const Json& item) { return fits(rule, item); });
        if (keyword == "required")
            return !value.is_object() || std::all_of(rule.begin(), rule.end(), [&](const Json& key) {
                return value.contains(key.get<std::string>());
            });
        if (keyword == "properties") {
            for (const auto& [key, property] : rule.items())
                if (value.is_object() && value.contains(key) && !fits(property, value[key])) return false;
            return true;
        }
        if (keyword == "additionalProperties") {
            if (!value.is_object()) return true;
            for (const auto& [key, member] : value.items())
                if (!(schema.contains("properties") && schema["properties"].contains(key)) &&
                    (rule.is_boolean() ? !rule.get<bool>() : !fits(rule, member)))
                    return false;
            return true;
        }
        throw std::logic_error("the schema uses the keyword " + keyword);
    }

    static bool isOfType(const Json& type, const Json& value) {
        if (type == "integer")
            return value.is_number() && value.get<double>() == std::floor(value.get<double>());
        if (type == "number") return value.is_number();
        return value.type_name() == type.get<std::string>();
    }

    const Json& root;
};

bool valid(const std::string& text) {
    static const Json schema = Json::parse(fileSchema());
    return Validator(schema).fits(schema, Json::parse(text));
}

std::string withNode(const std::string& node) { return "{\"fieldwright\": 1, \"nodes\": [" + node + "]}"; }

TEST(Schema, TheFileIsCurrent) {
    if (std::getenv("FIELDWRIGHT_UPDATE_SCHEMA"))
        std::ofstream(kSchemaPath, std::ios::binary) << fileSchema();
    EXPECT_EQ(contents(kSchemaPath), fileSchema())
        << "write it anew with FIELDWRIGHT_UPDATE_SCHEMA=1 graph_tests --gtest_filter='Schema.*'";
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
    const Validator validator(schema);
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
