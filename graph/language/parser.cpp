#include "graph/language/parser.h"

#include <algorithm>
#include <optional>
#include <unordered_set>

namespace fw::language {

namespace {

/// Thrown inside this file only, to leave a statement at its first mistake.
struct Failure {
    Error error;
    bool last = false;  ///< what follows would only be misread
};

/// What can be declared, in words.
constexpr char kTypes[] = "(float, int, bool, vec2 or vec3)";

/// Binding strength of a binary operator; 0 if it is none.
int precedence(const Token& token) {
    if (token.kind != Token::Kind::symbol) return 0;
    const bool single = token.text.size() == 1, equal = token.text.back() == '=';
    switch (token.text[0]) {
        case '|': return 1;
        case '&': return 2;
        case '=':
        case '!': return single ? 0 : 3;
        case '<':
        case '>': return 4;
        case '+':
        case '-': return single ? 5 : 0;
        case '*':
        case '/':
        case '%': return equal ? 0 : 6;
        default: return 0;
    }
}
constexpr int kUnaryStrength = 7;

[[noreturn]] void fail(const Token& token, const std::string& message, bool last = false) {
    throw Failure{codeError(token.place, message), last};
}

std::string shown(const Token& token) {
    return token.kind == Token::Kind::end ? "the end of the code" : inQuotes(token.text);
}

/// The tokens, with a place among them.
class Reader {
  public:
    explicit Reader(const std::vector<Token>& tokens_) : tokens(tokens_) {}

    const Token& peek(std::size_t ahead = 0) const { return tokens[std::min(at + ahead, tokens.size() - 1)]; }
    const Token& take() { return tokens[std::min(at++, tokens.size() - 1)]; }
    bool ended() const { return peek().kind == Token::Kind::end; }
    bool accept(std::string_view symbol) { return peek().is(symbol) ? (++at, true) : false; }
    bool acceptName(std::string_view name) { return peek().isName(name) ? (++at, true) : false; }
    void expect(std::string_view symbol, std::string_view after) {
        if (!accept(symbol))
            fail(peek(),
                 "expected '" + std::string(symbol) + "' " + std::string(after) + ", found " + shown(peek()));
    }
    std::string newName(std::string_view what) {
        const Token& token = take();
        if (token.kind != Token::Kind::name)
            fail(token, "expected the name of " + std::string(what) + ", found " + shown(token));
        if (isReserved(token.text) || declaredType(token.text) || token.text == "true" ||
            token.text == "false")
            fail(token, "'" + std::string(token.text) + "' is a word of the language: choose another name");
        return std::string(token.text);
    }
    std::string memberName() {
        const Token& member = take();
        if (member.kind != Token::Kind::name)
            fail(member, "expected a component (as .x or .xyz) after '.', found " + shown(member));
        return std::string(member.text);
    }

  private:
    const std::vector<Token>& tokens;
    std::size_t at = 0;
};

/// Reads one expression into postfix order.
class ExpressionReader {
  public:
    ExpressionReader(Reader& reader_, std::vector<Expr>& made_, int depth_)
        : reader(reader_), made(made_), depth(depth_) {}

    Range read() {
        const int first = static_cast<int>(made.size());
        do { operand(); } while (behindOperand());
        return {first, static_cast<int>(made.size())};
    }

  private:
    /// What is open: an operator that waits for its operand, or a bracket.
    struct Open {
        enum class Kind : unsigned char { unary, binary, parenthesis, call, index, then, otherwise } kind;
        Expr expression;
        int strength = 0;
    };
    using Kind = Open::Kind;

    void emit(Expr expression) { made.push_back(std::move(expression)); }
    void open(Kind kind, Expr expression, int strength = 0) {
        if (static_cast<int>(stack.size()) + depth >= kMaxDepth)
            fail(reader.peek(),
                 "the code is nested deeper than " + std::to_string(kMaxDepth) +
                     " levels: split it over several statements",
                 true);
        stack.push_back({kind, std::move(expression), strength});
    }
    void close() {
        emit(std::move(stack.back().expression));
        stack.pop_back();
    }
    bool topIs(Kind kind) const { return !stack.empty() && stack.back().kind == kind; }
    /// Ends the operators that bind at least so strongly.
    void reduce(int strength) {
        while ((topIs(Kind::unary) || topIs(Kind::binary)) && stack.back().strength >= strength) close();
    }
    /// Ends what is open inside the innermost bracket.
    void reduceAll() {
        for (reduce(0); topIs(Kind::otherwise); reduce(0)) close();
    }

