#include "graph/document/json.h"
#include "graph/base/words.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "graph/base/fence.h"
#include "graph/document/json_tokens.h"
#include "graph/document/unit.h"
#include "graph/library/node_type.h"

namespace fw {

namespace {

using Kind = JsonToken::Kind;
constexpr std::size_t kMaxWarnings = 100;

std::string_view kindName(Kind kind) {
    switch (kind) {
        case Kind::null: return "null";
        case Kind::boolean: return "a boolean";
        case Kind::number: return "a number";
        case Kind::string: return "a string";
        case Kind::array: return "an array";
        default: return "an object";
    }
}

/// Turns tokens into a Graph. Every function returns false after it has stored the one error; a lenient
/// reader keeps those of entries and members among the findings, and goes on without the entry or member.
class Reader {
  public:
    Reader(const JsonTokens& fileTokens, std::string path, std::vector<Error>* findings,
           bool isLenient = false)
        : tokens(fileTokens), list(fileTokens.list), warnings(findings), lenient(isLenient) {
        graph.path = std::move(path);
    }

    bool readRoot() {
        if (list[0].kind != Kind::object)
            return fail(0, "a graph is a JSON object such as {\"fieldwright\": 1, \"nodes\": []}, not " +
                               std::string(kindName(list[0].kind)));
        if (!readVersion()) return false;
        bool hasNodes = false;
        const bool sound = forMembers(0, [&](std::string_view key, uint32_t keyAt, uint32_t value) {
            if (key == "fieldwright") return true;
            if (key == "nodes") return hasNodes = true, readNodes(value, graph.nodes);
            if (key == "groups") return readList(value, key, graph.groups, &Reader::readGroup);
            if (key == "parameters") return readList(value, key, graph.parameters, &Reader::readParameter);
            if (key == "scene") return keep(value, key, Kind::object, graph.scene, &graph.scenePlaces);
            if (key == "timeline")
                return keep(value, key, Kind::object, graph.timeline, &graph.timelinePlaces);
            if (key == "frames") return keep(value, key, Kind::array, graph.frames);
            if (key == "unit") return readUnit(keyAt, value);
            if (key == "density") return readDensity(keyAt, value);
            return unknown(
                keyAt, graph.extra,
                {"nodes", "groups", "parameters", "scene", "timeline", "frames", "unit", "density"});
        });
        if (sound && !hasNodes)
            return fail(0, "the key \"nodes\" is missing: add \"nodes\": [...]") || leaveOut();
        if (sound && unknownKeys > kMaxWarnings)
            warn(0, std::to_string(unknownKeys - kMaxWarnings) + " more unknown keys are kept");
        return sound;
    }

    Graph graph;
    Error error;
    std::size_t leftOut = 0;

  private:
    Error finding(uint32_t index, std::string message, Error::Severity severity) const {
        const TextPosition at = list[index].at;
        return {.message = std::move(message),
                .file = graph.path,
                .node = node,
                .input = input,
                .line = at.line,
                .column = at.column,
                .severity = severity};
    }

    bool fail(uint32_t index, std::string message) {
        error = finding(index, std::move(message), Error::Severity::error);
        return false;
    }

    void warn(uint32_t index, std::string message) {
        if (warnings) warnings->push_back(finding(index, std::move(message), Error::Severity::warning));
    }

    bool failKind(uint32_t value, std::string_view key, std::string_view wanted) {
        return fail(value, "\"" + std::string(key) + "\" must be " + std::string(wanted) + ", not " +
                               std::string(kindName(list[value].kind)));
    }

    /// Whether to go on without what the error is about.
    bool leaveOut() {
        if (!lenient) return false;
        if (++leftOut <= kMaxWarnings) warnings->push_back(std::move(error));
        return true;
    }

    /// Calls use(key, index of the key, index of its value) for each member until one returns false.
    /// `needed`: the object makes no sense without any of them.
    template <class Use>
    bool forMembers(uint32_t object, Use use, bool needed = false) {
        for (uint32_t i = object + 1; i < list[object].next; i = list[i].next)
            if (!use(list[i].text, i, i + 1) && (needed || !leaveOut())) return false;
        return true;
    }

    /// Index of the value of this key; 0 if there is none.
    uint32_t member(uint32_t object, std::string_view key) {
        for (uint32_t i = object + 1; i < list[object].next; i = list[i].next)
            if (list[i].text == key) return i + 1;
        return 0;
    }

