#include "graph/language/names.h"

#include <algorithm>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "graph/base/words.h"
#include "graph/language/builtins.h"
#include "graph/language/parser.h"

namespace fw::language {

namespace {

constexpr std::string_view kAssigning[] = {"=", "+=", "-=", "*=", "/=", "%=", "++", "--"};
constexpr std::string_view kConstants[] = {"p", "pos", "time", "PI", "pi", "TAU", "tau", "true", "false"};

bool among(std::span<const std::string_view> list, std::string_view text) {
    return std::ranges::find(list, text) != list.end();
}

struct Word {
    Piece::Kind kind;
    std::string_view text;
    Place place;
    std::size_t begin;
    bool name() const { return kind == Piece::Kind::name; }
    bool is(std::string_view symbol) const { return kind == Piece::Kind::symbol && text == symbol; }
};

/// All pieces but spaces and comments, with an end behind them.
std::vector<Word> wordsOf(std::string_view code) {
    std::vector<Word> words;
    words.reserve(code.size() / 3 + 1);
    Place place;
    for (std::size_t at = 0;;) {
        const Piece piece = pieceAt(code, at);
        const bool passed = piece.kind == Piece::Kind::space || piece.kind == Piece::Kind::comment ||
                            piece.kind == Piece::Kind::openComment;
        if (!passed) words.push_back({piece.kind, code.substr(at, piece.length), place, at});
        if (piece.kind == Piece::Kind::end) return words;
        for (const std::size_t stop = at + piece.length; at < stop; ++at) {
            if (code[at] == '\n')
                ++place.line, place.column = 1;
            else if ((code[at] & 0xC0) != 0x80)
                ++place.column;
        }
    }
}

class NameReader {
  public:
    NameReader(std::string_view code_, std::vector<std::string> inputs) : code(code_), words(wordsOf(code_)) {
        made.inputs = std::move(inputs);
        for (std::size_t i = 0; i < made.inputs.size(); ++i) inputIndices.emplace(made.inputs[i], int(i));
    }

    CodeNames run() {
        findFunctions();
        open();
        while (!ended()) {
            const std::size_t before = at;
            if (functionAt.contains(at))
                function();
            else
                statement(0);
            if (at == before) pass();
        }
        close();
        return std::move(made);
    }

  private:
    const Word& peek(std::size_t ahead = 0) const { return words[std::min(at + ahead, words.size() - 1)]; }
    bool ended() const { return peek().kind == Piece::Kind::end; }
    const Word& take() { return words[std::min(at++, words.size() - 1)]; }
    /// Past what nothing else reads.
    void pass() {
        const Word& word = take();
        if (word.name()) use(word, meaningOf(word.text, false));
    }
    bool accept(std::string_view symbol) { return peek().is(symbol) && (++at, true); }

    /// They can be called before they are defined, and see nothing of the code around them.
    void findFunctions() {
        int depth = 0;
        for (std::size_t i = 0; i + 2 < words.size(); ++i) {
            if (words[i].is("{") || words[i].is("(")) ++depth;
            if (words[i].is("}") || words[i].is(")")) depth = std::max(depth - 1, 0);
            if (depth > 0 || !words[i].name() || !declaredType(words[i].text) || !words[i + 1].name() ||
                !words[i + 2].is("("))
                continue;
            const int index = int(made.definitions.size());
            made.definitions.push_back({std::string(words[i + 1].text), {}, true, 0, 0, code.size()});
            functions.try_emplace(words[i + 1].text, index);
            functionAt.emplace(i, index);
        }
    }

    void open() { opened.push_back(added.size()); }
    /// Its variables end where the last word before the one at hand does.
    void close() {
        const std::size_t end = ended() ? code.size() + 1 : peek().begin;
        for (; added.size() > opened.back(); added.pop_back()) {
            std::vector<int>& all = variables[added.back()];
            made.definitions[std::size_t(all.back())].to = end;
            all.pop_back();
        }
        opened.pop_back();
    }

    int variable(std::string_view name) const {
        const auto found = variables.find(name);
        return found == variables.end() || found->second.empty() ? -1 : found->second.back();
    }
    bool isInput(std::string_view name) const { return inputIndices.contains(name); }

