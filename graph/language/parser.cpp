#include "graph/language/parser.h"

#include <algorithm>
#include <optional>

namespace fw::language {

namespace {

/// Thrown inside this file only, to leave the recursive descent at the first error.
struct Failure {
    Error error;
};

std::optional<Type> typeNamed(std::string_view name) {
    if (name == "float") return Type::scalar;
    if (name == "int") return Type::integer;
    if (name == "bool") return Type::boolean;
    if (name == "vec2" || name == "float2") return Type::vec2;
    if (name == "vec3" || name == "float3") return Type::vec3;
    return std::nullopt;
}

constexpr std::string_view kReserved[] = {"if",       "else",  "for",   "return", "break",
                                          "continue", "const", "while", "do",     "switch"};

/// Binding strength of a binary operator; 0 if it is none.
int precedence(const Token& token) {
    if (token.kind != Token::Kind::symbol) return 0;
    static constexpr std::pair<std::string_view, int> table[] = {
        {"||", 1}, {"&&", 2}, {"==", 3}, {"!=", 3}, {"<", 4}, {">", 4}, {"<=", 4},
        {">=", 4}, {"+", 5},  {"-", 5},  {"*", 6},  {"/", 6}, {"%", 6}};
    for (const auto& [symbol, strength] : table)
        if (token.text == symbol) return strength;
    return 0;
}

class Parser {
  public:
    explicit Parser(const std::vector<Token>& tokens_) : tokens(tokens_) {}

    Tree run() {
        while (peek().kind != Token::Kind::end) {
            if (startsFunction())
                function();
            else
                tree.body.push_back(statement());
        }
        return std::move(tree);
    }

  private:
    const Token& peek(int ahead = 0) const { return tokens[std::min(at + ahead, tokens.size() - 1)]; }
    const Token& take() { return tokens[std::min(at++, tokens.size() - 1)]; }
    bool accept(std::string_view symbol) { return peek().is(symbol) ? (++at, true) : false; }
    bool acceptName(std::string_view name) { return peek().isName(name) ? (++at, true) : false; }

    [[noreturn]] static void fail(const Token& token, const std::string& message) {
        throw Failure{codeError(token.place, message)};
    }
    static std::string shown(const Token& token) {
        return token.kind == Token::Kind::end ? "the end of the code" : inQuotes(token.text);
    }
    void expect(std::string_view symbol, std::string_view after) {
        if (!accept(symbol))
            fail(peek(),
                 "expected '" + std::string(symbol) + "' " + std::string(after) + ", found " + shown(peek()));
    }
    std::string newName(std::string_view what) {
        const Token& token = take();
        if (token.kind != Token::Kind::name)
            fail(token, "expected the name of " + std::string(what) + ", found " + shown(token));
        if (std::find(std::begin(kReserved), std::end(kReserved), token.text) != std::end(kReserved) ||
            typeNamed(token.text))
            fail(token, "'" + std::string(token.text) + "' is a word of the language: choose another name");
        return std::string(token.text);
    }
    void endStatement() {
        if (peek().kind != Token::Kind::end && !peek().is("}")) expect(";", "after the statement");
    }

    /// Guards the recursion of the descent itself.
    struct Nested {
        Parser& parser;
        Nested(Parser& parser_) : parser(parser_) {
            if (++parser.depth > kMaxDepth)
                fail(parser.peek(),
                     "the code is nested deeper than " + std::to_string(kMaxDepth) + " levels: split it");
        }
        ~Nested() { --parser.depth; }
    };

    ExprId add(Expr expression) {
        for (ExprId child : expression.arguments)
            expression.depth = std::max(expression.depth, tree.expressions[child].depth + 1);
        if (expression.depth > 4 * kMaxDepth)
            throw Failure{
                codeError(expression.place, "the expression has more than " + std::to_string(4 * kMaxDepth) +
                                                " operations in a chain: split it over several statements")};
        tree.expressions.push_back(std::move(expression));
        return static_cast<ExprId>(tree.expressions.size() - 1);
    }
    StmtId add(Stmt statement) {
        tree.statements.push_back(std::move(statement));
        return static_cast<StmtId>(tree.statements.size() - 1);
    }

    bool startsFunction() const {
        return peek().kind == Token::Kind::name && typeNamed(peek().text) &&
               peek(1).kind == Token::Kind::name && peek(2).is("(");
    }