    /// Up to the end of an operand without what follows it: a number, a name, "()" of a call.
    void operand() {
        while (true) {
            const Token& token = reader.peek();
            if (token.kind == Token::Kind::end || (token.kind == Token::Kind::symbol && !token.is("(") &&
                                                   !token.is("-") && !token.is("!") && !token.is("+")))
                fail(token, "expected a value, found " + shown(token));
            reader.take();
            const Expr plain{Expr::Kind::number, token.place, std::string(token.text), token.value,
                             token.kind == Token::Kind::integer};
            switch (token.kind) {
                case Token::Kind::integer:
                case Token::Kind::number: return emit(plain);
                case Token::Kind::string: return emit({Expr::Kind::text, token.place, plain.text});
                case Token::Kind::name:
                    if (isReserved(token.text))
                        fail(token, "expected a value, found the word '" + std::string(token.text) + "'");
                    if (!reader.accept("(")) return emit({Expr::Kind::name, token.place, plain.text});
                    if (reader.accept(")")) return emit({Expr::Kind::call, token.place, plain.text});
                    open(Kind::call, {Expr::Kind::call, token.place, plain.text, 0.0, false, 1});
                    continue;
                case Token::Kind::symbol:
                    if (token.is("("))
                        open(Kind::parenthesis, {Expr::Kind::name, token.place});
                    else if (token.is("-") || token.is("!"))
                        open(Kind::unary, {Expr::Kind::unary, token.place, plain.text}, kUnaryStrength);
                    continue;
                case Token::Kind::end: return;
            }
        }
    }

    /// What follows an operand. True if another operand does.
    bool behindOperand() {
        while (true) {
            const Token& token = reader.peek();
            if (reader.accept(".")) {
                const Place place = reader.peek().place;
                emit({Expr::Kind::member, place, reader.memberName()});
            } else if (reader.accept("[")) {
                open(Kind::index, {Expr::Kind::index, token.place});
                return true;
            } else if (const int strength = precedence(token)) {
                reduce(strength);
                reader.take();
                open(Kind::binary, {Expr::Kind::binary, token.place, std::string(token.text)}, strength);
                return true;
            } else if (reader.accept("?")) {
                reduce(0);
                emit({Expr::Kind::then, token.place});
                open(Kind::then, {Expr::Kind::conditional, token.place});
                return true;
            } else {
                reduceAll();
                if (topIs(Kind::then) && reader.accept(":")) {
                    emit({Expr::Kind::otherwise, token.place});
                    stack.back().kind = Kind::otherwise;
                    return true;
                }
                if (topIs(Kind::call) && reader.accept(",")) {
                    ++stack.back().expression.count;
                    return true;
                }
                if (!closeBracket()) return false;
            }
        }
    }

    /// Ends the innermost bracket; false if nothing is open. Refuses whatever else is here.
    bool closeBracket() {
        if (stack.empty()) return false;
        switch (stack.back().kind) {
            case Kind::call:
                reader.expect(")", "after the arguments of " + inQuotes(stack.back().expression.text));
                close();
                return true;
            case Kind::index:
                reader.expect("]", "after the index");
                close();
                return true;
            case Kind::parenthesis:
                reader.expect(")", "to close the parenthesis");
                stack.pop_back();
                return true;
            default: reader.expect(":", "between the two values of '?'"); return true;
        }
    }

    Reader& reader;
    std::vector<Expr>& made;
    int depth;
    std::vector<Open> stack;
};

class Parser {
  public:
    explicit Parser(const std::vector<Token>& tokens) : reader(tokens) {}

    Tree run() {
        while (!reader.ended() && tree.errors.size() < kMaxCodeErrors) {
            const bool stray = reader.peek().is("}");
            try {
                if (startsFunction())
                    function();
                else
                    tree.body.push_back(statement());
            } catch (const Failure& failure) {
                recover(failure);
                if (stray) reader.accept("}");
            }
        }
        return std::move(tree);
    }

  private:
    /// Goes on behind the statement that failed: after its semicolon, before the end of its block.
    void recover(const Failure& failure) {
        tree.errors.push_back(failure.error);
        while (failure.last && !reader.ended()) reader.take();
        for (int blocks = 0; !reader.ended(); reader.take()) {
            const Token& token = reader.peek();
            if (blocks == 0 && token.is("}")) return;
            if (token.is("{")) ++blocks;
            if (token.is("}") && --blocks == 0) {
                reader.take();
                return;
            }
            if (blocks == 0 && token.is(";")) {
                reader.take();
                return;
            }
        }
    }

