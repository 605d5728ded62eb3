#include "editor/probe/readings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "editor/document/edits.h"
#include "editor/document/paths.h"
#include "graph/evaluate/gradients.h"
#include "runtime/particles/particle_fields.h"

namespace fw::editor {

namespace {

constexpr double kNothing = 1e-9;  // metres

/// What leads to the nodes of the scope: nothing for the document, "tower/" for the first instance of a
/// group; none if that has no instance.
std::optional<std::string> prefixOf(const Graph& graph, const std::string& scope) {
    if (scope.empty()) return std::string();
    std::vector<std::string> prefixes = instancesOf(graph, scope, "");
    if (prefixes.empty()) return std::nullopt;
    return *std::ranges::min_element(prefixes);
}

/// Gives the fields samples of particles, where these were made.
void takeParticles(Ir& ir, std::span<const FieldVolumePtr> made) {
    Program carrier;
    carrier.ir = std::move(ir);
    useParticles(carrier, made);
    ir = std::move(carrier.ir);
}

/// Of each of the fields, whether it needs samples that are not there yet.
std::vector<bool> waiting(const NodeFields& known) {
    const Ir& ir = known.ir;
    std::vector<bool> without(ir.size()), result;
    const auto& volumes = ir.volumes();
    const bool any = std::ranges::any_of(
        volumes, [](const FieldVolumePtr& volume) { return volume->standIn || !volume->made(); });
    if (!any) return std::vector<bool>(known.fields.size());
    for (IrId id = 0; id < ir.size(); ++id) {
        const IrNode& node = ir[id];
        for (int i = 0; i < opInfo(node.op).arity; ++i)
            if (without[node.operands[std::size_t(i)]]) without[id] = true;
        if (node.op != Op::volume) continue;
        const FieldVolumePtr& volume = volumes[std::size_t(node.number) / kVolumeLayers];
        if (volume->standIn || !volume->made()) without[id] = true;
    }
    for (const NodeField& field : known.fields) result.push_back(without[field.roots[0]]);
    return result;
}

std::string numberWords(double number, int digits) {
    if (std::isnan(number)) return "not a number";
    if (std::isinf(number)) return number > 0 ? "infinite" : "-infinite";
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, number == 0.0 ? 0.0 : number);
    return text;
}

}  // namespace

const std::string& ScopeFields::take(const Seen& seen, const std::string& scope) {
    if (asked.graph && asked.graph == seen.graph && asked.revision == seen.revision &&
        asked.pinned == seen.pinned && asked.seconds == seen.seconds && asked.particles == seen.particles &&
        askedScope == scope)
        return problem;
    asked = seen, askedScope = scope;
    known = {}, values.clear(), awaited.clear(), parts.clear(), problem.clear();
    double seconds = seen.seconds;
    const Graph graph = shownAt(*seen.graph, "", seconds);
    const std::optional<std::string> prefix = prefixOf(graph, scope);
    if (!prefix) return problem = "The group has no instance.";
    CompileOptions options;
    options.time = seconds;
    options.bake = boxInPlace;  // as Picker
    options.finest = kLeastFieldResolution;
    // A pinned node of a group is seen through an instance, which what is pinned beside the output may be.
    const std::string besides = seen.pinned.substr(0, seen.pinned.find('/'));
    Result<NodeFields> made = compileNodeFields(graph, *prefix, besides, options);
    if (!made) return problem = made.error().message;
    known = std::move(*made);
    takeParticles(known.ir, seen.particles);
    for (const LiveParameter& parameter : known.live) values.push_back(parameter.value);
    awaited = waiting(known);
    findParts(graph, scope);
    if (known.fields.empty()) problem = "Nothing here leads to the output.";
    return problem;
}