    void use(const Word& word, NameUse::Kind kind, int index = -1, bool called = false) {
        made.uses.push_back({kind, called, index, word.place, word.begin, word.text.size()});
    }

    /// A variable whose name is the word; seen from here on. Its use is added, or was, at `where`.
    int define(const Word& word, std::string words_, std::optional<std::size_t> where = {}) {
        const int index = int(made.definitions.size());
        if (!where) {
            where = made.uses.size();
            use(word, NameUse::Kind::variable, index);
        } else {
            made.uses[*where].kind = NameUse::Kind::variable;
            made.uses[*where].index = index;
        }
        const std::size_t from = at > 0 ? words[at - 1].begin + words[at - 1].text.size() : 0;
        made.definitions.push_back(
            {std::string(word.text), std::move(words_), false, *where, from, code.size()});
        variables[word.text].push_back(index);
        added.push_back(word.text);
        return index;
    }

    /// A name inside an expression.
    void named(const Word& word, bool member) {
        const bool called = peek().is("(");
        if (member) return use(word, NameUse::Kind::member);
        if (called)
            if (const auto own = functions.find(word.text); own != functions.end())
                return use(word, NameUse::Kind::function, own->second, true);
        if (const int own = variable(word.text); own >= 0)
            return use(word, NameUse::Kind::variable, own, called);
        if (const auto input = inputIndices.find(word.text); input != inputIndices.end())
            return use(word, NameUse::Kind::input, input->second, called);
        use(word, meaningOf(word.text, called), -1, called);
    }

    /// What was forgotten ends before this: a statement can begin here and no expression goes on.
    bool beginsStatement() const {
        const Word& word = peek();
        if (word.is("{") || word.is("}") || word.is(";")) return true;
        if (!word.name()) return false;
        if (isReserved(word.text)) return true;
        return declaredType(word.text) && peek(1).name();
    }

    /// Names up to what ends an expression: a ",", if it is to, or a ")" that was not opened.
    void expression(bool comma) {
        int depth = 0;
        bool member = false;
        while (!ended() && !beginsStatement()) {
            const Word& word = peek();
            if (depth == 0 && (word.is(")") || (comma && word.is(",")))) return;
            if (word.is("(") || word.is("[")) ++depth;
            if (word.is(")") || word.is("]")) --depth;
            take();
            if (word.name()) named(word, member);
            member = word.is(".");
        }
    }

    void word() { use(take(), NameUse::Kind::word); }

    void declaration() {
        const std::string type(peek().text);
        use(take(), NameUse::Kind::type);
        do {
            if (!peek().name()) break;
            const Word& name = take();
            const std::size_t where = made.uses.size();
            use(name, NameUse::Kind::variable);
            if (accept("=")) expression(true);
            define(name, type + " " + std::string(name.text), where);
        } while (accept(","));
    }

    bool assigns() const {
        std::size_t ahead = 1;
        while (peek(ahead).is(".") && peek(ahead + 1).name()) ahead += 2;
        return peek(ahead).kind == Piece::Kind::symbol && among(kAssigning, peek(ahead).text);
    }

    /// A declaration, an assignment or an expression, without its semicolon.
    void simple() {
        if (peek().name() && peek().text == "const") word();
        if (peek().name() && declaredType(peek().text) && peek(1).name()) return declaration();
        if (!peek().name() || !assigns()) return expression(false);
        const Word& target = peek();
        const bool declares = peek(1).is("=") && variable(target.text) < 0 && !isInput(target.text) &&
                              meaningOf(target.text, false) == NameUse::Kind::unknown;
        if (!declares) return expression(false);
        take();
        const std::size_t where = made.uses.size();
        use(target, NameUse::Kind::variable);
        take();
        expression(false);
        define(target, std::string(target.text), where);
    }

    void inOwnScope(int depth) {
        open();
        statement(depth + 1);
        close();
    }