    void endStatement() {
        if (!reader.peek().is(";") && assigns(reader.peek()))
            fail(reader.peek(),
                 "only a variable, or components of one (as in v.x), can be assigned to, and not within "
                 "an expression");
        if (!reader.ended() && !reader.peek().is("}")) reader.expect(";", "after the statement");
    }

    /// Guards the recursion of nested statements.
    struct Nested {
        Parser& parser;
        Nested(Parser& parser_) : parser(parser_) {
            if (++parser.depth > kMaxDepth)
                fail(parser.reader.peek(),
                     "the code is nested deeper than " + std::to_string(kMaxDepth) + " levels: split it",
                     true);
        }
        ~Nested() { --parser.depth; }
    };

    Range expression() { return ExpressionReader(reader, tree.expressions, depth).read(); }
    StmtId add(Stmt statement) {
        tree.statements.push_back(std::move(statement));
        return static_cast<StmtId>(tree.statements.size() - 1);
    }
    StmtId nothing() { return add(Stmt{Stmt::Kind::block, reader.peek().place}); }

    bool startsFunction() const {
        return reader.peek().kind == Token::Kind::name && declaredType(reader.peek().text) &&
               reader.peek(1).kind == Token::Kind::name && reader.peek(2).is("(");
    }

    void function() {
        Function made;
        made.place = reader.peek().place;
        made.result = *declaredType(reader.take().text);
        const Token& nameToken = reader.peek();
        made.name = reader.newName("a function");
        if (!functionNames.insert(made.name).second)
            fail(nameToken, "the function " + inQuotes(made.name) + " is defined twice");
        reader.expect("(", "after the function's name");
        if (!reader.peek().is(")")) do {
                const Token& typeToken = reader.take();
                const auto type = declaredType(typeToken.text);
                if (!type)
                    fail(typeToken, "expected a parameter's type " + std::string(kTypes) + ", found " +
                                        shown(typeToken));
                const Token& named = reader.peek();
                std::string name = reader.newName("a parameter");
                if (std::ranges::find(made.parameters, name, [](const auto& each) { return each.second; }) !=
                    made.parameters.end())
                    fail(named, "the parameter " + inQuotes(name) + " is there twice");
                made.parameters.emplace_back(*type, std::move(name));
            } while (reader.accept(","));
        reader.expect(")", "after the parameters");
        if (!reader.peek().is("{"))
            fail(reader.peek(), "expected the function's body in { }, found " + shown(reader.peek()));
        made.first = static_cast<StmtId>(tree.statements.size());
        made.body = statement();
        tree.functions.push_back(std::move(made));
    }

    StmtId block() {
        const Token& first = reader.take();
        Stmt made{Stmt::Kind::block, first.place};
        while (!reader.accept("}")) {
            if (reader.ended()) {
                if (!tree.errors.empty()) break;  // something before is why
                fail(first, "the block that starts here has no closing '}'");
            }
            try {
                made.body.push_back(statement());
            } catch (const Failure& failure) {
                if (tree.errors.size() + 1 >= kMaxCodeErrors || reader.ended()) throw;
                recover(failure);
            }
        }
        return add(std::move(made));
    }

    StmtId branch(Place place) {
        Stmt made{Stmt::Kind::branch, place};
        reader.expect("(", "after if");
        made.expression = expression();
        reader.expect(")", "after the condition");
        made.body.push_back(statement());
        if (reader.acceptName("else")) made.body.push_back(statement());
        return add(std::move(made));
    }

    StmtId loop(Place place) {
        Stmt made{Stmt::Kind::loop, place};
        reader.expect("(", "after for");
        made.body.push_back(reader.peek().is(";") ? nothing() : simpleStatement());
        reader.expect(";", "after the loop's start");
        if (!reader.peek().is(";")) made.expression = expression();
        reader.expect(";", "after the loop's condition");
        made.body.push_back(reader.peek().is(")") ? nothing() : simpleStatement());
        reader.expect(")", "after the loop's step");
        made.body.push_back(statement());
        return add(std::move(made));
    }