    std::size_t count(uint32_t array) const {
        std::size_t n = 0;
        for (uint32_t i = array + 1; i < list[array].next; i = list[i].next) ++n;
        return n;
    }

    bool unknown(uint32_t key, KeptJson& extra, const std::vector<std::string>& known) {
        if (++unknownKeys <= kMaxWarnings && warnings) {
            const std::string near = nearestName(list[key].text.substr(0, 64), known);
            warn(key, "unknown key " + inQuotes(list[key].text) + " is kept but has no effect" +
                          (near.empty() ? "" : "; did you mean '" + near + "'?"));
        }
        keepExtra(key, extra);
        return true;
    }

    void keepExtra(uint32_t key, KeptJson& extra) {
        if (extra->is_null()) extra = Json::object();
        extra->get_ref<Json::object_t&>().emplace_back(std::string(list[key].text), toJson(tokens, key + 1));
    }

    bool readUnit(uint32_t keyAt, uint32_t value) {
        std::string name;
        if (!read(value, "unit", name)) return false;
        std::vector<std::string> names;
        for (const LengthUnit& unit : lengthUnits()) names.emplace_back(unit.name);
        if (!lengthUnit(name))
            return fail(value, "the unit " + inQuotes(name) + " is none of " + listed(names));
        keepExtra(keyAt, graph.extra);
        return true;
    }

    bool readDensity(uint32_t keyAt, uint32_t value) {
        std::optional<double> density;
        if (!read(value, "density", density)) return false;
        if (!(*density > 0.0)) return fail(value, "the density must be above 0 g/cm³");
        keepExtra(keyAt, graph.extra);
        return true;
    }

    bool read(uint32_t value, std::string_view key, std::string& to) {
        if (list[value].kind != Kind::string) return failKind(value, key, "a string");
        to = list[value].text;
        return true;
    }

    bool read(uint32_t value, std::string_view key, bool& to) {
        if (list[value].kind != Kind::boolean) return failKind(value, key, "true or false");
        to = list[value].text == "true";
        return true;
    }

    bool read(uint32_t value, std::string_view key, std::optional<double>& to) {
        if (list[value].kind != Kind::number) return failKind(value, key, "a number");
        to = numberOf(list[value]);
        return true;
    }

    bool keep(uint32_t value, std::string_view key, Kind kind, KeptJson& to, TextPlaces* places = nullptr) {
        if (list[value].kind != kind) return failKind(value, key, kindName(kind));
        to = toJson(tokens, value);
        for (uint32_t i = value; places && i < list[value].next; ++i)
            if (list[i].kind != Kind::key) places->list.push_back(list[i].at);
        return true;
    }

    bool readVersion() {
        const uint32_t version = member(0, "fieldwright");
        if (version == 0)
            return fail(
                0,
                "this is not a Fieldwright graph: its object has no \"fieldwright\"; a graph begins with "
                "{\"fieldwright\": " +
                    std::to_string(kFormatVersion) + ", …}");
        const double number = list[version].kind == Kind::number ? numberOf(list[version]) : 0;
        if (number > kFormatVersion && number == std::floor(number))
            return fail(version, "the file has format version " +
                                     std::string(list[version].text.substr(0, 20)) +
                                     ", this program reads up to version " + std::to_string(kFormatVersion) +
                                     ": open it with a newer Fieldwright");
        if (number != kFormatVersion)
            return fail(version, "\"fieldwright\" is the version of the format and must be " +
                                     std::to_string(kFormatVersion));
        return true;
    }

    bool readNodes(uint32_t value, std::vector<Node>& nodes) {
        if (list[value].kind != Kind::array) return failKind(value, "nodes", "an array of nodes");
        const std::size_t n = count(value);
        nodeCount += n;
        if (nodeCount > kMaxNodes)
            return fail(value, "the graph has more than " + std::to_string(kMaxNodes) +
                                   " nodes: put what repeats into a group or a repeat node");
        nodes.reserve(n);
        return readList(value, "nodes", nodes, &Reader::readNode);
    }

