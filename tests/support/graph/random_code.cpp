#include "tests/support/graph/random_code.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "graph/language/builtins.h"

namespace fw::test {

namespace {

using language::Builtin;

/// Types that an expression can be made of; points only as an input.
constexpr Type kMade[] = {Type::boolean, Type::integer, Type::scalar, Type::vec2,
                          Type::vec3,    Type::surface, Type::string, Type::points};
constexpr Type kDeclared[] = {Type::scalar, Type::scalar,  Type::vec3,
                              Type::vec2,   Type::integer, Type::boolean};
constexpr Type kResults[] = {Type::scalar, Type::scalar, Type::surface,
                             Type::vec3,   Type::vec2,   Type::integer};

const std::vector<CodeInput>& randomCodeInputs() {
    static const std::vector<CodeInput> inputs = {{"n", Type::scalar},
                                                  {"v", Type::vec3},
                                                  {"w", Type::vec2},
                                                  {"on", Type::boolean},
                                                  {"kind", Type::string, "round"},
                                                  {"list", Type::points},
                                                  {"s", Type::surface, {}, true},
                                                  {"f", Type::scalar, {}, true},
                                                  {"q", Type::vec3, {}, true}};
    return inputs;
}

/// A built-in with one choice of types that it takes.
struct Signatures {
    const Builtin* builtin;
    std::vector<std::vector<Type>> types;
};

/// By the type of the result: what each built-in can be called with, all of it up to three arguments, some
/// of it above.
const std::map<Type, std::vector<Signatures>>& signatures() {
    static const auto all = [] {
        std::map<Type, std::vector<Signatures>> table;
        std::mt19937 random(1);
        constexpr std::size_t kinds = std::size(kMade), most = kinds * kinds * kinds;
        for (const std::string& name : language::builtinNames()) {
            const Builtin* builtin = language::findBuiltin(name);
            std::map<Type, Signatures> own;
            for (int count = builtin->least; count <= builtin->most; ++count) {
                const auto every = std::size_t(std::pow(kinds, count));
                for (std::size_t i = 0; i < std::min(every, most); ++i) {
                    std::vector<Type> types;
                    std::size_t rest = i;
                    for (int k = 0; k < count; ++k, rest /= kinds)
                        types.push_back(kMade[every <= most ? rest % kinds : random() % kinds]);
                    const language::TypeResult result = builtin->type(types);
                    if (!std::holds_alternative<Type>(result)) continue;
                    Signatures& entry = own[std::get<Type>(result)];
                    entry.builtin = builtin;
                    entry.types.push_back(types);
                }
            }
            for (auto& [type, entry] : own) table[type].push_back(std::move(entry));
        }
        return table;
    }();
    return all;
}

struct Variable {
    std::string name;
    Type type;
    bool constant = false;
};

struct OwnFunction {
    std::string name;
    std::vector<Type> parameters;
    Type result;
};

class Writer {
  public:
    Writer(std::mt19937& random_, bool texts_) : random(random_), texts(texts_) {}

    CodeText program() {
        const int functionCount = below(4) == 0 ? 1 + below(2) : 0;
        for (int i = 0; i < functionCount; ++i) function();
        enterScope();
        result = pick(kResults);
        for (int count = below(6); count > 0; --count) statement(2);
        if (chance(0.2)) {
            text += "r = " + expression(result, 3) + ";\n";
        } else {
            text += "return " + expression(result, 3) + ";\n";
        }
        return {std::move(text), inputs()};
    }

  private:
    std::mt19937& random;
    bool texts;  ///< whether texts and points are among the inputs
    std::string text;
    std::vector<Variable> variables;
    std::vector<OwnFunction> functions;
    Type result = Type::scalar;
    int loops = 0, names = 0, nodeCalls = 0, left = 70;

    int below(int count) { return int(random() % uint32_t(count)); }
    bool chance(double share) { return random() < share * 4294967296.0; }
    template <class List>
    std::ranges::range_value_t<List> pick(const List& list) {
        return list[std::size_t(below(int(std::size(list))))];
    }
    std::string newName() { return "a" + std::to_string(names++); }

    std::vector<CodeInput> inputs() const {
        std::vector<CodeInput> all = randomCodeInputs();
        if (!texts)
            std::erase_if(all, [](const CodeInput& input) { return componentCount(input.type) == 0; });
        return all;
    }

    void enterScope() {
        variables.clear();
        for (const CodeInput& input : inputs()) variables.push_back({input.name, input.type, true});
        variables.push_back({"p", Type::vec3});
        variables.push_back({"pos", Type::vec3});
        variables.push_back({"time", Type::scalar, true});
    }