void ScopeFields::findParts(const Graph& graph, const std::string& scope) {
    std::map<std::string_view, std::vector<std::size_t>> byNode;
    for (std::size_t i = 0; i < known.fields.size(); ++i) byNode[known.fields[i].node].push_back(i);
    for (const Node& node : nodesOf(graph, scope)) {
        if (!byNode.contains(node.id)) continue;
        std::vector<Part> surfaces;
        for (const auto& [name, value] : node.inputs) {
            const Link* link = std::get_if<Link>(&value.value);
            const auto from = link ? byNode.find(link->node) : byNode.end();
            if (from == byNode.end()) continue;
            for (const std::size_t field : from->second) {
                const NodeField& given = known.fields[field];
                if (!link->output.empty() && given.output != link->output) continue;
                if (given.type == Type::surface) surfaces.push_back({name, field});
                break;
            }
        }
        if (surfaces.size() > 1) parts[node.id] = std::move(surfaces);
    }
}

std::optional<IrId> ScopeFields::root(const std::string& node, const std::string& output) const {
    for (std::size_t i = 0; i < known.fields.size(); ++i) {
        const NodeField& field = known.fields[i];
        if (field.node != node || awaited[i]) continue;
        if (output.empty() ? field.type == Type::surface || field.type == Type::scalar
                           : field.output == output)
            return field.roots[0];
    }
    return std::nullopt;
}

std::vector<Reading> ScopeFields::at(const Point& point) const {
    std::vector<IrId> roots;
    const auto countOf = [](const NodeField& field) {
        // Of a surface the distance and the base colour behind it.
        return field.type == Type::surface ? baseColorComponent + 3 : componentCount(field.type);
    };
    for (const NodeField& field : known.fields)
        roots.insert(roots.end(), field.roots.begin(), field.roots.begin() + countOf(field));
    const std::vector<ValueGradient> all = evaluateGradients(known.ir, roots, values, point);
    std::vector<Reading> readings;
    readings.reserve(known.fields.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < known.fields.size(); ++i) {
        const NodeField& field = known.fields[i];
        Reading& reading = readings.emplace_back(Reading{field.node, field.output, field.type, {}});
        const ValueGradient* const own = &all[next];
        next += std::size_t(countOf(field));
        reading.awaited = awaited[i];
        if (awaited[i]) continue;
        const auto& [x, y, z] = own->gradient;
        reading.slope = std::hypot(x, y, z);
        const int count = field.type == Type::surface ? 1 : componentCount(field.type);
        for (int k = 0; k < count; ++k) reading.numbers.push_back(own[k].value);
        if (field.type != Type::surface) continue;
        reading.color = {own[baseColorComponent].value, own[baseColorComponent + 1].value,
                         own[baseColorComponent + 2].value};
    }
    // Sharp booleans have the value of one of their parts, or its opposite; blends are nearest to that of the
    // part that counts most.
    for (Reading& reading : readings) {
        const auto its = parts.find(reading.node);
        if (reading.type != Type::surface || reading.awaited || its == parts.end()) continue;
        double least = INFINITY;
        for (const Part& part : its->second) {
            if (readings[part.field].numbers.empty()) continue;
            const double value = readings[part.field].numbers[0], own = reading.numbers[0],
                         off = std::min(std::abs(own - value), std::abs(own + value));
            if (off < least) least = off, reading.part = part.input;
        }
    }
    return readings;
}

std::string valueWords(const Reading& reading, int digits, const LengthUnit& lengths) {
    if (reading.numbers.empty()) return "being made";
    if (reading.type == Type::boolean) return reading.numbers[0] != 0.0 ? "true" : "false";
    if (reading.type == Type::surface) {
        // On a surface its distance is 0 but for the last bits.
        const double distance = std::abs(reading.numbers[0]) < kNothing ? 0.0 : reading.numbers[0];
        const std::string words = numberWords(distance, digits);
        return std::isfinite(reading.numbers[0]) ? words + " " + lengths.name : words;
    }
    if (reading.numbers.size() == 1) return numberWords(reading.numbers[0], digits);
    std::string words;
    for (double number : reading.numbers) words += (words.empty() ? "(" : ", ") + numberWords(number, digits);
    return words + ")";
}

}  // namespace fw::editor
