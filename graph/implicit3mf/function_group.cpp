#include "graph/implicit3mf/function_group.h"

#include <algorithm>

#include "graph/base/words.h"
#include "graph/implicit3mf/operations.h"

namespace fw::threemf {

namespace {

constexpr int kMeshResolution = 128;  // of the grid that a mesh's distance is measured on

std::string entryName(const std::string& matrix, int i) {
    return socketName(matrix) + "_m" + std::to_string(i / 4) + std::to_string(i % 4);
}

const char* typeInFiles(ValueType type) { return type == ValueType::vector ? "vec3" : "float"; }

class GroupMaker {
  public:
    GroupMaker(FunctionGroups& all_, const Function& function_, const FunctionGroups::Resources& resources_,
               int depth_)
        : all(all_), function(function_), resources(resources_), depth(depth_) {}

    Result<Group> run() {
        addInputs();
        count();
        for (const FunctionNode* node : ordered()) {
            if (problem) break;
            make(*node);
        }
        addOutputs();
        if (problem) return *problem;
        return std::move(group);
    }

  private:
    void fail(const std::string& what) {
        if (!problem) problem = Error{.message = functionWords(function.name, function.id) + ": " + what};
    }
    void fail(const FunctionNode& node, const std::string& what) {
        fail("its node " + inQuotes(node.id) + " (" + node.kind + ") " + what);
    }

    // ---- inputs and outputs

    void addInputs() {
        Node& input = addNode(group.nodes, ids, "group_input", "in");
        for (const Socket& socket : function.inputs) {
            Value& value = values["inputs." + socket.name];
            value.type = socket.type;
            if (socket.type == ValueType::resource) {
                const auto given = resources.find(socket.name);
                if (given == resources.end())
                    fail("it takes the resource " + inQuotes(socket.name) + ", and is given none");
                else
                    value.resource = given->second;
                continue;
            }
            const int parts = socket.type == ValueType::matrix ? 16 : 1;
            for (int i = 0; i < parts; ++i) {
                const std::string name = parts > 1 ? entryName(socket.name, i) : socketName(socket.name);
                group.inputs.push_back(
                    {.name = name, .type = typeInFiles(socket.type), .value = {}, .extra = {}, .place = {}});
                value.parts.push_back(linkTo(input.id, name));
            }
        }
    }

    void addOutputs() {
        if (problem) return;
        Node output;
        output.id = freshId("out", ids), output.type = "group_output";
        for (const Reference& reference : function.outputs) {
            const Value* value = valueOf(reference);
            if (!value) return;
            if (value->type == ValueType::resource) return fail("it gives a resource, which is not read");
            for (int i = 0; i < int(value->parts.size()); ++i) {
                const std::string name = value->type == ValueType::matrix ? entryName(reference.name, i)
                                                                          : socketName(reference.name);
                group.outputs.push_back(
                    {.name = name, .type = typeInFiles(value->type), .extra = {}, .place = {}});
                output.set(name, value->parts[std::size_t(i)]);
            }
        }
        group.nodes.push_back(std::move(output));
    }

    // ---- order

    /// How often each node is referred to.
    void count() {
        for (const FunctionNode& node : function.nodes)
            for (const Reference& input : node.inputs) ++uses[input.node];
        for (const Reference& output : function.outputs) ++uses[output.node];
    }

    /// The nodes, each behind those that it refers to; in the order of the file otherwise.
    std::vector<const FunctionNode*> ordered() {
        std::map<std::string_view, std::size_t> places;
        for (std::size_t i = 0; i < function.nodes.size(); ++i)
            if (!places.emplace(function.nodes[i].id, i).second)
                fail("two nodes are called " + inQuotes(function.nodes[i].id));
        std::vector<std::size_t> waits(function.nodes.size());
        std::vector<std::vector<std::size_t>> users(function.nodes.size());
        for (std::size_t i = 0; i < function.nodes.size(); ++i)
            for (const Reference& input : function.nodes[i].inputs) {
                const auto from = places.find(input.node);
                if (from == places.end()) continue;
                users[from->second].push_back(i);
                ++waits[i];
            }
        std::set<std::size_t> ready;
        for (std::size_t i = 0; i < waits.size(); ++i)
            if (waits[i] == 0) ready.insert(i);
        std::vector<const FunctionNode*> order;
        while (!ready.empty()) {
            const std::size_t next = *ready.begin();
            ready.erase(ready.begin());
            order.push_back(&function.nodes[next]);
            for (const std::size_t user : users[next])
                if (--waits[user] == 0) ready.insert(user);
        }
        if (order.size() < waits.size()) {
            const auto waiting = std::ranges::find_if(waits, [](std::size_t n) { return n > 0; });
            fail(function.nodes[std::size_t(waiting - waits.begin())], "refers to itself by way of others");
        }
        return order;
    }

