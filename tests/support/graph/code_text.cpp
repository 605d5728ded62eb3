#include "tests/support/graph/code_text.h"

#include <algorithm>
#include <filesystem>

#include "graph/compile/compile.h"
#include "graph/document/json.h"
#include "graph/language/lexer.h"
#include "graph/language/lower.h"

namespace fw::test {

namespace {

const char* const kBallCode =
    "return with_material(length(p) - 1, vec3(0.9, 0.5, abs(p.x)), 0.3, 0, vec3(0.1));";
const char* const kNumberCode = "return 0.5 * p.x + p.y * p.z;";
const char* const kPositionCode = "return p;";
const char* const kPlaceCode = "return p.zxy + vec3(0.25, 0, -0.5);";

/// A token as it stands in a text.
struct Word {
    language::Token::Kind kind;
    std::string text;
};

std::vector<Word> wordsOf(const std::string& text) {
    std::vector<Word> words;
    const Result<std::vector<language::Token>> tokens = language::tokenize(text);
    if (!tokens) return words;
    for (const language::Token& token : *tokens) {
        if (token.kind == language::Token::Kind::end) break;
        const bool quoted = token.kind == language::Token::Kind::string;
        words.push_back({token.kind, quoted ? '"' + std::string(token.text) + '"' : std::string(token.text)});
    }
    return words;
}

/// What may stand for the word most often: another variable for a variable, a called name for a called one,
/// a number for a number, an operator for one that takes the same.
char useOf(const std::vector<Word>& words, std::size_t at) {
    using Kind = language::Token::Kind;
    const Word& word = words[at];
    if (word.kind == Kind::integer || word.kind == Kind::number) return '0';
    if (word.kind == Kind::name) {
        if (word.text == "if" || word.text == "for" || word.text == "else" || word.text == "return") return 0;
        if (at > 0 && words[at - 1].text == ".") return '.';
        if (typeNamed(word.text)) return 't';
        return at + 1 < words.size() && words[at + 1].text == "(" ? 'f' : 'v';
    }
    constexpr std::string_view operators[] = {" + - * / % ", " < <= > >= == != ", " && || ", " = += -= *= "};
    for (std::size_t i = 0; i < std::size(operators); ++i)
        if (operators[i].find(' ' + word.text + ' ') != operators[i].npos) return char('1' + i);
    return 0;
}

/// The first word from `at` on that has a use, by the next one from `other` on that has the same.
void replaceByLike(std::vector<Word>& words, std::size_t at, std::size_t other) {
    for (std::size_t k = 0; k < words.size() && useOf(words, at) == 0; ++k) at = (at + 1) % words.size();
    for (std::size_t k = 0; k < words.size(); ++k) {
        const std::size_t next = (other + k) % words.size();
        if (useOf(words, next) != useOf(words, at) || words[next].text == words[at].text) continue;
        words[at] = words[next];
        return;
    }
}

void collect(const Graph& graph, const std::string& group, const std::vector<Node>& nodes,
             std::vector<CodeText>& codes) {
    for (const Node& node : nodes) {
        if (node.code.empty()) continue;
        CodeText code{node.code, {}};
        for (const auto& [name, input] : node.inputs) {
            CodeInput made{name, Type::scalar};
            if (const Link* link = std::get_if<Link>(&input.value)) {
                made.type = compiledType(graph, group, *link).value_or(Type::scalar);
                made.linked = true;
            } else if (std::holds_alternative<bool>(input.value)) {
                made.type = Type::boolean;
            } else if (const auto* text = std::get_if<std::string>(&input.value)) {
                made.type = Type::string, made.text = *text;
            } else if (const auto* numbers = std::get_if<std::vector<double>>(&input.value)) {
                made.type = input.entry > 0        ? *listOf(input.entry)
                            : numbers->size() == 2 ? Type::vec2
                                                   : Type::vec3;
            }
            code.inputs.push_back(std::move(made));
        }
        codes.push_back(std::move(code));
    }
}

bool isFieldOrText(Type type) {
    return type != Type::mesh && type != Type::particles && type != Type::spline && type != Type::knots;
}

}  // namespace

const std::vector<CodeText>& knownCodes() {
    static const auto all = [] {
        std::vector<CodeText> codes;
        std::vector<std::string> paths;
        for (const auto& entry :
             std::filesystem::directory_iterator(std::string(FIELDWRIGHT_SOURCE_DIR) + "/samples"))
            if (entry.path().string().ends_with(".field.json")) paths.push_back(entry.path());
        std::ranges::sort(paths);
        for (const std::string& path : paths) {
            const Result<Graph> graph = readGraph(path, nullptr);
            if (!graph) continue;
            collect(*graph, "", graph->nodes, codes);
            for (const Group& group : graph->groups) collect(*graph, group.id, group.nodes, codes);
        }
        for (const NodeType& type : nodeTypes()) {
            CodeText code{type.body, {}};
            for (const InputSpec& input : type.inputs) {
                const bool text = input.type == Type::image || input.type == Type::string;
                code.inputs.push_back({.name = input.name,
                                       .type = text                          ? Type::string
                                               : input.type == Type::integer ? Type::scalar
                                                                             : input.type,
                                       .text = input.value.text,
                                       .linked = input.type == Type::surface,
                                       .number = input.type == Type::integer ? 3.0 : 0.75});
            }
            const bool sound = std::ranges::all_of(code.inputs, isFieldOrText, &CodeInput::type) &&
                               std::ranges::all_of(type.outputs, isFieldOrText, &OutputSpec::type);
            if (!type.body.empty() && sound) codes.push_back(std::move(code));
        }
        return codes;
    }();
    return all;
}

CodeText mutated(const CodeText& code, std::mt19937& random) {
    static const char* const words[] = {
        "p",    "vec3",   "float", "int",  "if",     "for",       "return",  "0",
        "1e39", "-",      "*",     "(",    ")",      ";",         "min",     "sqrt",
        ".",    "x",      "{",     "}",    "mod",    "normalize", "break",   "continue",
        "true", "length", "empty", "hash", "worley", "bool",      "surface", "distance"};
    std::vector<Word> all = wordsOf(code.text);
    const auto any = [&](std::size_t count) { return std::size_t(random() % count); };
    for (std::size_t changes = 1 + any(3); changes > 0 && !all.empty(); --changes) {
        const std::size_t at = any(all.size()), other = any(all.size());
        switch (any(16)) {
            case 0: std::swap(all[at], all[other]); break;
            case 1: all.erase(all.begin() + std::ptrdiff_t(at)); break;
            case 2: {
                const Word copy = all[at];
                all.insert(all.begin() + std::ptrdiff_t(at), copy);
                break;
            }
            case 3: all[at].text = words[any(std::size(words))]; break;
            default: replaceByLike(all, at, other);
        }
    }
    CodeText made{{}, code.inputs};
    for (std::size_t i = 0; i < all.size(); ++i) made.text += (i ? " " : "") + all[i].text;
    return made;
}

std::vector<std::pair<std::string, language::Value>> inputValues(language::Lowering& state,
                                                                 const std::vector<CodeInput>& inputs) {
    std::vector<std::pair<std::string, language::Value>> values;
    for (const CodeInput& input : inputs) {
        language::Value value{input.type};
        const auto lowered = [&](const char* code) { return *language::lowerText(state, code); };
        switch (input.type) {
            case Type::surface: value = lowered(kBallCode); break;
            case Type::vec3:
                value = input.name == "p" ? lowered(kPositionCode)
                        : input.linked
                            ? lowered(kPlaceCode)
                            : language::constantValue(state, input.type, std::array{1.0, -2.0, 0.5});
                break;
            case Type::vec2:
                value = language::constantValue(state, input.type, std::array{0.5, -0.25});
                break;
            case Type::string: value.text = input.text; break;
            case Type::points:
                value.points = std::make_shared<const std::vector<double>>(
                    std::vector<double>{0.0, 0.0, 0.5, 1.0, 1.0, 0.25});
                break;
            case Type::stops:
                value.points = std::make_shared<const std::vector<double>>(
                    std::vector<double>{0.0, 0.0, 0.25, 1.0, 0.5, 1.0, 0.25, 0.0});
                break;
            case Type::boolean: value.ids[0] = state.ir.constant(1.0); break;
            default:
                value = input.linked ? lowered(kNumberCode)
                                     : language::constantValue(state, Type::scalar, std::array{input.number});
        }
        values.emplace_back(input.name, std::move(value));
    }
    return values;
}

Graph codeDocument(const CodeText& code, Type result) {
    Graph graph;
    const auto add = [&](const char* id, std::string text) -> Node& {
        Node node;
        node.id = id, node.type = "expression", node.code = std::move(text);
        graph.nodes.push_back(std::move(node));
        return graph.nodes.back();
    };
    add("ball", kBallCode);
    add("number", kNumberCode);
    add("place", kPlaceCode);
    add("position", kPositionCode);
    add("truth", "return true;");
    Node field;
    field.id = "field", field.type = "expression", field.code = code.text;
    for (const CodeInput& input : code.inputs) {
        // An expression's inputs are no texts: a name of the code is.
        if (input.type == Type::string) field.code.insert(0, input.name + " = \"" + input.text + "\"; ");
        if (componentCount(input.type) == 0) continue;
        InputValue value;
        switch (input.type) {
            case Type::surface: value.value = Link{"ball", ""}; break;
            case Type::vec3:
                if (input.linked)
                    value.value = Link{input.name == "p" ? "position" : "place", ""};
                else
                    value.value = std::vector<double>{1.0, -2.0, 0.5};
                break;
            case Type::vec2: value.value = std::vector<double>{0.5, -0.25}; break;
            case Type::boolean: value.value = Link{"truth", ""}; break;
            default:
                if (input.linked)
                    value.value = Link{"number", ""};
                else
                    value.value = input.number;
        }
        field.set(input.name, std::move(value));
    }
    graph.nodes.push_back(std::move(field));
    std::string last = "field";
    if (language::isVector(result) || result == Type::boolean) {
        Node& shown = add(
            "shown", result == Type::boolean ? "return r ? 1 : -1;" : "return dot(r, r * 0.5) + r.x - r.y;");
        shown.set("r", {Link{"field", ""}});
        last = "shown";
    }
    Node output;
    output.id = "out", output.type = "output";
    output.set("surface", {Link{last, ""}});
    graph.nodes.push_back(std::move(output));
    return graph;
}

}  // namespace fw::test