    void function() {
        Function made;
        made.place = peek().place;
        made.result = *typeNamed(take().text);
        const Token& nameToken = peek();
        made.name = newName("a function");
        if (tree.function(made.name))
            fail(nameToken, "the function " + inQuotes(made.name) + " is defined twice");
        expect("(", "after the function's name");
        if (!peek().is(")")) do {
                const Token& typeToken = take();
                const auto type = typeNamed(typeToken.text);
                if (!type)
                    fail(typeToken, "expected a parameter's type (float, int, bool, vec2 or vec3), found " +
                                        shown(typeToken));
                made.parameters.emplace_back(*type, newName("a parameter"));
            } while (accept(","));
        expect(")", "after the parameters");
        if (!peek().is("{")) fail(peek(), "expected the function's body in { }, found " + shown(peek()));
        made.body = statement();
        tree.functions.push_back(std::move(made));
    }

    StmtId statement() {
        const Nested guard(*this);
        const Token& first = peek();
        Stmt made{Stmt::Kind::block, first.place};
        if (accept("{")) {
            while (!accept("}")) {
                if (peek().kind == Token::Kind::end)
                    fail(first, "the block that starts here has no closing '}'");
                made.body.push_back(statement());
            }
            return add(std::move(made));
        }
        if (accept(";")) return add(std::move(made));
        if (acceptName("if")) {
            made.kind = Stmt::Kind::branch;
            expect("(", "after if");
            made.expression = expression();
            expect(")", "after the condition");
            made.body.push_back(statement());
            if (acceptName("else")) made.body.push_back(statement());
            return add(std::move(made));
        }
        if (acceptName("for")) {
            made.kind = Stmt::Kind::loop;
            expect("(", "after for");
            made.body.push_back(peek().is(";") ? nothing() : simpleStatement());
            expect(";", "after the loop's start");
            if (peek().is(";")) fail(peek(), "the loop has no condition: it would not end");
            made.expression = expression();
            expect(";", "after the loop's condition");
            made.body.push_back(peek().is(")") ? nothing() : simpleStatement());
            expect(")", "after the loop's step");
            made.body.push_back(statement());
            return add(std::move(made));
        }
        if (peek().isName("while") || peek().isName("do") || peek().isName("switch"))
            fail(peek(), "'" + std::string(peek().text) +
                             "' is not part of the language: use 'for' with bounds that are known");
        if (acceptName("return")) {
            made.kind = Stmt::Kind::result;
            if (!peek().is(";") && !peek().is("}") && peek().kind != Token::Kind::end)
                made.expression = expression();
        } else if (acceptName("break")) {
            made.kind = Stmt::Kind::leave;
        } else if (acceptName("continue")) {
            made.kind = Stmt::Kind::next;
        } else {
            const StmtId simple = simpleStatement();
            endStatement();
            return simple;
        }
        endStatement();
        return add(std::move(made));
    }

    StmtId nothing() { return add(Stmt{Stmt::Kind::block, peek().place}); }

    /// A declaration, an assignment or a bare expression, without its semicolon.
    StmtId simpleStatement() {
        Stmt made{Stmt::Kind::assign, peek().place};
        made.constant = acceptName("const");
        if (peek().kind == Token::Kind::name && typeNamed(peek().text) && peek(1).kind == Token::Kind::name) {
            made.declares = true;
            made.type = *typeNamed(take().text);
            Stmt several{Stmt::Kind::block, made.place};
            do {
                Stmt one = made;
                one.place = peek().place;
                one.target = newName("a variable");
                if (accept("=")) one.expression = expression();
                several.body.push_back(add(std::move(one)));
            } while (accept(","));
            if (several.body.size() == 1) return several.body[0];
            several.declares = true;  // its declarations belong to the surrounding block
            return add(std::move(several));
        }
        if (peek().is("++") || peek().is("--")) {
            made.operation = take().text.substr(0, 1);
            target(made);
            made.expression = one(made.place);
            return add(std::move(made));
        }
        if (peek().kind == Token::Kind::name && startsAssignment()) {
            target(made);
            const Token& sign = take();
            if (sign.is("++") || sign.is("--")) {
                made.operation = sign.text.substr(0, 1);
                made.expression = one(sign.place);
            } else {
                made.operation = sign.text.substr(0, sign.text.size() - 1);
                made.expression = expression();
            }
            return add(std::move(made));
        }
        made.kind = Stmt::Kind::evaluate;
        made.expression = expression();
        return add(std::move(made));
    }

    ExprId one(Place place) { return add(Expr{Expr::Kind::number, place, "1", 1.0, true}); }

