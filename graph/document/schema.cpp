#include "graph/document/schema.h"

#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "graph/document/graph.h"
#include "graph/document/scene.h"
#include "graph/document/timeline.h"
#include "graph/document/unit.h"
#include "graph/library/node_type.h"
#include "graph/library/reference.h"

namespace fw {

namespace {

Json refer(const std::string& definition) { return {{"$ref", "#/$defs/" + definition}}; }

Json array(const Json& items, int count) {
    return {{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
}

Json object(Json properties, const std::vector<std::string>& required) {
    Json schema = {{"type", "object"}};
    if (!required.empty()) schema["required"] = required;
    schema["properties"] = std::move(properties);
    return schema;
}

std::vector<std::string> unitNames() {
    std::vector<std::string> names;
    for (const LengthUnit& unit : lengthUnits()) names.emplace_back(unit.name);
    return names;
}

Json described(std::string text, Json schema) {
    Json result = Json::object();
    if (!text.empty()) result["description"] = std::move(text);
    result.update(schema);
    return result;
}

/// A number or whole number within the range of the input.
Json numberSchema(const char* type, const InputSpec& spec) {
    Json schema = {{"type", type}};
    if (spec.positive) schema["exclusiveMinimum"] = 0;
    if (std::isfinite(spec.min) && !(spec.positive && spec.min <= 0)) schema["minimum"] = spec.min;
    if (std::isfinite(spec.max)) schema["maximum"] = spec.max;
    return schema;
}

/// The path of a file, or none; one that is told by its name ends as its kind does, in letters of any case.
Json pathSchema(const FileKind& kind) {
    Json schema = {{"type", "string"}};
    if (kind.byContent) return schema;
    std::string endings;
    for (const std::string_view ending : kind.endings) {
        endings += endings.empty() ? "\\." : "|\\.";
        for (const char letter : ending.substr(1))
            endings += {'[', letter, char(std::toupper(static_cast<unsigned char>(letter))), ']'};
    }
    schema["pattern"] = "^$|(" + endings + ")$";
    return schema;
}

/// What the input takes beside a link; null if only links.
Json valueSchema(const InputSpec& spec) {
    switch (spec.type) {
        case Type::boolean: return {{"type", "boolean"}};
        case Type::integer: return numberSchema("integer", spec);
        case Type::scalar: return numberSchema("number", spec);
        case Type::vec2: return array(numberSchema("number", spec), 2);
        case Type::vec3: return array(numberSchema("number", spec), 3);
        case Type::string: {
            if (spec.file) return pathSchema(*spec.file);
            Json schema = {{"type", "string"}};
            if (!spec.options.empty()) schema["enum"] = spec.options;
            return schema;
        }
        case Type::points:
        case Type::stops:
        case Type::knots: {
            Json schema = {{"type", "array"}, {"items", array({{"type", "number"}}, entrySize(spec.type))}};
            if (spec.type == Type::stops || spec.ordered)
                schema["minItems"] = 1, schema["maxItems"] = kMostStops;
            return schema;
        }
        case Type::image: return {{"type", "string"}};
        case Type::surface:
        case Type::mesh:
        case Type::particles:
        case Type::spline: return nullptr;
    }
    return nullptr;
}

/// Without a point if it is whole.
Json shortNumber(double x) {
    if (x == std::floor(x) && std::abs(x) < 1e15) return static_cast<int64_t>(x);
    return x;
}

/// The default in the form that the file would give it; null if there is none.
Json defaultValue(const InputSpec& spec) {
    const std::vector<double>& numbers = spec.value.numbers;
    if (spec.value.kind == InputDefault::Kind::text) return spec.value.text;
    if (spec.value.kind != InputDefault::Kind::numbers || numbers.empty()) return nullptr;
    if (spec.type == Type::boolean) return numbers[0] != 0;
    if (spec.type == Type::integer || spec.type == Type::scalar) return shortNumber(numbers[0]);
    Json values = Json::array();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto entry = std::size_t(entrySize(spec.type));
        if (entry > 0 && i % entry == 0) values.push_back(Json::array());
        (entry > 0 ? values.back() : values).push_back(shortNumber(numbers[i]));
    }
    return values;
}

Json inputSchema(const InputSpec& spec) {
    const Json value = valueSchema(spec);
    const bool mayLink = componentCount(spec.type) > 0 || value.is_null();
    Json schema = Json::object();
    if (!spec.doc.empty())
        schema["description"] = spec.file                                 ? spec.doc + rangeText(spec)
                                : spec.unit.empty() || spec.unit == "any" ? spec.doc
                                                                          : spec.doc + " [" + spec.unit + "]";
    if (const Json initial = defaultValue(spec); !initial.is_null()) schema["default"] = initial;
    if (value.is_null())
        schema.update(refer("link"));
    else if (!mayLink)
        schema.update(value);
    else
        schema["anyOf"] = Json::array({value, refer("link")});
    return schema;
}

/// The inputs of the node types that take what the document says.
Json openInputs() { return {{"type", "object"}, {"additionalProperties", refer("value")}}; }

Json inputsSchema(const NodeType& type) {
    if (type.open) return openInputs();
    Json properties = Json::object();
    for (const InputSpec& spec : type.inputs) properties[spec.name] = inputSchema(spec);
    return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

Json nodeSchema() {
    Json types = Json::array(), cases = Json::array();
    for (const NodeType& type : nodeTypes()) {
        types.push_back({{"const", type.id}, {"title", type.label}, {"description", type.doc}});
        Json then = {{"properties", {{"inputs", refer("inputs-" + type.id)}}}};
        if (type.role == NodeRole::expression) then["required"] = {"code"};
        if (type.role == NodeRole::group) then["required"] = {"group"};
        Json is = {{"properties", {{"type", {{"const", type.id}}}}}, {"required", {"type"}}};
        cases.push_back({{"if", std::move(is)}, {"then", std::move(then)}});
    }
    for (const NodeType& type : nodeTypes())
        for (const std::string& alias : type.aliases)
            types.push_back(
                {{"const", alias}, {"description", "Read as '" + type.id + "'."}, {"deprecated", true}});
    Json schema = object(
        {{"id", described("Name by which links lead here.", refer("id"))},
         {"type", described("Node type; 'fieldwright nodes' lists all.", {{"oneOf", std::move(types)}})},
         {"label", described("Title shown instead of the type's.", {{"type", "string"}})},
         {"at", described("Place on the canvas.", array({{"type", "number"}}, 2))},
         {"muted", described("Passes its first connected input through.", {{"type", "boolean"}})},
         {"collapsed", {{"type", "boolean"}}},
         {"group", described("Of a node of type 'group': the group it shows.", refer("id"))},
         {"inputs",
          described("Values and links; an input that is absent has its default.", {{"type", "object"}})},
         {"code",
          described("Of a node of type 'expression': code in the field language.", {{"type", "string"}})}},
        {"id", "type"});
    schema["allOf"] = std::move(cases);
    return schema;
}

Json groupSchema() {
    Json types = Json::array();
    for (int i = 0; i < kTypes; ++i) types.push_back(typeName(static_cast<Type>(i)));
    const Json name = refer("name"), type = {{"enum", types}};
    return object(
        {{"id", refer("id")},
         {"file", described("The graph file of which the group is a copy; the editor tells when they differ.",
                            {{"type", "string"}})},
         {"taken", described("A digest of both, of when they were last the same.", {{"type", "string"}})},
         {"inputs",
          {{"type", "array"},
           {"maxItems", kMaxSockets},
           {"items", object({{"name", name}, {"type", type}, {"value", refer("value")}}, {"name", "type"})}}},
         {"outputs",
          {{"type", "array"},
           {"maxItems", kMaxSockets},
           {"items", object({{"name", name}, {"type", type}}, {"name", "type"})}}},
         {"nodes", {{"type", "array"}, {"items", refer("node")}}}},
        {"id"});
}

/// Members of the scene, their defaults those that the reader starts from.
Json sceneNumber(std::string text, std::optional<double> initial, double least = 0.0,
                 double most = kMostSceneNumber) {
    Json schema = {{"type", "number"}};
    if (initial) schema["default"] = shortNumber(*initial);
    schema["minimum"] = shortNumber(least);
    schema["maximum"] = shortNumber(most);
    return described(std::move(text), std::move(schema));
}
Json sceneTriple(std::string text, const Triple& initial, double least) {
    Json schema = array(sceneNumber("", {}, least), 3);
    for (double x : initial) schema["default"].push_back(shortNumber(x));
    return described(std::move(text), std::move(schema));
}
Json scenePoint(std::string text, const Triple& initial) {
    return sceneTriple(std::move(text), initial, -kMostSceneNumber);
}
Json sceneColor(std::string text, const Triple& initial) {
    return sceneTriple(std::move(text), initial, 0.0);
}
/// What may also be true, with the defaults of its members, or false.
Json switched(std::string text, Json properties) {
    return described(std::move(text),
                     {{"anyOf", {{{"type", "boolean"}}, object(std::move(properties), {})}}});
}

Json lampSchema() {
    const Lamp lamp;
    return object(
        {{"type", {{"enum", {"point", "spot", "directional"}}, {"default", "point"}}},
         {"position",
          scenePoint("Metres; no matter of a directional light but with its target.", lamp.position)},
         {"target", scenePoint("What a spot or a directional light points at.", lamp.target)},
         {"color", sceneColor("Linear.", lamp.color)},
         {"strength",
          sceneNumber("Radiant intensity; of a directional light its irradiance.", lamp.strength)},
         {"angle", sceneNumber("Degrees across a spot's cone.", lamp.angle, kLeastLampAngle, kMostLampAngle)},
         {"blend", sceneNumber("Share of the cone over which its edge fades.", lamp.blend, 0.0, 1.0)},
         {"size", sceneNumber("Metres across: the larger, the softer its shadows.", lamp.size)}},
        {});
}

Json sceneSchema() {
    const Camera camera;
    const Sun sun;
    const Sky sky;
    const AmbientOcclusion ao;
    const Fog fog;
    const Bloom bloom;
    const double up = kMostElevation;
    return object(
        {{"camera",
          described(
              "Where from and how the solid is seen; the whole of it if absent.",
              object(
                  {{"position", scenePoint("Metres.", camera.position)},
                   {"target", scenePoint("What is in the middle of the picture.", camera.target)},
                   {"fov", sceneNumber("Degrees from the bottom of the picture to its top.", camera.fov,
                                       kLeastFov, kMostFov)},
                   {"aperture", sceneNumber("Metres across the lens; 0: all is sharp.", camera.aperture)},
                   {"focus", sceneNumber("Metres to what is sharp; 0: as far as the target.", camera.focus)},
                   {"shutter",
                    sceneNumber("Degrees of a frame's 360 that it is open for; 0: nothing is blurred.",
                                camera.shutter, 0.0, kMostShutter)}},
                  {}))},
         {"sun",
          switched("A light from afar, with shadows.",
                   {{"azimuth", sceneNumber("Degrees from +z towards +x.", sun.azimuth, -kMostSceneNumber)},
                    {"elevation", sceneNumber("Degrees above the horizon.", sun.elevation, -up, up)},
                    {"color", sceneColor("Linear.", sun.color)},
                    {"strength", sceneNumber("Irradiance of a surface that faces it.", sun.strength)},
                    {"size", sceneNumber("Degrees across: the larger, the softer its shadows.", sun.size, 0.0,
                                         kMostSunSize)},
                    {"traced", described("Its shadows are traced through the field: sharp near and far. "
                                         "Otherwise a map of the solid has them.",
                                         {{"type", "boolean"}, {"default", sun.traced}})}})},
         {"sky", switched("What is behind the solid and lights it from all sides; a studio if absent.",
                          {{"zenith", sceneColor("Linear, as are the others.", sky.zenith)},
                           {"horizon", sceneColor("", sky.horizon)},
                           {"ground", sceneColor("What is below the horizon.", sky.ground)},
                           {"image", described("Path of an environment map in place of the colours.",
                                               {{"type", "string"}, {"minLength", 1}})},
                           {"rotation", sceneNumber("Degrees that the map is turned, from +z towards +x.",
                                                    sky.rotation, -kMostSceneNumber)},
                           {"strength", sceneNumber("Factor of all of it.", sky.strength)}})},
         {"lights", described("Lamps, with shadows.",
                              {{"type", "array"}, {"maxItems", kMostLights}, {"items", lampSchema()}})},
         {"ao", switched("Ambient occlusion: less light of the sky where little of it is seen.",
                         {{"radius", sceneNumber("Metres that it looks around; 0: as suits the solid's size.",
                                                 ao.radius)},
                          {"strength", sceneNumber("", ao.strength, 0.0, 1.0)}})},
         {"ground", switched("A level floor.", {{"height", sceneNumber("Metres; the solid's foot if absent.",
                                                                       {}, -kMostSceneNumber)}})},
         {"fog",
          switched("Fog, in which the sun's rays show; none if absent.",
                   {{"density", sceneNumber("At the height of the ground, 1 / metre.", fog.density)},
                    {"height", sceneNumber("Metres in which it thins to 1 / e; 0: it does not.", fog.height)},
                    {"color", sceneColor("Linear.", fog.color)}})},
         {"bloom",
          switched("Light that spills from bright places; none if absent.",
                   {{"strength", sceneNumber("Share of all light that does.", bloom.strength, 0.0, 1.0)},
                    {"radius", sceneNumber("How far, in heights of the picture.", bloom.radius, 0.0, 1.0)}})},
         {"bounce",
          described("Light that surfaces throw on each other.", {{"type", "boolean"}, {"default", false}})},
         {"reflections", described("Surfaces mirror each other, rather than the sky alone.",
                                   {{"type", "boolean"}, {"default", false}})},
         {"exposure", sceneNumber("Stops.", Scene{}.exposure, -kMostExposure, kMostExposure)},
         {"tone", described("How light is mapped to the screen.",
                            {{"enum", kToneNames}, {"default", kToneNames[std::size_t(Scene{}.tone)]}})}},
        {});
}

Json timelineSchema() {
    const Json number = {{"type", "number"}};
    const Json time = {{"type", "number"}, {"minimum", 0}};
    const Json interpolation = {{"enum", {"step", "linear", "cubic"}}, {"default", "linear"}};
    const Json ease = {{"enum", {"none", "in", "out", "in-out"}}, {"default", "none"}};
    const Json tangents = {{"enum", {"auto", "flat", "linear", "broken"}}, {"default", "auto"}};
    const Json values = {{"type", "array"}, {"items", number}, {"minItems", 1}, {"maxItems", 4}};
    const Json numbers = {{"anyOf", Json::array({number, values})}};
    const Json key =
        object({{"time", described("Seconds.", time)},
                {"value", numbers},
                {"interpolation", interpolation},
                {"ease", ease},
                {"in", described("Slope with which a cubic curve arrives, units a second.", numbers)},
                {"out", described("Slope with which it leaves.", numbers)},
                {"tangents", described("Of the sides without a slope.", tangents)}},
               {"time", "value"});
    const Json keys = {{"type", "array"}, {"items", key}, {"minItems", 1}};
    const Json text = {{"type", "string"}};
    Json track =
        object({{"node", described("Id of the node whose input moves.", refer("id"))},
                {"input", described("Name of the input; .x, .y or .z behind it for one component.", text)},
                {"parameter", described("Name of the parameter that moves.", text)},
                {"scene", described("Dotted path to what moves: camera.position.", text)},
                {"interpolation", described("Of keys that give none.", interpolation)},
                {"ease", described("Of keys that give none.", ease)},
                {"tangents", described("Of keys that give none.", tangents)},
                {"keys", described("In the order of their times.", keys)}},
               {"keys"});
    track["anyOf"] = Json::array(
        {{{"required", {"node", "input"}}}, {{"required", {"parameter"}}}, {{"required", {"scene"}}}});
    const Json positive = {{"type", "number"}, {"exclusiveMinimum", 0}};
    return object(
        {{"length", described("Seconds; the last key's time if absent.", positive)},
         {"loop", described("What follows the end.",
                            {{"enum", {"once", "repeat", "ping-pong"}}, {"default", "repeat"}})},
         {"fps", described("Frames a second, for stepping and for pictures.", positive)},
         {"tracks", {{"type", "array"}, {"maxItems", kMaxTracks}, {"items", track}}},
         {"markers",
          {{"type", "array"},
           {"items", object({{"time", described("Seconds.", time)}, {"name", text}}, {"time"})}}},
         {"range", described("Seconds between which the editor plays, [from, to].", array(time, 2))}},
        {});
}

}  // namespace

std::string fileSchema() {
    const Json number = {{"type", "number"}};
    Json definitions = {
        {"id", {{"type", "string"}, {"pattern", "^[a-z][a-z0-9_]*$"}}},
        {"name", {{"type", "string"}, {"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}}},
        {"link",
         object({{"from", described("Id of the node.", refer("id"))},
                 {"output", described("Name of its output; the first if absent.", {{"type", "string"}})}},
                {"from"})},
        {"value",
         {{"description", "A number, a switch, a word, a vector, a list of points or stops, or a link."},
          {"anyOf", Json::array({number,
                                 {{"type", "boolean"}},
                                 {{"type", "string"}},
                                 {{"type", "array"}, {"items", number}},
                                 {{"type", "array"}, {"items", array(number, 2)}},
                                 refer("link")})}}},
        {"parameter", object({{"name", {{"type", "string"}, {"pattern", "^[^=]+$"}}},
                              {"node", refer("id")},
                              {"input", {{"type", "string"}}},
                              {"min", number},
                              {"max", number}},
                             {"name", "node", "input"})},
        {"group", groupSchema()},
        {"node", nodeSchema()}};
    for (const NodeType& type : nodeTypes()) definitions["inputs-" + type.id] = inputsSchema(type);

    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "Fieldwright graph"},
                   {"description", "A graph of signed distance fields, *.field.json."}};
    schema.update(object(
        {{"fieldwright", described("Version of the format.", {{"const", kFormatVersion}})},
         {"nodes", {{"type", "array"}, {"maxItems", kMaxNodes}, {"items", refer("node")}}},
         {"groups", described("Reusable subgraphs.",
                              {{"type", "array"}, {"maxItems", kMaxEntries}, {"items", refer("group")}})},
         {"parameters",
          described("What whoever plays the graph may change.",
                    {{"type", "array"}, {"maxItems", kMaxEntries}, {"items", refer("parameter")}})},
         {"frames", described("Comment boxes of the canvas.", {{"type", "array"}})},
         {"scene", described("Camera, lights, sky, post.", sceneSchema())},
         {"timeline", described("Length, and tracks of keys.", timelineSchema())},
         {"unit", described("What a length of 1 is; a metre if absent.", {{"enum", unitNames()}})},
         {"density", described("Of what the solid is made of, g/cm³: for its mass.",
                               {{"type", "number"}, {"exclusiveMinimum", 0}})}},
        {"fieldwright", "nodes"}));
    schema["$defs"] = std::move(definitions);
    return schema.dump(2) + "\n";
}

}  // namespace fw