    template <class Entry>
    bool readList(uint32_t value, std::string_view key, std::vector<Entry>& to,
                  bool (Reader::*readEntry)(uint32_t, Entry&), std::size_t limit = kMaxEntries) {
        if (list[value].kind != Kind::array) return failKind(value, key, "an array");
        if (count(value) > limit)
            return fail(value, "\"" + std::string(key) + "\" has more than " + std::to_string(limit) +
                                   " entries: split it");
        for (uint32_t i = value + 1; i < list[value].next; i = list[i].next) {
            if ((this->*readEntry)(i, to.emplace_back())) continue;
            if (!leaveOut()) return false;
            to.pop_back();
            node.clear();
        }
        return true;
    }

    bool readNode(uint32_t value, Node& to) {
        if (list[value].kind != Kind::object)
            return fail(value, "a node is an object such as {\"id\": \"ball\", \"type\": \"sphere\"}, not " +
                                   std::string(kindName(list[value].kind)));
        to.place = list[value].at;
        const uint32_t id = member(value, "id");
        if (id == 0) return fail(value, "the node has no \"id\": give it a name of its own");
        if (!read(id, "id", to.id)) return false;
        node = group.empty() ? to.id : group + "/" + to.id;
        const bool sound = forMembers(value, [&](std::string_view key, uint32_t keyAt, uint32_t i) {
            if (key == "id") return true;
            if (key == "type") return read(i, key, to.type);
            if (key == "label") return read(i, key, to.label);
            if (key == "at") return readPlace(i, to);
            if (key == "muted") return read(i, key, to.muted);
            if (key == "collapsed") return read(i, key, to.collapsed);
            if (key == "group") return read(i, key, to.group);
            if (key == "code") return to.codePlace = list[i].at, read(i, key, to.code);
            if (key == "inputs") return readInputs(i, to);
            return unknown(keyAt, to.extra,
                           {"type", "label", "at", "muted", "collapsed", "group", "code", "inputs"});
        });
        if (!sound) return false;
        if (to.type.empty())
            return fail(value, "the node has no \"type\": add one, such as \"type\": \"sphere\"");
        migrate(to);
        node.clear();
        return true;
    }

    /// Brings a node of a former format up to date. What changes with a version of the format is converted
    /// here; a renamed node type needs no new version, its former id is in the alias list of its entry.
    void migrate(Node& to) {
        if (const NodeType* type = findNodeType(to.type)) to.type = type->id;
    }

    bool readPlace(uint32_t value, Node& to) {
        const bool sound = list[value].kind == Kind::array && count(value) == 2 &&
                           list[value + 1].kind == Kind::number && list[value + 2].kind == Kind::number;
        if (!sound) return fail(value, "\"at\" is the place on the canvas: an array of two numbers");
        to.at = {numberOf(list[value + 1]), numberOf(list[value + 2])};
        return true;
    }

    bool readInputs(uint32_t value, Node& to) {
        if (list[value].kind != Kind::object)
            return failKind(value, "inputs", "an object of input names and values");
        if (count(value) > kMaxSockets)
            return fail(value,
                        "the node has more than " + std::to_string(kMaxSockets) + " inputs: remove some");
        to.inputs.reserve(count(value));
        return forMembers(value, [&](std::string_view key, uint32_t, uint32_t i) {
            input = key;
            const bool sound = readInput(i, to.inputs.emplace_back(std::string(key), InputValue{}).second);
            if (!sound) to.inputs.pop_back();
            input.clear();
            return sound;
        });
    }

    bool readInput(uint32_t value, InputValue& to) {
        const JsonToken& token = list[value];
        to.at = token.at;
        switch (token.kind) {
            case Kind::number: return to.value = numberOf(token), true;
            case Kind::boolean: return to.value = token.text == "true", true;
            case Kind::string: return to.value = std::string(token.text), true;
            case Kind::array: return readNumbers(value, to);
            case Kind::object: return readLink(value, to);
            default: return failInput(value, "null");
        }
    }

    bool failInput(uint32_t value, std::string_view given) {
        return fail(
            value,
            "an input is a number, true or false, a string, an array of numbers, an array of [x, y] "
            "pairs, of [position, red, green, blue] stops or of [x, y, z, radius, twist] knots, or a link "
            "{\"from\": \"node\"}; this is " +
                std::string(given) + " (leave the input out for its default)");
    }