    // ---- values

    const Value* valueOf(const Reference& reference) {
        const std::string name = reference.node + "." + reference.output;
        const auto found = values.find(name);
        if (found == values.end()) {
            fail("there is no " + inQuotes(name) + " for " + inQuotes(reference.name));
            return nullptr;
        }
        if (found->second.type != reference.type) {
            fail(inQuotes(name) + " is a " + nameOf(found->second.type) + ", and " +
                 inQuotes(reference.name) + " takes a " + nameOf(reference.type));
            return nullptr;
        }
        return &found->second;
    }

    /// What the node's input is given; an error where that is nothing, or of another type if one is asked
    /// for.
    const Value* given(const FunctionNode& node, std::string_view name, std::optional<ValueType> type = {}) {
        const Reference* reference = node.input(name);
        if (!reference) {
            fail(node, "is not given " + inQuotes(name));
            return nullptr;
        }
        const Value* value = valueOf(*reference);
        if (value && type && value->type != *type) {
            fail(node, "takes a " + std::string(nameOf(*type)) + " for " + inQuotes(name) +
                           ", and is given a " + nameOf(value->type));
            return nullptr;
        }
        return value;
    }

    void set(const FunctionNode& node, const std::string& output, Value value) {
        values[node.id + "." + output] = std::move(value);
    }
    /// Of a node with one result, by whatever name the file has it.
    void setResult(const FunctionNode& node, Value value) {
        for (const Socket& socket : node.outputs) set(node, socket.name, value);
        if (node.outputs.empty()) fail(node, "has no output");
        for (const Socket& socket : node.outputs)
            if (socket.type != value.type)
                return fail(node, "gives a " + std::string(nameOf(value.type)) +
                                      ", and is written to give a " + nameOf(socket.type));
    }

    Node& add(const FunctionNode& from, std::string type) {
        if (group.nodes.size() > kMaxNodes)
            fail("it has more nodes than a graph may, " + std::to_string(kMaxNodes));
        Node& node = addNode(group.nodes, ids, std::move(type), from.id);
        // A name that a program gave says no more than the node's type.
        const std::size_t end = from.label.find_last_not_of("0123456789");
        const bool numbered =
            end != std::string::npos && from.label[end] == '_' && end + 1 < from.label.size();
        if (!numbered && lowered(from.label) != from.kind) node.label = from.label;
        return node;
    }
    Node& addCode(const FunctionNode& from, const std::string& code) {
        Node& node = add(from, "expression");
        node.code = code;
        return node;
    }
    static Value single(ValueType type, InputValue value) { return {type, {std::move(value)}}; }

    // ---- nodes

    void make(const FunctionNode& node) {
        if (const Operation* known = operation(node.kind)) return componentwise(node, *known);
        using Maker = void (GroupMaker::*)(const FunctionNode&);
        static const std::map<std::string_view, Maker> kMakers = {
            {"constant", &GroupMaker::constant},
            {"constvec", &GroupMaker::constant},
            {"constmat", &GroupMaker::constantMatrix},
            {"constresourceid", &GroupMaker::constantResource},
            {"composevector", &GroupMaker::composeVector},
            {"vectorfromscalar", &GroupMaker::vectorFromScalar},
            {"decomposevector", &GroupMaker::decomposeVector},
            {"composematrix", &GroupMaker::composeMatrix},
            {"matrixfromcolumns", &GroupMaker::matrixFromVectors},
            {"matrixfromrows", &GroupMaker::matrixFromVectors},
            {"dot", &GroupMaker::measure},
            {"length", &GroupMaker::measure},
            {"cross", &GroupMaker::cross},
            {"matvecmultiplication", &GroupMaker::multiply},
            {"matrixvectormultiplication", &GroupMaker::multiply},
            {"transpose", &GroupMaker::transpose},
            {"inverse", &GroupMaker::inverse},
            {"mesh", &GroupMaker::mesh},
            {"unsignedmesh", &GroupMaker::mesh},
            {"functioncall", &GroupMaker::call},
        };
        const auto maker = kMakers.find(node.kind);
        if (maker == kMakers.end()) return fail(node, "is of a kind that is not known here");
        (this->*maker->second)(node);
    }