    bool startsAssignment() const {
        int ahead = 1;
        while (peek(ahead).is(".") && peek(ahead + 1).kind == Token::Kind::name) ahead += 2;
        const Token& token = peek(ahead);
        for (std::string_view symbol : {"=", "+=", "-=", "*=", "/=", "%=", "++", "--"})
            if (token.is(symbol)) return true;
        return false;
    }

    void target(Stmt& made) {
        made.target = newName("a variable");
        if (accept(".")) {
            const Token& member = take();
            if (member.kind != Token::Kind::name)
                fail(member, "expected a component (as .x or .xyz) after '.', found " + shown(member));
            made.swizzle = std::string(member.text);
        }
        if (peek().is(".")) fail(peek(), "only one swizzle can be assigned to");
    }

    ExprId expression() {
        const Nested guard(*this);
        const ExprId condition = binary(1);
        if (!peek().is("?")) return condition;
        Expr made{Expr::Kind::conditional, take().place, "?"};
        made.arguments = {condition, expression()};
        expect(":", "between the two values of '?'");
        made.arguments.push_back(expression());
        return add(std::move(made));
    }

    ExprId binary(int least) {
        ExprId left = unary();
        while (true) {
            const int strength = precedence(peek());
            if (strength == 0 || strength < least) return left;
            const Token& sign = take();
            Expr made{Expr::Kind::binary, sign.place, std::string(sign.text)};
            made.arguments = {left, binary(strength + 1)};
            left = add(std::move(made));
        }
    }

    ExprId unary() {
        const Nested guard(*this);
        if (peek().is("-") || peek().is("!") || peek().is("+")) {
            const Token& sign = take();
            const ExprId operand = unary();
            if (sign.is("+")) return operand;
            Expr made{Expr::Kind::unary, sign.place, std::string(sign.text)};
            made.arguments = {operand};
            return add(std::move(made));
        }
        ExprId value = primary();
        while (true) {
            const Token& sign = peek();
            if (accept(".")) {
                const Token& member = take();
                if (member.kind != Token::Kind::name)
                    fail(member, "expected a component (as .x or .xyz) after '.', found " + shown(member));
                Expr made{Expr::Kind::member, member.place, std::string(member.text)};
                made.arguments = {value};
                value = add(std::move(made));
            } else if (accept("[")) {
                Expr made{Expr::Kind::index, sign.place, "[]"};
                made.arguments = {value, expression()};
                expect("]", "after the index");
                value = add(std::move(made));
            } else {
                return value;
            }
        }
    }

    ExprId primary() {
        const Token& token = take();
        Expr made{Expr::Kind::number, token.place, std::string(token.text)};
        switch (token.kind) {
            case Token::Kind::integer:
            case Token::Kind::number:
                made.number = token.value;
                made.integer = token.kind == Token::Kind::integer;
                return add(std::move(made));
            case Token::Kind::string: made.kind = Expr::Kind::string; return add(std::move(made));
            case Token::Kind::name:
                if (std::find(std::begin(kReserved), std::end(kReserved), token.text) != std::end(kReserved))
                    fail(token, "expected a value, found the word '" + std::string(token.text) + "'");
                made.kind = Expr::Kind::name;
                if (accept("(")) {
                    made.kind = Expr::Kind::call;
                    if (!peek().is(")")) do {
                            made.arguments.push_back(expression());
                        } while (accept(","));
                    expect(")", "after the arguments of " + inQuotes(made.text));
                }
                return add(std::move(made));
            case Token::Kind::symbol:
                if (token.is("(")) {
                    const ExprId inside = expression();
                    expect(")", "to close the parenthesis");
                    return inside;
                }
                [[fallthrough]];
            case Token::Kind::end: break;
        }
        fail(token, "expected a value, found " + shown(token));
    }

    const std::vector<Token>& tokens;
    std::size_t at = 0;
    int depth = 0;
    Tree tree;
};

}  // namespace

const Function* Tree::function(std::string_view name) const {
    const auto found =
        std::find_if(functions.begin(), functions.end(), [&](const Function& f) { return f.name == name; });
    return found == functions.end() ? nullptr : &*found;
}

Result<std::shared_ptr<const Tree>> parse(std::string_view code) {
    Result<std::vector<Token>> tokens = tokenize(code);
    if (!tokens) return tokens.error();
    try {
        return std::make_shared<const Tree>(Parser(*tokens).run());
    } catch (const Failure& failure) { return failure.error; }
}

}  // namespace fw::language
