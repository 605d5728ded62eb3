#include "graph/implicit3mf/functions.h"

#include <algorithm>

#include "graph/base/words.h"
#include "graph/implicit3mf/function_group.h"

namespace fw::threemf {

std::string functionWords(const std::string& name, int id) {
    return "the function " + inQuotes(name) + " (id " + std::to_string(id) + ")";
}

std::string socketName(const std::string& name) {
    std::string fit = name.empty() || (name[0] >= '0' && name[0] <= '9') ? "_" + name : name;
    for (char& c : fit)
        if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9')) c = '_';
    return fit;
}

std::string freshId(std::string_view text, std::set<std::string, std::less<>>& taken) {
    std::string id;
    for (const char c : lowered(text)) {
        const bool letter = c >= 'a' && c <= 'z', digit = c >= '0' && c <= '9';
        if (letter || (digit && !id.empty()))
            id += c;
        else if (!id.empty() && id.back() != '_')
            id += '_';
        if (id.size() > 40) break;
    }
    while (!id.empty() && id.back() == '_') id.pop_back();
    if (id.empty()) id = "n";
    std::string fresh = id;
    for (int i = 2; !taken.insert(fresh).second; ++i) fresh = id + "_" + std::to_string(i);
    return fresh;
}

InputValue linkTo(std::string node, std::string output) {
    return {.value = Link{std::move(node), std::move(output)}};
}

Node& addNode(std::vector<Node>& nodes, std::set<std::string, std::less<>>& taken, std::string type,
              std::string_view name) {
    Node& node = nodes.emplace_back();
    node.id = freshId(name, taken);
    node.type = std::move(type);
    return node;
}

std::string productCode(const std::array<std::string, 12>& entries, const std::string& v) {
    std::string text;
    for (std::size_t column = 0; column < 3; ++column) {
        std::string sum;
        for (std::size_t row = 0; row < 4; ++row) {
            const std::string& entry = entries[3 * row + column];
            if (entry == "0" || entry == "-0") continue;
            const std::string component = row < 3 ? v + "." + char('x' + int(row)) : "";
            sum += sum.empty() ? "" : " + ";
            sum += row == 3 ? entry : entry == "1" ? component : entry + " * " + component;
        }
        text += (column == 0 ? "vec3(" : ",\n     ") + (sum.empty() ? "0.0" : sum);
    }
    return text + ")";
}

std::string productCode(const Affine& matrix, const std::string& v) {
    std::array<std::string, 12> entries;
    for (int i = 0; i < 12; ++i) entries[std::size_t(i)] = exactNumber(matrix[i / 3][i % 3]);
    return productCode(entries, v);
}

FunctionGroups::FunctionGroups(const Model& model_, const Package& package_, Graph& graph_, FileNames files_)
    : model(model_), files(std::move(files_)), package(package_), graph(graph_) {}

Result<const Group*> FunctionGroups::group(int id, const Resources& resources, int depth) {
    const auto known = made.find({id, resources});
    if (known != made.end()) return &graph.groups[known->second];
    const Function* function = entry(model.functions, id);
    const ImageFunction* pictures = entry(model.imageFunctions, id);
    if (!function && !pictures)
        return Error{.message = "there is no function with the id " + std::to_string(id)};
    const Result<std::size_t> at = function ? ofFunction(*function, resources, depth) : ofPictures(*pictures);
    if (!at) return at.error();
    made[{id, resources}] = *at;
    return &graph.groups[*at];
}

Result<std::size_t> FunctionGroups::ofFunction(const Function& function, const Resources& resources,
                                               int depth) {
    const std::string whose = functionWords(function.name, function.id);
    if (within.contains(function.id))
        return Error{.message = whose + " calls itself, by way of others or directly"};
    if (depth >= kMaxNesting - 1)
        return Error{.message = whose + " is called through more than " + std::to_string(kMaxNesting) +
                                " others: a graph nests no deeper"};
    within.insert(function.id);
    Result<Group> group = groupOf(*this, function, resources, depth);
    within.erase(function.id);
    if (!group) return group.error();
    nodes += group->nodes.size();
    if (nodes > kMaxNodes || graph.groups.size() >= kMaxEntries)
        return Error{.message =
                         "its functions have more nodes than a graph may, " + std::to_string(kMaxNodes)};
    if (group->inputs.size() > kMaxSockets || group->outputs.size() > kMaxSockets)
        return Error{.message =
                         whose + " has more than " + std::to_string(kMaxSockets) + " inputs or outputs"};
    group->id =
        freshId(function.name.empty() ? "function_" + std::to_string(function.id) : function.name, groupIds);
    graph.groups.push_back(std::move(*group));
    return graph.groups.size() - 1;
}

Result<const Sheets*> FunctionGroups::sheets(int id) {
    const auto known = stacks.find(id);
    if (known != stacks.end()) return &known->second;
    const ImageStack* stack = entry(model.stacks, id);
    if (!stack) return Error{.message = "there is no image3d with the id " + std::to_string(id)};
    Result<Sheets> read = readSheets(package, *stack);
    if (!read) return read.error();
    remarks.insert(remarks.end(), read->remarks.begin(), read->remarks.end());
    return &stacks.emplace(id, std::move(*read)).first->second;
}

/// A group with the pictures as inputs, so that they are files of the document, and an output each for the
/// colour and its parts.
Result<std::size_t> FunctionGroups::ofPictures(const ImageFunction& function) {
    const Result<const Sheets*> read = sheets(function.stack);
    if (!read) return read.error();
    const Sheets& pictures = **read;
    Group group;
    std::set<std::string, std::less<>> ids;
    const std::string in = addNode(group.nodes, ids, "group_input", "in").id;
    group.inputs.push_back({.name = "pos", .type = "vec3", .value = {}, .extra = {}, .place = {}});
    for (const SheetPicture& picture : pictures.pictures)
        group.inputs.push_back({.name = picture.name,
                                .type = "image",
                                .value = InputValue{.value = files.picture(function.stack, picture)},
                                .extra = {},
                                .place = {}});
    const std::size_t each = pictures.fine ? 2 : 1;
    std::vector<std::string> channels;
    for (std::size_t i = 0; i < pictures.pictures.size(); i += each) {
        Node& node = addNode(group.nodes, ids, "expression", pictures.pictures[i].name);
        node.code = sheetCode(pictures, function);
        node.set("place", linkTo(in, "pos"));
        node.set("image", linkTo(in, pictures.pictures[i].name));
        if (pictures.fine) node.set("fine", linkTo(in, pictures.pictures[i + 1].name));
        channels.push_back(node.id);
    }
    std::array<InputValue, 4> values;
    for (std::size_t i = 0; i < 4; ++i) {
        const int channel = pictures.channels[i];
        values[i] = channel < 0 ? InputValue{.value = function.offset + function.scale}
                                : linkTo(channels[std::size_t(channel)]);
    }
    Node& color = addNode(group.nodes, ids, "combine_xyz", "color");
    color.set("x", values[0]), color.set("y", values[1]), color.set("z", values[2]);
    const std::string mixed = color.id;
    Node& out = addNode(group.nodes, ids, "group_output", "out");
    out.set("color", linkTo(mixed));
    group.outputs.push_back({.name = "color", .type = "vec3", .extra = {}, .place = {}});
    const char* const names[] = {"red", "green", "blue", "alpha"};
    for (std::size_t i = 0; i < 4; ++i) {
        out.set(names[i], values[i]);
        group.outputs.push_back({.name = names[i], .type = "float", .extra = {}, .place = {}});
    }
    nodes += group.nodes.size();
    group.id = freshId(function.name.empty() ? "pictures_" + std::to_string(function.stack) : function.name,
                       groupIds);
    graph.groups.push_back(std::move(group));
    return graph.groups.size() - 1;
}

}  // namespace fw::threemf
