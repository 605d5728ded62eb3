// The writing half of json.h.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <variant>

#include "graph/base/fence.h"
#include "graph/document/json.h"

namespace fw {

namespace {

constexpr std::size_t kLineWidth = 120;

/// Shortest text that reads back as the same double; plain digits where a person would write them.
void appendNumber(std::string& out, double value) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    value = std::isnan(value) ? 0.0 : std::clamp(value, -kLargest, kLargest);
    char text[64];
    const double size = std::abs(value);
    const bool plain = size == 0 || (size >= 1e-5 && size < 1e16);
    const auto end = plain ? std::to_chars(text, std::end(text), value, std::chars_format::fixed)
                           : std::to_chars(text, std::end(text), value);
    out.append(text, end.ptr);
}

/// A number, string, boolean or null. Bytes that are not UTF-8 become U+FFFD.
void appendScalar(std::string& out, const Json& value) {
    if (value.is_number_float())
        appendNumber(out, value.get<double>());
    else
        out += value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Lays JSON out: a value that fits stands on one line, a longer one has a line for each member. Columns are
/// bytes.
class Layout {
  public:
    std::string out;

    /// A member of the file's outermost object: an array always has a line for each entry.
    void section(const std::string& key, const Json& value) {
        out += out.empty() ? "{\n  " : ",\n  ";
        appendScalar(out, key);
        out += ": ";
        const bool list = key == "nodes" || key == "groups" || key == "parameters";
        if (list && !value.empty()) {
            out += '[';
            entries(value, 4, [&](const Json& entry) { key == "groups" ? group(entry) : packed(entry, 4); });
            out += "\n  ]";
        } else {
            any(value, 2);
        }
    }

  private:
    std::size_t column() const {
        const std::size_t newline = out.rfind('\n');
        return newline == std::string::npos ? out.size() : out.size() - newline - 1;
    }

    void newline(std::size_t indent) { out += '\n', out.append(indent, ' '); }

    template <class Write>
    void entries(const Json& array, std::size_t indent, Write write) {
        bool first = true;
        for (const Json& entry : array) {
            if (!std::exchange(first, false)) out += ',';
            newline(indent);
            write(entry);
        }
    }

    /// Appends `value` without line breaks if `out` then ends before byte `limit`; else leaves `out` as it
    /// was.
    bool oneLine(const Json& value, std::size_t limit) {
        const std::size_t begin = out.size();
        if (!appendOneLine(value, limit)) return out.resize(begin), false;
        return true;
    }

    bool appendOneLine(const Json& value, std::size_t limit) {
        if (!value.is_structured()) return appendScalar(out, value), out.size() <= limit;
        bool first = true;
        out += value.is_array() ? '[' : '{';
        for (const auto& [key, entry] : value.items()) {
            if (!std::exchange(first, false)) out += ", ";
            if (value.is_object()) appendScalar(out, key), out += ": ";
            if (!appendOneLine(entry, limit)) return false;
        }
        out += value.is_array() ? ']' : '}';
        return out.size() <= limit;
    }

    /// Tries one line, with room for a comma or two brackets after it.
    bool fits(const Json& value) { return oneLine(value, out.size() - column() + kLineWidth - 3); }

    void any(const Json& value, std::size_t indent) {
        if (!value.is_structured()) return appendScalar(out, value);
        if (value.empty() || fits(value))
            return void(value.empty() && (out += value.is_array() ? "[]" : "{}", true));
        if (value.is_array() &&
            std::none_of(value.begin(), value.end(), [](const Json& e) { return e.is_structured(); }))
            return filled(value, indent);
        bool first = true;
        out += value.is_array() ? '[' : '{';
        for (const auto& [key, entry] : value.items()) {
            if (!std::exchange(first, false)) out += ',';
            newline(indent + 2);
            if (value.is_object()) appendScalar(out, key), out += ": ";
            any(entry, indent + 2);
        }
        newline(indent);
        out += value.is_array() ? ']' : '}';
    }

    /// A long array of scalars: as many on a line as fit.
    void filled(const Json& array, std::size_t indent) {
        std::size_t lineBegin = 0;
        bool first = true;
        out += '[';
        for (const Json& entry : array) {
            std::string text;
            appendScalar(text, entry);
            if (!first) out += ',';
            if (first || out.size() - lineBegin + text.size() + 2 > kLineWidth) {
                lineBegin = out.size() + 1;
                newline(indent + 2);
            } else {
                out += ' ';
            }
            out += text;
            first = false;
        }
        newline(indent);
        out += ']';
    }

    /// A node or parameter: on one line, or its short members on the first line and each longer one below.
    void packed(const Json& object, std::size_t indent) {
        if (fits(object)) return;
        bool first = true;
        out += '{';
        for (const auto& [key, value] : object.items()) {
            const bool head = key == "at" || (!value.is_structured() && key != "code");
            if (!std::exchange(first, false)) out += ',', head ? void(out += ' ') : newline(indent + 1);
            appendScalar(out, key);
            out += ": ";
            any(value, indent + 1);
        }
        out += '}';
    }

    void group(const Json& object) {
        bool first = true;
        out += '{';
        for (const auto& [key, value] : object.items()) {
            if (!std::exchange(first, false)) out += ',';
            newline(6);
            appendScalar(out, key);
            out += ": ";
            if (key != "nodes") {
                any(value, 6);
                continue;
            }
            out += '[';
            entries(value, 8, [&](const Json& node) { packed(node, 8); });
            newline(6);
            out += ']';
        }
        newline(4);
        out += '}';
    }
};

/// Adds a member without the linear search of operator[] for one that is there already.
void add(Json& object, const std::string& key, Json value) {
    object.get_ref<Json::object_t&>().emplace_back(key, std::move(value));
}

void addExtra(Json& to, const Json& extra) {
    for (const auto& [key, value] : extra.items()) add(to, key, value);
}

Json jsonOf(const Group& group);

Json jsonOf(const InputValue& input) {
    struct {
        const InputValue& input;
        Json operator()(double value) const { return value; }
        Json operator()(bool value) const { return value; }
        Json operator()(const std::string& value) const { return value; }
        Json operator()(const std::vector<double>& numbers) const {
            Json array = Json::array();
            const auto entry = static_cast<std::size_t>(input.entry);
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                if (entry > 0 && i % entry == 0) array.push_back(Json::array());
                (entry > 0 ? array.back() : array).push_back(numbers[i]);
            }
            return array;
        }
        Json operator()(const Link& link) const {
            Json object = {{"from", link.node}};
            if (!link.output.empty()) object["output"] = link.output;
            addExtra(object, input.extra);
            return object;
        }
    } convert{input};
    return std::visit(convert, input.value);
}

Json jsonOf(const Node& node) {
    Json object = {{"id", node.id}, {"type", node.type}};
    if (!node.label.empty()) object["label"] = node.label;
    if (node.at) object["at"] = {(*node.at)[0], (*node.at)[1]};
    if (node.muted) object["muted"] = true;
    if (node.collapsed) object["collapsed"] = true;
    if (!node.group.empty()) object["group"] = node.group;
    if (!node.inputs.empty()) {
        Json& inputs = object["inputs"] = Json::object();
        for (const auto& [name, value] : node.inputs) add(inputs, name, jsonOf(value));
    }
    if (!node.code.empty()) object["code"] = node.code;
    addExtra(object, node.extra);
    return object;
}

template <class Socket>
Json jsonOfSocket(const Socket& socket, const std::optional<InputValue>& value) {
    Json object = {{"name", socket.name}, {"type", socket.type}};
    if (value) object["value"] = jsonOf(*value);
    addExtra(object, socket.extra);
    return object;
}

Json jsonOf(const GroupInput& input) { return jsonOfSocket(input, input.value); }
Json jsonOf(const GroupOutput& output) { return jsonOfSocket(output, std::nullopt); }

Json jsonOf(const ExposedParameter& parameter) {
    Json object = {{"name", parameter.name}, {"node", parameter.node}, {"input", parameter.input}};
    if (parameter.min) object["min"] = *parameter.min;
    if (parameter.max) object["max"] = *parameter.max;
    addExtra(object, parameter.extra);
    return object;
}

template <class Entry>
Json jsonOf(const std::vector<Entry>& entries) {
    Json array = Json::array();
    for (const Entry& entry : entries) array.push_back(jsonOf(entry));
    return array;
}

Json jsonOf(const Group& group) {
    Json object = {{"id", group.id}};
    if (!group.file.empty()) object["file"] = group.file;
    if (!group.taken.empty()) object["taken"] = group.taken;
    if (!group.inputs.empty()) object["inputs"] = jsonOf(group.inputs);
    if (!group.outputs.empty()) object["outputs"] = jsonOf(group.outputs);
    object["nodes"] = jsonOf(group.nodes);
    addExtra(object, group.extra);
    return object;
}

bool finite(const InputValue& input) {
    if (const double* number = std::get_if<double>(&input.value)) return std::isfinite(*number);
    if (const auto* numbers = std::get_if<std::vector<double>>(&input.value))
        return std::all_of(numbers->begin(), numbers->end(), [](double x) { return std::isfinite(x); });
    return true;
}

/// The first number that JSON cannot hold.
std::optional<Error> notFinite(const Graph& graph, const std::string& path) {
    const auto error = [&](std::string node, std::string input) {
        return Error{
            .message = "the value is not a finite number and a file cannot hold it: change it and save again",
            .file = path,
            .node = std::move(node),
            .input = std::move(input)};
    };
    const auto inNodes = [&](const std::vector<Node>& nodes,
                             const std::string& prefix) -> std::optional<Error> {
        for (const Node& node : nodes) {
            if (node.at && !(std::isfinite((*node.at)[0]) && std::isfinite((*node.at)[1])))
                return error(prefix + node.id, "at");
            for (const auto& [name, value] : node.inputs)
                if (!finite(value)) return error(prefix + node.id, name);
        }
        return {};
    };
    if (auto found = inNodes(graph.nodes, "")) return found;
    for (const Group& group : graph.groups) {
        if (auto found = inNodes(group.nodes, group.id + "/")) return found;
        for (const GroupInput& input : group.inputs)
            if (input.value && !finite(*input.value)) return error(group.id, input.name);
    }
    for (const ExposedParameter& p : graph.parameters)
        if (!std::isfinite(p.min.value_or(0)) || !std::isfinite(p.max.value_or(0)))
            return error(p.node, p.input);
    return {};
}

Error saveError(const std::string& path, int code) {
    std::string message;
    switch (code) {
        case EACCES:
        case EPERM: message = "no permission to write here: change the permissions or save elsewhere"; break;
        case ENOSPC:
        case EDQUOT: message = "the disk is full: make room or save elsewhere"; break;
        case EROFS: message = "the disk is read-only: save elsewhere"; break;
        case ENOENT:
        case ENOTDIR: message = "the folder does not exist: create it or save elsewhere"; break;
        case ENODEV: message = "this is a device or a pipe: name an ordinary file"; break;
        case EISDIR: message = "this is a folder: add a file name"; break;
        default: message = "cannot write the file: " + std::string(std::strerror(code));
    }
    return {.message = std::move(message), .file = path};
}

/// 0, or the errno of the first step that failed.
int writeAndSync(int file, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return fsync(file) == 0 ? 0 : errno;
}

}  // namespace