    // ---- expressions

    std::string number() {
        static const char* const usual[] = {"0", "1", "2", "3", "0.5", "0.25", "1.5", ".125", "2.f", "1e-3"};
        static const char* const rare[] = {"1e30",   "1e39",  "1e-40", "3.4028236e38",
                                           "100000", "1e300", "TAU",   "pi"};
        return chance(0.04) ? pick(rare) : pick(usual);
    }

    std::string variable(Type type) {
        std::vector<std::string> fitting;
        for (const Variable& v : variables)
            if (v.type == type) fitting.push_back(v.name);
        return fitting.empty() ? std::string() : pick(fitting);
    }

    std::string leaf(Type type) {
        if (std::string name = variable(type); !name.empty() && chance(0.7)) return name;
        switch (type) {
            case Type::boolean: return chance(0.3) ? pick(std::array{"true", "false"}) : "p.x < " + number();
            case Type::integer: return std::to_string(below(5));
            case Type::scalar: return chance(0.5) ? number() : std::string("p.") + "xyz"[below(3)];
            case Type::vec2: return chance(0.5) ? "p.xz" : "vec2(" + number() + ")";
            case Type::vec3: return chance(0.5) ? "p" : "vec3(" + number() + ", " + number() + ", p.y)";
            case Type::surface: return chance(0.5) ? "s" : "with_distance(s, p.y)";
            case Type::string: return pick(std::array{"\"round\"", "\"\""});
            default: return "list";
        }
    }

    std::string expression(Type type, int depth) {
        if (chance(0.0015)) type = pick(kMade);  // a mistake
        if (depth <= 0 || --left < 0) return leaf(type);
        const int choice = below(10);
        if (choice < 4)
            if (std::string call = builtinCall(type, depth); !call.empty()) return call;
        if (choice == 4)
            if (std::string call = nodeCall(type, depth); !call.empty()) return call;
        if (choice == 5)
            if (std::string call = functionCall(type, depth); !call.empty()) return call;
        if (choice == 6 && type != Type::points && type != Type::string)
            return "(" + expression(Type::boolean, depth - 1) + " ? " + expression(type, depth - 1) + " : " +
                   expression(type, depth - 1) + ")";
        switch (type) {
            case Type::boolean: return logic(depth);
            case Type::surface: return leaf(type);
            case Type::string:
            case Type::points: return leaf(type);
            default: return chance(0.75) ? arithmetic(type, depth) : part(type, depth);
        }
    }

    std::string logic(int depth) {
        if (chance(0.1))
            return std::string(texts ? "(kind " : "(\"flat\" ") + std::string(pick(std::array{"==", "!="})) +
                   " \"round\")";
        if (chance(0.3))
            return "(" + expression(Type::boolean, depth - 1) + pick(std::array{" && ", " || "}) +
                   expression(Type::boolean, depth - 1) + ")";
        if (chance(0.15)) return "!(" + expression(Type::boolean, depth - 1) + ")";
        const char* comparison = pick(std::array{" < ", " <= ", " > ", " >= ", " == ", " != "});
        return "(" + expression(Type::scalar, depth - 1) + comparison + expression(Type::scalar, depth - 1) +
               ")";
    }

    std::string arithmetic(Type type, int depth) {
        const char operation = "+-*/%+-*"[below(8)];
        if (type == Type::integer && operation == '/')
            return "int(" + expression(Type::scalar, depth - 1) + ")";
        if (chance(0.1)) return "(-" + expression(type, depth - 1) + ")";
        std::string a = expression(type, depth - 1);
        Type other = type == Type::integer || chance(0.6) ? type : Type::scalar;
        std::string b = expression(other, depth - 1);
        if ((operation == '/' || operation == '%') && chance(0.9))
            b = other == Type::integer ? "2" : "(0.5 + abs(" + b + "))";
        if (chance(0.3) && operation != '/' && operation != '%') std::swap(a, b);
        return "(" + a + " " + operation + " " + b + ")";
    }

    std::string swizzle(Type from, int count) {
        const std::string_view letters = chance(0.8) ? "xyz" : "rgb";
        std::string out = ".";
        for (int i = 0; i < count; ++i) out += letters[std::size_t(below(componentCount(from)))];
        return out;
    }

