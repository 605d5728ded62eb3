// Whether JSON fits a JSON Schema.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>

#include "graph/document/graph.h"

namespace fw::test {

/// As much of JSON Schema as our schemas use. A keyword that is not known here throws, so that none goes
/// untested.
class JsonSchema {
  public:
    explicit JsonSchema(const Json& schema) : root(schema) {}

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
        if (type.is_array())
            return std::ranges::any_of(type, [&](const Json& one) { return isOfType(one, value); });
        if (type == "integer")
            return value.is_number() && value.get<double>() == std::floor(value.get<double>());
        if (type == "number") return value.is_number();
        return value.type_name() == type.get<std::string>();
    }

    const Json& root;
};

}  // namespace fw::test