    bool readNumbers(uint32_t value, InputValue& to) {
        std::vector<double> numbers;
        const uint32_t last = list[value].next;
        const bool entries = value + 1 < last && list[value + 1].kind == Kind::array;
        constexpr int kPlain = 3;  // of knots, whose radius is 1 and whose twist is 0 then
        const int given = entries ? int(list[value + 1].next - value) - 2 : 0;
        if (entries)
            to.entry =
                given == kPlain ? entrySize(Type::knots) : entrySize(listOf(given).value_or(Type::points));
        for (uint32_t i = value + 1; i < last; i = list[i].next) {
            if (list[i].kind != (entries ? Kind::array : Kind::number))
                return failInput(i, std::string(kindName(list[i].kind)) + " inside an array of " +
                                        (!entries        ? "numbers"
                                         : to.entry == 2 ? "pairs"
                                         : to.entry == 4 ? "stops"
                                                         : "knots"));
            if (entries) {
                const uint32_t end = list[i].next;
                const int own = int(end - i) - 1;
                const bool plain = to.entry == entrySize(Type::knots) && own == kPlain;
                if ((own != to.entry && !plain) ||
                    !std::all_of(list.begin() + i + 1, list.begin() + end,
                                 [](const JsonToken& token) { return token.kind == Kind::number; }))
                    return failInput(
                        i, i == value + 1 && to.entry == 2
                               ? "an array of something other than two, three, four or five numbers"
                           : to.entry == 2 ? "an array of something other than two numbers"
                           : to.entry == 4 ? "an array of something other than four numbers"
                                           : "an array of something other than three numbers or five");
                for (uint32_t k = i + 1; k < end; ++k) numbers.push_back(numberOf(list[k]));
                if (plain) numbers.insert(numbers.end(), {1.0, 0.0});
            } else {
                numbers.push_back(numberOf(list[i]));
            }
        }
        to.value = std::move(numbers);
        return true;
    }

    bool readLink(uint32_t value, InputValue& to) {
        Link link;
        if (member(value, "from") == 0) return failInput(value, "an object without \"from\"");
        const auto use = [&](std::string_view key, uint32_t keyAt, uint32_t i) {
            if (key == "from") return read(i, key, link.node);
            if (key == "output") return read(i, key, link.output);
            return unknown(keyAt, to.extra, {"from", "output"});
        };
        const bool sound = forMembers(value, use, true);
        to.value = std::move(link);
        return sound;
    }

    bool readParameter(uint32_t value, ExposedParameter& to) {
        if (list[value].kind != Kind::object)
            return fail(value, "a parameter is an object with \"name\", \"node\" and \"input\"");
        to.place = list[value].at;
        const auto use = [&](std::string_view key, uint32_t keyAt, uint32_t i) {
            if (key == "name") return read(i, key, to.name);
            if (key == "node") return read(i, key, to.node);
            if (key == "input") return read(i, key, to.input);
            if (key == "min") return read(i, key, to.min);
            if (key == "max") return read(i, key, to.max);
            return unknown(keyAt, to.extra, {"name", "node", "input", "min", "max"});
        };
        const bool sound = forMembers(value, use, true);
        for (const char* key : {"name", "node", "input"})
            if (sound && member(value, key) == 0)
                return fail(value, "the parameter has no \"" + std::string(key) + "\"");
        return sound;
    }

    bool readGroup(uint32_t value, Group& to) {
        if (list[value].kind != Kind::object)
            return fail(value, "a group is an object with \"id\", \"inputs\", \"outputs\" and \"nodes\"");
        to.place = list[value].at;
        const uint32_t id = member(value, "id");
        if (id == 0) return fail(value, "the group has no \"id\": give it a name of its own");
        if (!read(id, "id", to.id)) return false;
        group = to.id;
        const bool sound = forMembers(value, [&](std::string_view key, uint32_t keyAt, uint32_t i) {
            if (key == "id") return true;
            if (key == "file") return read(i, key, to.file);
            if (key == "taken") return read(i, key, to.taken);
            if (key == "inputs") return readList(i, key, to.inputs, &Reader::readGroupInput, kMaxSockets);
            if (key == "outputs") return readList(i, key, to.outputs, &Reader::readGroupOutput, kMaxSockets);
            if (key == "nodes") return readNodes(i, to.nodes);
            return unknown(keyAt, to.extra, {"id", "file", "taken", "inputs", "outputs", "nodes"});
        });
        group.clear();
        return sound;
    }

