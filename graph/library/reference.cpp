#include "graph/library/reference.h"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace fw {
namespace {

using Json = nlohmann::ordered_json;

std::string numberText(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

/// Text inside a table cell.
std::string cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
}

}  // namespace

std::string nodeMarkdown(const NodeType& type) {
    std::string text = "### " + type.label + "\n\n`" + type.id + "`";
    for (const std::string& alias : type.aliases)
        text += (&alias == &type.aliases.front() ? " (also found as " : ", ") + alias;
    text += (type.aliases.empty() ? "" : ")") + std::string(". ") + type.doc + "\n";
    if (!type.inputs.empty()) {
        text += "\n| input | type | default | meaning |\n| --- | --- | --- | --- |\n";
        for (const InputSpec& input : type.inputs) {
            text += "| `" + input.name + "` | " + typeText(input) + " | " + cell(defaultText(input)) + " | " +
                    cell(input.doc + rangeText(input)) + " |\n";
        }
    }
    if (!type.outputs.empty()) {
        text += "\nOutput: ";
        for (const OutputSpec& output : type.outputs) {
            if (&output != &type.outputs.front()) text += ", ";
            text += "`" + output.name + "` (" + std::string(typeName(output.type)) + ")";
        }
        const std::string exactness = exactnessText(type);
        text += exactness.empty() ? ".\n" : ". Distance: " + exactness + ".\n";
    }
    return text + "\n";
}

std::string typeText(const InputSpec& input) {
    if (!input.options.empty()) return "choice";
    if (input.type == Type::string) return input.file ? "file" : "text";
    if (input.unit == "color") return "colour";
    return std::string(typeName(input.type));
}

std::string defaultText(const InputSpec& input) {
    const InputDefault& value = input.value;
    switch (value.kind) {
        case InputDefault::Kind::position: return "position";
        case InputDefault::Kind::text: return value.text.empty() ? "" : "`" + value.text + "`";
        case InputDefault::Kind::none: return "";
        case InputDefault::Kind::numbers: break;
    }
    if (input.type == Type::boolean) return value.numbers[0] != 0 ? "true" : "false";
    std::string text;
    for (std::size_t i = 0; i < value.numbers.size(); i++) {
        const auto entry = static_cast<std::size_t>(entrySize(input.type));
        if (i > 0) text += entry > 0 && i % entry == 0 ? "; " : ", ";
        text += numberText(value.numbers[i]);
    }
    return text +
           (input.unit.empty() || input.unit == "color" || input.unit == "any" ? "" : " " + input.unit);
}

std::string rangeText(const InputSpec& input) {
    if (!input.options.empty()) {
        std::string text = " Choices:";
        for (const std::string& option : input.options)
            text += (&option == &input.options.front() ? " `" : ", `") + option + "`";
        return text + ".";
    }
    if (input.file) {
        std::string text = " Files:";
        for (const std::string_view ending : input.file->endings)
            text += (ending == input.file->endings.front() ? " `" : ", `") + std::string(ending) + "`";
        return text + " of up to " + std::to_string(input.file->mostBytes >> 20) + " MiB.";
    }
    if (input.type == Type::boolean) return "";
    const bool hasMin = std::isfinite(input.min), hasMax = std::isfinite(input.max);
    if (hasMin && hasMax) return " From " + numberText(input.min) + " to " + numberText(input.max) + ".";
    if (input.positive) return " Above " + numberText(hasMin ? input.min : 0) + ".";
    if (hasMin) return " At least " + numberText(input.min) + ".";
    return hasMax ? " At most " + numberText(input.max) + "." : "";
}

std::string referenceLink(const NodeType& type) {
    std::string anchor;
    for (const char c : type.label)
        if (c == ' ' || c == '-')
            anchor += '-';
        else if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
            anchor += char(std::tolower(static_cast<unsigned char>(c)));
    return "nodes.md#" + anchor;
}

std::string exactnessText(const NodeType& type) {
    if (!type.exactness) return "";
    const auto input = [&](std::string_view name) -> const InputDefault* {
        const int index = inputIndex(type, name);
        return index < 0 ? nullptr : &type.inputs[static_cast<std::size_t>(index)].value;
    };
    ExactnessArguments arguments;
    arguments.surface = [](std::string_view) { return kExact; };
    arguments.varies = [](std::string_view, int axis) { return axis != 2; };  // flat where it can matter
    arguments.constant = [&](std::string_view name, int component) -> std::optional<double> {
        const InputDefault* value = input(name);
        const auto i = static_cast<std::size_t>(component);
        return value && i < value->numbers.size() ? std::optional(value->numbers[i]) : std::nullopt;
    };
    arguments.option = [&](std::string_view name) { return input(name) ? input(name)->text : std::string(); };
    // The page describes nodes that are used as intended: the surface fits.
    arguments.within = [](std::string_view, const Point&, double) { return true; };
    arguments.bounds = [](std::string_view, double) { return Box{}; };
    arguments.mirrored = [](std::string_view, int) { return false; };
    return exactnessText(type.exactness(arguments));
}