    /// Components of a vector or a surface, an element, or a field elsewhere.
    std::string part(Type type, int depth) {
        const std::string place = "(" + expression(Type::vec3, depth - 1) + ")";
        switch (below(4)) {
            case 0:
                if (type == Type::scalar) return "f" + place;
                if (type == Type::vec3) return "q" + place;
                break;
            case 1:
                if (type == Type::scalar)
                    return pick(std::array{"s.distance", "s.roughness", "s.metallic", "s.base_color.g"});
                if (type == Type::vec3) return pick(std::array{"s.base_color", "s.emission"});
                if (type == Type::vec2 && texts) return "list[" + std::to_string(below(3)) + "]";
                break;
            case 2:
                if (type == Type::scalar) return place + "[" + std::to_string(below(3)) + "]";
                break;
        }
        if (type == Type::integer) return "int" + place;
        const int count = type == Type::scalar ? 1 : componentCount(type);
        return place + swizzle(Type::vec3, count);
    }

    std::string listed(const std::string& name, const std::vector<Type>& types, int depth) {
        std::string call = name + "(";
        for (std::size_t i = 0; i < types.size(); ++i)
            call += (i ? ", " : "") + expression(types[i], depth - 1);
        return call + ")";
    }

    std::string builtinCall(Type type, int depth) {
        const auto found = signatures().find(type);
        if (found == signatures().end()) return {};
        const Signatures& chosen = found->second[std::size_t(below(int(found->second.size())))];
        const std::vector<Type>& types = chosen.types[std::size_t(below(int(chosen.types.size())))];
        if (!texts && std::ranges::find(types, Type::points) != types.end()) return {};
        const bool image = !types.empty() && types[0] == Type::string;
        if (!image) return listed(std::string(chosen.builtin->name), types, depth);
        std::string call = std::string(chosen.builtin->name) + "(\"\"";
        for (std::size_t i = 1; i < types.size(); ++i) call += ", " + expression(types[i], depth - 1);
        return call + ")";
    }

    std::string functionCall(Type type, int depth) {
        std::vector<const OwnFunction*> fitting;
        for (const OwnFunction& own : functions)
            if (own.result == type) fitting.push_back(&own);
        if (fitting.empty())
            return type == Type::surface ? "s(" + expression(Type::vec3, depth - 1) + ")" : "";
        const OwnFunction& own = *pick(fitting);
        return listed(own.name, own.parameters, depth);
    }

    std::string argument(const InputSpec& input, int depth) {
        if (!input.options.empty()) return '"' + pick(input.options) + '"';
        switch (input.type) {
            case Type::image:
            case Type::string: return "\"\"";
            case Type::boolean: return chance(0.8) ? pick(std::array{"true", "false"}) : leaf(Type::boolean);
            case Type::integer: return std::to_string(int(std::clamp(1.0 + below(3), input.min, input.max)));
            case Type::scalar: {
                if (chance(0.3)) return expression(Type::scalar, depth - 1);
                const double value = std::clamp(0.25 * (1 + below(8)), input.min, input.max);
                return std::to_string(value);
            }
            default: return expression(input.type, depth - 1);
        }
    }

    std::string nodeCall(Type type, int depth) {
        if (nodeCalls >= 3) return {};
        static const auto types = [] {
            std::map<Type, std::vector<const NodeType*>> byResult;
            for (const NodeType& node : nodeTypes())
                if (!node.body.empty() && !node.outputs.empty() && !language::findBuiltin(node.id))
                    byResult[node.outputs[0].type].push_back(&node);
            return byResult;
        }();
        const auto found = types.find(type == Type::scalar && chance(0.5) ? Type::surface : type);
        if (found == types.end()) return {};
        ++nodeCalls;
        const NodeType& node = *pick(found->second);
        std::string call = node.id + "(";
        const int count = below(int(node.inputs.size()) + 1);
        for (int i = 0; i < count; ++i) {
            const InputSpec& input = node.inputs[std::size_t(i)];
            if (std::ranges::find(kMade, input.type) == std::end(kMade) && input.type != Type::image) break;
            if (input.type == Type::points && !texts) break;
            call += (i ? ", " : "") + argument(input, depth);
        }
        call += ")";
        return type == Type::scalar && found->first == Type::surface ? "distance(" + call + ")" : call;
    }

    // ---- statements

    void function() {
        OwnFunction own{"own" + std::to_string(functions.size()), {}, pick(kDeclared)};
        enterScope();
        std::erase_if(variables, [](const Variable& v) { return v.name == "pos"; });
        text += std::string(typeName(own.result)) + " " + own.name + "(";
        for (int i = 0; i < 1 + below(3); ++i) {
            own.parameters.push_back(pick(kDeclared));
            const std::string name = newName();
            text += (i ? ", " : "") + std::string(typeName(own.parameters.back())) + " " + name;
            variables.push_back({name, own.parameters.back()});
        }
        text += ") {\n";
        result = own.result;
        for (int count = below(3); count > 0; --count) statement(1);
        text += "return " + expression(own.result, 2) + ";\n}\n";
        functions.push_back(std::move(own));
    }