    void componentwise(const FunctionNode& node, const Operation& known) {
        std::vector<Value> operands;
        for (std::size_t i = 0; i < known.count(); ++i) {
            const Value* value = given(node, known.inputs[i]);
            if (!value) return;
            if (value->type != (operands.empty() ? value->type : operands[0].type) ||
                value->type == ValueType::resource)
                return fail(node, "mixes a " +
                                      std::string(nameOf(operands.empty() ? value->type : operands[0].type)) +
                                      " with a " + nameOf(value->type));
            operands.push_back(*value);
        }
        Value result{operands[0].type};
        const bool vectors = result.type == ValueType::vector;
        for (std::size_t part = 0; part < operands[0].parts.size(); ++part) {
            std::string_view op = vectors ? known.vectorMath : known.math;
            if (known.kind == "division" && neverZero(operands[1].parts[part])) op = "divide";
            Node& made =
                op.empty() ? addCode(node, std::string(vectors && !known.vectorCode.empty() ? known.vectorCode
                                                                                            : known.code))
                           : add(node, vectors ? "vector_math" : "math");
            if (!op.empty()) made.set("op", {.value = std::string(op)});
            for (std::size_t i = 0; i < operands.size(); ++i)
                made.set(std::string(1, char('a' + int(i))), operands[i].parts[part]);
            result.parts.push_back(linkTo(made.id));
        }
        setResult(node, std::move(result));
    }

    static bool neverZero(const InputValue& divisor) {
        if (const auto* number = std::get_if<double>(&divisor.value)) return *number != 0.0;
        const auto* numbers = std::get_if<std::vector<double>>(&divisor.value);
        return numbers && std::ranges::find(*numbers, 0.0) == numbers->end();
    }

    void constant(const FunctionNode& node) {
        const bool vector = node.kind == "constvec";
        InputValue number{.value = node.numbers[0]};
        if (vector) number.value = std::vector<double>(node.numbers.begin(), node.numbers.begin() + 3);
        if (uses[node.id] > 1) {
            Node& made = add(node, vector ? "vector" : "value");
            made.set("value", number);
            number = linkTo(made.id);
        }
        setResult(node, single(vector ? ValueType::vector : ValueType::scalar, std::move(number)));
    }

    void constantMatrix(const FunctionNode& node) {
        Value matrix{ValueType::matrix};
        for (const double number : node.numbers) matrix.parts.push_back({.value = number});
        setResult(node, std::move(matrix));
    }

    void constantResource(const FunctionNode& node) {
        setResult(node, {.type = ValueType::resource, .resource = node.resource});
    }

    void composeVector(const FunctionNode& node) {
        const Value* xyz[3] = {};
        for (std::size_t i = 0; i < 3; ++i)
            if (xyz[i] = given(node, std::string(1, char('x' + int(i))), ValueType::scalar); !xyz[i]) return;
        setResult(node, combined(node, xyz[0]->parts[0], xyz[1]->parts[0], xyz[2]->parts[0]));
    }

    void vectorFromScalar(const FunctionNode& node) {
        const Value* a = given(node, "A", ValueType::scalar);
        if (a) setResult(node, combined(node, a->parts[0], a->parts[0], a->parts[0]));
    }

    Value combined(const FunctionNode& from, const InputValue& x, const InputValue& y, const InputValue& z) {
        Node& made = add(from, "combine_xyz");
        made.set("x", x), made.set("y", y), made.set("z", z);
        return single(ValueType::vector, linkTo(made.id));
    }

    void decomposeVector(const FunctionNode& node) {
        const Value* a = given(node, "A", ValueType::vector);
        if (!a) return;
        Node& made = add(node, "separate_xyz");
        made.set("vector", a->parts[0]);
        for (const char* component : {"x", "y", "z"})
            set(node, component, single(ValueType::scalar, linkTo(made.id, component)));
    }

    void composeMatrix(const FunctionNode& node) {
        Value matrix{ValueType::matrix};
        for (int i = 0; i < 16; ++i) {
            const Value* value =
                given(node, "m" + std::to_string(i / 4) + std::to_string(i % 4), ValueType::scalar);
            if (!value) return;
            matrix.parts.push_back(value->parts[0]);
        }
        setResult(node, std::move(matrix));
    }