std::string exactnessText(const Exactness& e) {
    if (e.exact()) return "exact";
    if (!std::isfinite(e.lipschitz)) return "distorted";
    if (!e.bound()) return "distorted by up to " + numberText(std::round(e.lipschitz * 100) / 100);
    return e.outside ? "exact outside" : e.inside ? "exact inside" : "a bound";
}

std::string lipschitzText(double constant) {
    return "at most " + numberText(std::ceil(constant * 100.0 - 1e-6) / 100.0) + "-Lipschitz";
}

std::string nodesMarkdown() {
    std::string text =
        "# Node reference\n\n"
        "This page is generated from the node library: `fieldwright nodes --markdown`.\n\n"
        "Lengths are in metres, or in the unit that the document says, and angles in degrees, y is up. A "
        "field is negative inside a surface and "
        "positive outside. An input of "
        "type float, vec2, vec3 or surface takes a value or a wire; it may differ from place to place. What "
        "is not wired has "
        "its default, and a position the place that is being looked at. Every node with a single result is "
        "also a "
        "function of the field language, its arguments in the order of the inputs: `box(p, vec3(1, 2, "
        "1))`.\n\n"
        "*Distance* says how far the field can be trusted, with default settings and exact inputs: *exact* "
        "is the distance to the "
        "surface on both sides; *exact outside* or *inside* on that side only, and never more than the "
        "distance on the other; *a "
        "bound* is never more than the distance; *distorted* may be more, which slows rendering and makes "
        "offsets, shells and "
        "blends uneven.\n\n";
    for (int i = 0; i < kCategories; ++i) {
        const auto category = Category(i);
        text += "## " + std::string(categoryName(category)) + "\n\n";
        for (const NodeType& type : nodeTypes()) {
            if (type.category == category) text += nodeMarkdown(type);
        }
    }
    text.pop_back();  // the blank line after the last entry
    return text;
}

std::string nodesJson() {
    Json nodes = Json::array();
    for (const NodeType& type : nodeTypes()) {
        Json node = {{"id", type.id},
                     {"label", type.label},
                     {"category", categoryName(type.category)},
                     {"doc", type.doc}};
        if (!type.aliases.empty()) node["aliases"] = type.aliases;
        if (type.open) node["open"] = true;
        node["inputs"] = Json::array();
        for (const InputSpec& spec : type.inputs) {
            Json input = {{"name", spec.name}, {"type", typeName(spec.type)}};
            switch (spec.value.kind) {
                case InputDefault::Kind::position: input["default"] = "position"; break;
                case InputDefault::Kind::text: input["default"] = spec.value.text; break;
                case InputDefault::Kind::none: break;
                case InputDefault::Kind::numbers:
                    if (spec.type == Type::boolean) {
                        input["default"] = spec.value.numbers[0] != 0;
                    } else if (entrySize(spec.type) > 0) {
                        input["default"] = Json::array();
                        const auto size = static_cast<std::size_t>(entrySize(spec.type));
                        for (std::size_t i = 0; i < spec.value.numbers.size(); ++i) {
                            if (i % size == 0) input["default"].push_back(Json::array());
                            input["default"].back().push_back(spec.value.numbers[i]);
                        }
                    } else if (spec.value.numbers.size() == 1) {
                        input["default"] = spec.value.numbers[0];
                    } else {
                        input["default"] = spec.value.numbers;
                    }
            }
            if (std::isfinite(spec.min) && spec.type != Type::boolean) input["min"] = spec.min;
            if (std::isfinite(spec.max) && spec.type != Type::boolean) input["max"] = spec.max;
            if (spec.positive) input["positive"] = true;
            if (!spec.options.empty()) input["options"] = spec.options;
            if (!spec.unit.empty()) input["unit"] = spec.unit;
            if (spec.file) input["files"] = spec.file->endings;
            input["doc"] = spec.doc;
            node["inputs"].push_back(std::move(input));
        }
        node["outputs"] = Json::array();
        for (const OutputSpec& output : type.outputs) {
            node["outputs"].push_back({{"name", output.name}, {"type", typeName(output.type)}});
        }
        if (type.exactness) node["distance"] = exactnessText(type);
        nodes.push_back(std::move(node));
    }
    return Json{{"nodes", std::move(nodes)}}.dump(2) + "\n";
}

}  // namespace fw