    void statement(int depth) {
        if (depth >= kMaxDepth || ended()) return pass();
        if (accept(";")) return;
        if (peek().is("{")) {
            take();
            open();
            while (!ended() && !peek().is("}")) {
                const std::size_t before = at;
                statement(depth + 1);
                if (at == before) pass();
            }
            close();
            accept("}");
            return;
        }
        if (peek().name() && peek().text == "if") {
            word();
            if (accept("(")) expression(false);
            accept(")");
            inOwnScope(depth);
            if (!peek().name() || peek().text != "else") return;
            word();
            return inOwnScope(depth);
        }
        if (peek().name() && peek().text == "for") {
            word();
            open();
            if (accept("(")) {
                simple();
                accept(";");
                expression(false);
                accept(";");
                if (!peek().is(")")) simple();
                accept(")");
            }
            inOwnScope(depth);
            return close();
        }
        if (peek().name() && isReserved(peek().text) && peek().text != "const") {
            word();
            expression(false);
        } else {
            simple();
        }
        accept(";");
    }

    void function() {
        const int index = functionAt.at(at);
        std::string declared;
        const std::size_t begin = peek().begin;
        use(take(), NameUse::Kind::type);
        made.definitions[std::size_t(index)].use = made.uses.size();
        use(take(), NameUse::Kind::function, index);
        auto outer = std::exchange(variables, {});
        auto outerAdded = std::exchange(added, {});
        auto outerOpened = std::exchange(opened, {});
        open();
        accept("(");
        while (!ended() && !peek().is(")") && !peek().is("{")) {
            const bool parameter = peek().name() && declaredType(peek().text) && peek(1).name();
            if (parameter) {
                const std::string type(peek().text);
                use(take(), NameUse::Kind::type);
                const Word& name = take();
                define(name, type + " " + std::string(name.text));
            } else {
                pass();
            }
        }
        const std::size_t end = peek().is(")") ? peek().begin + 1 : peek().begin;
        made.definitions[std::size_t(index)].words = code.substr(begin, end - begin);
        accept(")");
        if (peek().is("{")) statement(0);
        close();
        variables = std::move(outer);
        added = std::move(outerAdded);
        opened = std::move(outerOpened);
    }

    std::string_view code;
    std::vector<Word> words;
    std::size_t at = 0;
    CodeNames made;
    std::unordered_map<std::string_view, int> inputIndices, functions;
    std::unordered_map<std::size_t, int> functionAt;  ///< by their first word
    std::unordered_map<std::string_view, std::vector<int>> variables;
    std::vector<std::string_view> added;
    std::vector<std::size_t> opened;
};

}  // namespace

const NameUse* CodeNames::at(std::size_t byte) const {
    const auto after = std::ranges::upper_bound(uses, byte, {}, &NameUse::begin);
    if (after == uses.begin()) return nullptr;
    const NameUse& use = *std::prev(after);
    return byte <= use.begin + use.length ? &use : nullptr;
}

CodeNames namesOf(std::string_view code, std::vector<std::string> inputs) {
    return NameReader(code, std::move(inputs)).run();
}

const NodeType* calledNode(std::string_view name) {
    const NodeType* type = findNodeType(name);
    if (!type) type = findNodeType(lowered(name));
    return type && !type->body.empty() ? type : nullptr;
}

NameUse::Kind meaningOf(std::string_view name, bool called) {
    if (isReserved(name)) return NameUse::Kind::word;
    if (declaredType(name)) return NameUse::Kind::type;
    if (called && findBuiltin(name)) return NameUse::Kind::builtin;
    if (called && calledNode(name)) return NameUse::Kind::node;
    if (among(kConstants, name)) return NameUse::Kind::constant;
    return NameUse::Kind::unknown;
}

std::string nameRefusal(std::string_view code, const CodeNames& names, std::string_view name) {
    if (isReserved(name) || declaredType(name) || name == "true" || name == "false")
        return inQuotes(name) + " is a word of the language: choose another name";
    const auto taken = [&](const CodeDefinition& each) { return each.name == name; };
    const auto meant = [&](const NameUse& use) {
        return use.kind != NameUse::Kind::member && use.kind != NameUse::Kind::unknown &&
               code.substr(use.begin, use.length) == name;
    };
    if (std::ranges::any_of(names.definitions, taken) || std::ranges::any_of(names.uses, meant))
        return "the code has " + inQuotes(name) + " already: choose another name";
    return "";
}

}  // namespace fw::language