    bool readGroupInput(uint32_t value, GroupInput& to) { return readSocket(value, to, "input", &to.value); }
    bool readGroupOutput(uint32_t value, GroupOutput& to) { return readSocket(value, to, "output", nullptr); }

    template <class Socket>
    bool readSocket(uint32_t value, Socket& to, const std::string& what, std::optional<InputValue>* initial) {
        if (list[value].kind != Kind::object || member(value, "name") == 0 || member(value, "type") == 0)
            return fail(value,
                        "an " + what +
                            " of a group is an object such as {\"name\": \"radius\", \"type\": \"float\"}");
        to.place = list[value].at;
        const auto use = [&](std::string_view key, uint32_t keyAt, uint32_t i) {
            if (key == "name") return read(i, key, to.name);
            if (key == "type") return read(i, key, to.type);
            if (key == "value" && initial) return readInput(i, initial->emplace());
            return unknown(keyAt, to.extra, {"name", "type", "value"});
        };
        return forMembers(value, use, true);
    }

    const JsonTokens& tokens;
    const std::vector<JsonToken>& list;
    std::vector<Error>* warnings;
    bool lenient;
    std::string group, node, input;  ///< being read: for the place of a finding
    std::size_t nodeCount = 0, unknownKeys = 0;
};

Error fileError(const std::string& path, std::string message) {
    return {.message = std::move(message), .file = path};
}

}  // namespace

Result<Graph> parseGraph(std::string_view text, std::string path, std::vector<Error>* warnings) {
    const Result<JsonTokens> tokens = tokenize(text, path);
    if (!tokens) return tokens.error();
    Reader reader(*tokens, std::move(path), warnings);
    if (!reader.readRoot()) return std::move(reader.error);
    return std::move(reader.graph);
}

PartialGraph parseWhatCanBeRead(std::string_view text, std::string path) {
    PartialGraph partial;
    partial.graph.path = path;
    const Result<JsonTokens> tokens = tokenize(text, path);
    if (!tokens) {
        partial.findings.push_back(tokens.error());
        return partial;
    }
    Reader reader(*tokens, std::move(path), &partial.findings, true);
    if (!reader.readRoot()) {
        partial.findings.push_back(std::move(reader.error));
        return partial;
    }
    partial.graph = std::move(reader.graph);
    if (reader.leftOut > kMaxWarnings)
        partial.findings.push_back({.message = std::to_string(reader.leftOut - kMaxWarnings) +
                                               " more things cannot be read and are left out",
                                    .file = partial.graph.path});
    partial.whole = reader.leftOut == 0;
    partial.any = true;
    return partial;
}

Result<std::string> readGraphText(const std::string& path) {
    if (const Done inside = checkMayRead(path); !inside) return inside.error();
    // A pipe that nobody writes to ends at once; from others what comes is waited for.
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return fileError(path, errno == ENOENT ? "there is no such file: check the path"
                               : errno == EACCES
                                   ? "no permission to read the file: change its permissions"
                                   : "cannot open the file: " + std::string(std::strerror(errno)));
    if (const Done inside = checkFenced(file, path); !inside) {
        close(file);
        return inside.error();
    }
    // One byte beyond the limit is enough to know; the size that the system reports is not to be trusted for
    // pipes.
    constexpr std::size_t kPiece = 64u << 10;
    std::string text;
    ssize_t got = 0;
    do {
        const std::size_t length = text.size();
        text.resize(length + kPiece);
        got = ::read(file, text.data() + length, kPiece);
        pollfd ready{file, POLLIN, 0};
        if (got < 0 && errno == EAGAIN) poll(&ready, 1, -1);
        text.resize(length + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    } while ((got > 0 && text.size() <= kMaxFileBytes) || (got < 0 && (errno == EINTR || errno == EAGAIN)));
    const int problem = got < 0 ? errno : 0;
    close(file);
    if (problem == EISDIR) return fileError(path, "this is a folder: name a graph file in it");
    if (problem != 0) return fileError(path, "cannot read the file: " + std::string(std::strerror(problem)));
    return text;
}

Result<Graph> readGraph(const std::string& path, std::vector<Error>* warnings) {
    const Result<std::string> text = readGraphText(path);
    if (!text) return text.error();
    return parseGraph(*text, path, warnings);
}

}  // namespace fw