    const Variable* assignable(bool parts) {
        std::vector<const Variable*> fitting;
        for (const Variable& v : variables)
            if (!v.constant && (!parts || language::isVector(v.type) || v.type == Type::surface))
                fitting.push_back(&v);
        return fitting.empty() ? nullptr : pick(fitting);
    }

    void statement(int depth) {
        switch (below(depth > 0 ? 12 : 7)) {
            case 0:
            case 1: return declaration();
            case 2: {
                const Type type = chance(0.3) ? Type::surface : pick(kDeclared);
                const std::string name = newName();
                text += name + " = " + expression(type, 3) + ";\n";
                variables.push_back({name, type == Type::integer ? Type::scalar : type});
                return;
            }
            case 3:
            case 4: return assignment();
            case 5: return partialStore();
            case 6: return leaving();
            case 7:
            case 8:
            case 9: return branch(depth);
            case 10: return loop(depth);
            default: return block(depth);
        }
    }

    void declaration() {
        const Type type = pick(kDeclared);
        const bool constant = chance(0.1);
        const std::string name = newName();
        text += (constant ? "const " : "") + std::string(typeName(type)) + " " + name;
        if (constant || chance(0.9)) text += " = " + expression(type, 3);
        variables.push_back({name, type, constant});
        if (!constant && chance(0.2)) {
            const std::string second = newName();
            text += ", " + second + " = " + expression(type, 2);
            variables.push_back({second, type});
        }
        text += ";\n";
    }

    void assignment() {
        const Variable* v = assignable(false);
        if (!v) return;
        const Variable target = *v;
        const bool numeric = target.type != Type::boolean && target.type != Type::surface;
        if (numeric && !language::isVector(target.type) && chance(0.2)) {
            text += target.name + pick(std::array{"++", "--"}) + ";\n";
            return;
        }
        const char* operation = numeric ? pick(std::array{" = ", " += ", " -= ", " *= "}) : " = ";
        text += target.name + operation + expression(target.type, 3) + ";\n";
    }

    void partialStore() {
        const Variable* v = assignable(true);
        if (!v) return;
        const Variable target = *v;
        if (target.type == Type::surface) {
            text += target.name +
                    (chance(0.5) ? ".distance = " + expression(Type::scalar, 2)
                                 : ".base_color = " + expression(Type::vec3, 2)) +
                    ";\n";
            return;
        }
        std::string letters = componentCount(target.type) == 3 ? "xyz" : "xy";
        std::shuffle(letters.begin(), letters.end(), random);
        letters.resize(std::size_t(1 + below(int(letters.size()))));
        const Type part = letters.size() == 3 ? Type::vec3 : letters.size() == 2 ? Type::vec2 : Type::scalar;
        text += target.name + "." + letters + pick(std::array{" = ", " += ", " *= "}) + expression(part, 2) +
                ";\n";
    }

    void leaving() {
        if (loops > 0 && chance(0.7)) {
            text +=
                "if (" + expression(Type::boolean, 2) + ") " + pick(std::array{"break", "continue"}) + ";\n";
        } else if (chance(0.3)) {
            text += "if (" + expression(Type::boolean, 2) + ") return " + expression(result, 2) + ";\n";
        } else {
            assignment();
        }
    }

    void block(int depth) {
        const std::size_t kept = variables.size();
        text += "{\n";
        for (int count = 1 + below(2); count > 0; --count) statement(depth - 1);
        text += "}\n";
        variables.resize(kept);
    }

    void branch(int depth) {
        text += "if (" + expression(Type::boolean, 2) + ") ";
        block(depth);
        if (!chance(0.5)) return;
        text += "else ";
        block(depth);
    }

    void loop(int depth) {
        const std::string name = "i" + std::to_string(names++);
        text += "for (int " + name + " = 0; " + name + " < " + std::to_string(1 + below(4)) + "; " + name +
                pick(std::array{"++", " += 1", " = "});
        if (text.ends_with(" = ")) text += name + " + 1";
        text += ") ";
        const std::size_t kept = variables.size();
        variables.push_back({name, Type::integer, true});
        ++loops;
        block(depth);
        --loops;
        variables.resize(kept);
    }
};

}  // namespace

CodeText randomCode(std::mt19937& random, bool texts) { return Writer(random, texts).program(); }

}  // namespace fw::test