    void matrixFromVectors(const FunctionNode& node) {
        const bool rows = node.kind == "matrixfromrows";
        Value matrix{ValueType::matrix, std::vector<InputValue>(16)};
        for (std::size_t k = 0; k < 4; ++k) {
            const Value* vector = given(node, std::string(1, char('A' + int(k))), ValueType::vector);
            if (!vector) return;
            const std::array<InputValue, 3> parts = components(node, vector->parts[0]);
            for (std::size_t i = 0; i < 3; ++i) matrix.parts[rows ? 4 * k + i : 4 * i + k] = parts[i];
            matrix.parts[rows ? 4 * k + 3 : 12 + k] = {.value = k == 3 ? 1.0 : 0.0};
        }
        setResult(node, std::move(matrix));
    }

    /// The three numbers of a vector.
    std::array<InputValue, 3> components(const FunctionNode& from, const InputValue& vector) {
        if (const auto* numbers = std::get_if<std::vector<double>>(&vector.value))
            return {InputValue{.value = (*numbers)[0]}, {.value = (*numbers)[1]}, {.value = (*numbers)[2]}};
        Node& made = add(from, "separate_xyz");
        made.set("vector", vector);
        return {linkTo(made.id, "x"), linkTo(made.id, "y"), linkTo(made.id, "z")};
    }

    void measure(const FunctionNode& node) {
        const Value* a = given(node, "A", ValueType::vector);
        const Value* b = node.kind == "dot" ? given(node, "B", ValueType::vector) : nullptr;
        if (!a || (node.kind == "dot" && !b)) return;
        const InputValue first = a->parts[0];
        Node& made = add(node, "vector_math");
        made.set("op", {.value = node.kind});
        made.set("a", first);
        if (b) made.set("b", b->parts[0]);
        setResult(node, single(ValueType::scalar, linkTo(made.id, "value")));
    }

    void cross(const FunctionNode& node) {
        const Value* a = given(node, "A", ValueType::vector);
        const Value* b = given(node, "B", ValueType::vector);
        if (!a || !b) return;
        Node& made = add(node, "vector_math");
        made.set("op", {.value = std::string("cross")});
        made.set("a", a->parts[0]), made.set("b", b->parts[0]);
        setResult(node, single(ValueType::vector, linkTo(made.id)));
    }

    /// A row of positions times a matrix: v.x * m00 + v.y * m10 + v.z * m20 + m30, and so on.
    void multiply(const FunctionNode& node) {
        const Value* matrix = given(node, "A", ValueType::matrix);
        const Value* vector = given(node, "B", ValueType::vector);
        if (!matrix || !vector) return;
        const Value m = *matrix, v = *vector;
        std::array<std::string, 12> entries;
        std::vector<std::pair<std::string, InputValue>> linked;
        for (std::size_t i = 0; i < 12; ++i) {
            const InputValue& entry = m.parts[i / 3 * 4 + i % 3];
            const double* number = std::get_if<double>(&entry.value);
            entries[i] = number ? exactNumber(*number) : "m" + std::to_string(i / 3) + std::to_string(i % 3);
            if (!number) linked.emplace_back(entries[i], entry);
        }
        Node& placed = addCode(node, productCode(entries, "v"));
        placed.set("v", v.parts[0]);
        for (auto& [name, value] : linked) placed.set(name, value);
        setResult(node, single(ValueType::vector, linkTo(placed.id)));
    }

    void transpose(const FunctionNode& node) {
        const Value* matrix = given(node, "A", ValueType::matrix);
        if (!matrix) return;
        Value turned = *matrix;
        for (std::size_t i = 0; i < 16; ++i) turned.parts[i] = matrix->parts[i % 4 * 4 + i / 4];
        setResult(node, std::move(turned));
    }

    /// By cofactors: each entry of the inverse is a determinant of three rows and columns over that of all.
    void inverse(const FunctionNode& node) {
        const Value* matrix = given(node, "A", ValueType::matrix);
        if (!matrix) return;
        const std::vector<InputValue> parts = matrix->parts;
        const auto entry = [](int row, int column) {
            return "m" + std::to_string(row) + std::to_string(column);
        };
        const auto minor = [&](int row, int column) {
            std::string rows[3];
            for (int i = 0, r = 0; r < 4; ++r) {
                if (r == row) continue;
                std::string& text = rows[i++];
                for (int c = 0; c < 4; ++c)
                    if (c != column) text += (text.empty() ? "vec3(" : ", ") + entry(r, c);
                text += ")";
            }
            return std::string((row + column) % 2 ? "-" : "") + "dot(" + rows[0] + ", cross(" + rows[1] +
                   ", " + rows[2] + "))";
        };
        std::string whole;
        for (int c = 0; c < 4; ++c) whole += (c ? " + " : "") + entry(0, c) + " * (" + minor(0, c) + ")";
        Value result{ValueType::matrix};
        for (int i = 0; i < 16; ++i) {
            Node& made = addCode(
                node, "d = " + whole + ";\nreturn d == 0.0 ? 0.0 : (" + minor(i % 4, i / 4) + ") / d;");
            for (int k = 0; k < 16; ++k) made.set(entry(k / 4, k % 4), parts[std::size_t(k)]);
            result.parts.push_back(linkTo(made.id));
        }
        setResult(node, std::move(result));
    }