    StmtId statement() {
        const Nested guard(*this);
        const Place place = reader.peek().place;
        if (reader.peek().is("{")) return block();
        if (reader.accept(";")) return add(Stmt{Stmt::Kind::block, place});
        if (reader.acceptName("if")) return branch(place);
        if (reader.acceptName("for")) return loop(place);
        for (const char* word : {"while", "do", "switch"})
            if (reader.peek().isName(word))
                fail(reader.peek(),
                     "'" + std::string(word) +
                         "' is not part of the language: use 'for' with bounds that are known");
        Stmt made{Stmt::Kind::result, place};
        if (reader.acceptName("return")) {
            if (!reader.peek().is(";") && !reader.peek().is("}") && !reader.ended())
                made.expression = expression();
        } else if (reader.acceptName("break")) {
            made.kind = Stmt::Kind::leave;
        } else if (reader.acceptName("continue")) {
            made.kind = Stmt::Kind::next;
        } else {
            const StmtId simple = simpleStatement();
            endStatement();
            return simple;
        }
        endStatement();
        return add(std::move(made));
    }

    StmtId declaration(Stmt made) {
        made.declares = true;
        made.type = *declaredType(reader.take().text);
        Stmt several{Stmt::Kind::block, made.place};
        do {
            Stmt one = made;
            one.place = reader.peek().place;
            one.target = reader.newName("a variable");
            if (reader.accept("=")) one.expression = expression();
            several.body.push_back(add(std::move(one)));
        } while (reader.accept(","));
        if (several.body.size() == 1) return several.body[0];
        several.declares = true;
        return add(std::move(several));
    }

    /// A declaration, an assignment or a bare expression, without its semicolon.
    StmtId simpleStatement() {
        Stmt made{Stmt::Kind::assign, reader.peek().place};
        made.constant = reader.acceptName("const");
        if (reader.peek().kind == Token::Kind::name && reader.peek(1).kind == Token::Kind::name) {
            if (declaredType(reader.peek().text)) return declaration(std::move(made));
            fail(reader.peek(), "expected a type " + std::string(kTypes) + ", found " + shown(reader.peek()));
        }
        if (made.constant)
            fail(reader.peek(),
                 "expected a type behind 'const' " + std::string(kTypes) + ", found " + shown(reader.peek()));
        if (reader.peek().is("++") || reader.peek().is("--")) {
            made.operation = reader.take().text[0];
            target(made);
            return add(std::move(made));
        }
        if (reader.peek().kind == Token::Kind::name && startsAssignment()) {
            target(made);
            const Token& sign = reader.take();
            made.operation = sign.text.size() > 1 ? sign.text[0] : char(0);
            if (!sign.is("++") && !sign.is("--")) made.expression = expression();
            return add(std::move(made));
        }
        made.kind = Stmt::Kind::evaluate;
        made.expression = expression();
        return add(std::move(made));
    }

    static bool assigns(const Token& token) {
        for (std::string_view symbol : {"=", "+=", "-=", "*=", "/=", "%=", "++", "--"})
            if (token.is(symbol)) return true;
        return false;
    }

    bool startsAssignment() const {
        std::size_t ahead = 1;
        while (reader.peek(ahead).is(".") && reader.peek(ahead + 1).kind == Token::Kind::name) ahead += 2;
        return assigns(reader.peek(ahead));
    }

    void target(Stmt& made) {
        made.target = reader.newName("a variable");
        if (reader.accept(".")) made.swizzle = reader.memberName();
        if (reader.peek().is(".")) fail(reader.peek(), "only one swizzle can be assigned to");
    }

    Reader reader;
    int depth = 0;
    std::unordered_set<std::string> functionNames;
    Tree tree;
};

}  // namespace

std::optional<Type> declaredType(std::string_view name) {
    if (name == "float") return Type::scalar;
    if (name == "int") return Type::integer;
    if (name == "bool") return Type::boolean;
    if (name == "vec2" || name == "float2") return Type::vec2;
    if (name == "vec3" || name == "float3") return Type::vec3;
    return std::nullopt;
}

bool isReserved(std::string_view name) {
    static constexpr std::string_view kReserved[] = {"if",       "else",  "for",   "return", "break",
                                                     "continue", "const", "while", "do",     "switch"};
    return std::find(std::begin(kReserved), std::end(kReserved), name) != std::end(kReserved);
}

Tree parse(std::string_view code) {
    const Result<std::vector<Token>> tokens = tokenize(code);
    if (!tokens) {
        Tree none;
        none.errors.push_back(tokens.error());
        return none;
    }
    return Parser(*tokens).run();
}

}  // namespace fw::language