std::string writeGraph(const Graph& graph) {
    Layout layout;
    layout.section("fieldwright", kFormatVersion);
    layout.section("nodes", jsonOf(graph.nodes));
    if (!graph.groups.empty()) layout.section("groups", jsonOf(graph.groups));
    if (!graph.parameters.empty()) layout.section("parameters", jsonOf(graph.parameters));
    if (!graph.frames->is_null()) layout.section("frames", graph.frames);
    if (!graph.scene->is_null()) layout.section("scene", graph.scene);
    if (!graph.timeline->is_null()) layout.section("timeline", graph.timeline);
    for (const auto& [key, value] : graph.extra->items()) layout.section(key, value);
    return layout.out + "\n}\n";
}

Done saveGraph(const Graph& graph, const std::string& path) {
    if (auto error = notFinite(graph, path)) return *error;
    // Renaming over a symbolic link would replace the link, so the file it leads to is the one written.
    std::string target = path;
    if (char* real = realpath(path.c_str(), nullptr)) target = real, std::free(real);
    if (const Done inside = checkMayWrite(target); !inside) return inside.error();
    struct stat former;
    const bool exists = stat(target.c_str(), &former) == 0;
    if (exists && S_ISDIR(former.st_mode)) return saveError(path, EISDIR);
    if (exists && !S_ISREG(former.st_mode)) return saveError(path, ENODEV);
    if (exists && access(target.c_str(), W_OK) != 0) return saveError(path, errno);

    std::string temporary;
    int file = -1;
    for (int attempt = 0; file < 0 && attempt < 100; ++attempt) {
        temporary = target + "." + std::to_string(getpid()) + "-" + std::to_string(attempt);
        file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file < 0 && errno != EEXIST) break;
    }
    if (file < 0) return saveError(path, errno);
    int problem = exists && fchmod(file, former.st_mode & 07777) != 0 ? errno : 0;
    if (problem == 0) problem = writeAndSync(file, writeGraph(graph));
    if (close(file) != 0 && problem == 0) problem = errno;
    if (problem == 0 && std::rename(temporary.c_str(), target.c_str()) != 0) problem = errno;
    if (problem != 0) {
        unlink(temporary.c_str());
        return saveError(path, problem);
    }
    // The rename itself reaches the disk with the folder. Some file systems refuse this; the data is safe
    // anyway.
    const std::size_t slash = target.rfind('/');
    const std::string folder = slash == std::string::npos ? "." : target.substr(0, slash + 1);
    if (const int handle = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); handle >= 0) {
        fsync(handle);
        close(handle);
    }
    return done();
}

}  // namespace fw