    void mesh(const FunctionNode& node) {
        const Value* place = given(node, "pos", ValueType::vector);
        const Value* of = given(node, "mesh", ValueType::resource);
        if (!place || !of) return;
        const Object* object = entry(all.model.objects, of->resource);
        if (!object || !object->hasMesh())
            return fail(
                node, "wants the mesh of the object " + std::to_string(of->resource) + ", and there is none");
        const Result<std::string> file = all.files.mesh(*object);
        if (!file) return fail(node, file.error().message);
        const InputValue at = place->parts[0];
        Node& read = addNode(group.nodes, ids, "mesh_file", object->name.empty() ? "mesh" : object->name);
        read.set("path", {.value = *file});
        const std::string from = read.id;
        Node& field = add(node, "mesh_to_field");
        field.set("p", at);
        field.set("mesh", linkTo(from));
        field.set("resolution", {.value = double(kMeshResolution)});
        if (node.kind == "unsignedmesh") field.set("inside", {.value = std::string("none")});
        const std::string made = field.id;
        Node& distance = addNode(group.nodes, ids, "distance", "distance");
        distance.set("surface", linkTo(made));
        setResult(node, single(ValueType::scalar, linkTo(distance.id)));
    }

    void call(const FunctionNode& node) {
        const Value* which = given(node, "functionID", ValueType::resource);
        if (!which) return;
        const Function* called = entry(all.model.functions, which->resource);
        const ImageFunction* pictures = entry(all.model.imageFunctions, which->resource);
        if (!called && !pictures)
            return fail(node,
                        "calls the function " + std::to_string(which->resource) + ", and there is none");
        static const std::vector<Socket> kPlace = {{"pos", ValueType::vector}};
        FunctionGroups::Resources passed;
        std::vector<std::pair<std::string, Value>> inputs;
        for (const Socket& socket : called ? called->inputs : kPlace) {
            const Value* value = given(node, socket.name, socket.type);
            if (!value) return;
            if (socket.type == ValueType::resource)
                passed[socket.name] = value->resource;
            else
                inputs.emplace_back(socket.name, *value);
        }
        const Result<const Group*> of = all.group(which->resource, passed, depth + 1);
        if (!of) {
            if (!problem) problem = of.error();
            return;
        }
        Node& made = add(node, "group");
        made.group = (*of)->id;
        for (const auto& [name, value] : inputs)
            for (int i = 0; i < int(value.parts.size()); ++i)
                made.set(value.type == ValueType::matrix ? entryName(name, i) : socketName(name),
                         value.parts[std::size_t(i)]);
        const std::string id = made.id;
        for (const Socket& socket : node.outputs) {
            Value result{socket.type};
            const int parts = socket.type == ValueType::matrix ? 16 : 1;
            for (int i = 0; i < parts; ++i) {
                const std::string name = parts > 1 ? entryName(socket.name, i) : socketName(socket.name);
                const auto output = std::ranges::find(
                    (*of)->outputs, name, [](const GroupOutput& o) -> const std::string& { return o.name; });
                if (output == (*of)->outputs.end() || output->type != typeInFiles(socket.type)) break;
                result.parts.push_back(linkTo(id, name));
            }
            // What the function does not give is missed by whoever refers to it.
            if (int(result.parts.size()) == parts) set(node, socket.name, std::move(result));
        }
    }

    FunctionGroups& all;
    const Function& function;
    const FunctionGroups::Resources& resources;
    int depth;
    Group group;
    std::set<std::string, std::less<>> ids;
    std::map<std::string, Value> values;  // by "node.output"
    std::map<std::string, int> uses;
    std::optional<Error> problem;
};

}  // namespace

Result<Group> groupOf(FunctionGroups& functions, const Function& function,
                      const FunctionGroups::Resources& resources, int depth) {
    return GroupMaker(functions, function, resources, depth).run();
}

}  // namespace fw::threemf
