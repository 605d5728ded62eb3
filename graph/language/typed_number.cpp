#include "graph/language/typed_number.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "graph/base/words.h"
#include "graph/language/lower.h"

namespace fw {

namespace {

/// Lengths in micrometres, angles in degrees: a quarter of an inch is then 6.35 mm to the last bit.
struct TypedUnit {
    std::string_view name;
    bool angle;
    double size;
};
constexpr TypedUnit kTypedUnits[] = {{"mm", false, 1e3},    {"cm", false, 1e4},    {"m", false, 1e6},
                                     {"km", false, 1e9},    {"um", false, 1},      {"µm", false, 1},
                                     {"in", false, 25'400}, {"\"", false, 25'400}, {"ft", false, 304'800},
                                     {"'", false, 304'800}, {"deg", true, 1},      {"°", true, 1},
                                     {"rad", true, 0},      {"turn", true, 360}};  // of a radian below
constexpr double kDegreesOfRadian = 57.295779513082320877;
constexpr double kMicrometres = 1e6;  // of a metre

bool isLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_' || (c & 0x80); }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// What an input of this unit is called in messages; empty if units may be typed into it.
std::string noUnitFor(std::string_view unit, const LengthUnit& lengths) {
    if (unit == "m" || unit == "degrees" || unit == "any") return {};
    const std::string sign = unitSign(unit, lengths);
    return sign.empty() ? "a plain number" : "a number in " + sign;
}

/// Replaces units by what they are, from the left to the right.
class Units {
  public:
    Units(std::string_view text_, std::string_view unit_, const LengthUnit& lengths_, double grown_)
        : text(text_), unit(unit_), lengths(lengths_), grown(grown_) {}

    bool any = false;  ///< there was one

    Result<std::string> replaced() {
        while (at < text.size()) {
            const char c = text[at];
            if (c == ' ' || c == '\t') {
                out += c, ++at;
            } else if (isDigit(c) || (c == '.' && !operandEnds)) {
                takeNumber();
            } else if (isLetter(c) || c == '\'' || c == '"') {
                const std::string_view word = takeWord();
                if (operandEnds && !afterName) {
                    if (const Done taken = takeUnit(word); !taken) return taken.error();
                } else {
                    beginOperand();
                    out += word;
                    operandEnds = afterName = true;
                }
            } else {
                takeSign(c);
            }
        }
        return std::move(out);
    }

  private:
    /// A product: where it begins in `out`, and its last factor.
    struct Term {
        std::size_t begin = std::string::npos, operand = std::string::npos;
        bool measured = false;  ///< it has a unit
    };

    void beginOperand() {
        term().operand = out.size();
        if (term().begin == std::string::npos) term().begin = out.size();
        afterName = false;
    }
    Term& term() { return terms.back(); }

    std::size_t endOfNumber(std::size_t from) const {
        std::size_t end = from;
        const auto digits = [&] {
            while (end < text.size() && isDigit(text[end])) ++end;
        };
        digits();
        if (end < text.size() && text[end] == '.') ++end, digits();
        if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
            std::size_t power = end + 1;
            if (power < text.size() && (text[power] == '+' || text[power] == '-')) ++power;
            if (power < text.size() && isDigit(text[power])) end = power, digits();
        }
        return end;
    }

    /// "1 1/2" is one of them.
    void takeNumber() {
        if (operandEnds) out += ' ';  // is no part of it
        beginOperand();
        const std::size_t whole = endOfNumber(at);
        std::size_t upper = whole;
        while (upper < text.size() && text[upper] == ' ') ++upper;
        const std::size_t stroke = upper > whole ? endOfNumber(upper) : whole;
        const bool mixed =
            stroke > upper && stroke + 1 < text.size() && text[stroke] == '/' && isDigit(text[stroke + 1]);
        const std::size_t end = mixed ? endOfNumber(stroke + 1) : whole;
        const std::string_view number = text.substr(at, whole - at);
        out += mixed ? "(" + std::string(number) + "+" + std::string(text.substr(upper, end - upper)) + ")"
                     : std::string(number);
        at = end;
        operandEnds = true;
    }

    std::string_view takeWord() {
        const std::size_t begin = at;
        if (text[at] == '\'' || text[at] == '"')
            ++at;
        else
            while (at < text.size() && (isLetter(text[at]) || isDigit(text[at]))) ++at;
        return text.substr(begin, at - begin);
    }

    Done takeUnit(std::string_view word) {
        const auto found = std::ranges::find(kTypedUnits, word, &TypedUnit::name);
        if (found == std::end(kTypedUnits))
            return Error{.message = inQuotes(word) +
                                    " is no unit: there are mm, cm, m, km, um, in and ft, and "
                                    "of angles deg, rad and turn"};
        const std::string kind = found->angle ? "an angle's" : "a length's";
        if (const std::string is = noUnitFor(unit, lengths); !is.empty())
            return Error{.message =
                             inQuotes(word) + " is " + kind + " unit, and this is " + is + ": leave it out"};
        if (unit == "degrees" && !found->angle)
            return Error{.message = inQuotes(word) +
                                    " is a length's unit, and this is an angle: write deg, "
                                    "rad or turn, or no unit for degrees"};
        if (unit == "m" && found->angle)
            return Error{.message = inQuotes(word) +
                                    " is an angle's unit, and this is a length: write mm, cm, "
                                    "m, in or ft, or no unit for " +
                                    lengths.words};
        any = true;
        const bool feet = (word == "'" || word == "ft") && inchesFollow();
        const std::size_t from = term().measured || feet ? term().operand : term().begin;
        out.insert(from, feet ? "(((" : "((");
        const double size = (found->size > 0 ? found->size : kDegreesOfRadian) * grown,
                     whole = found->angle ? 1.0 : std::round(lengths.metres * kMicrometres);
        char factor[80];
        std::snprintf(factor, sizeof factor, ")*%.17g", size);
        out += factor;
        term().measured = true;
        if (feet) takeInches();
        std::snprintf(factor, sizeof factor, feet ? ")/%.17g)" : "/%.17g)", whole);
        out += factor;
        return done();
    }

    /// Whether "6\"" comes next.
    bool inchesFollow() const {
        std::size_t from = at;
        while (from < text.size() && text[from] == ' ') ++from;
        const std::size_t end = endOfNumber(from);
        return end > from && (text.substr(end).starts_with('"') || text.substr(end).starts_with("in"));
    }
    void takeInches() {
        while (text[at] == ' ') ++at;
        const std::size_t end = endOfNumber(at);
        char inches[40];
        std::snprintf(inches, sizeof inches, "*%.17g", 25'400 * grown);
        out += "+" + std::string(text.substr(at, end - at)) + inches;
        at = end + (text[end] == '"' ? 1 : 2);
    }

    void takeSign(char c) {
        if (c == '(') {
            if (!operandEnds) beginOperand();  // a function's begins with its name
            terms.emplace_back();
            operandEnds = false;
        } else if (c == ')') {
            if (terms.size() > 1) terms.pop_back();
            operandEnds = true;
        } else {
            // A sign before a number is none of its product's.
            const bool factor = c == '*' || c == '/' || c == '.';
            if (!factor && operandEnds) term() = {};
            operandEnds = c == '.' && operandEnds;
        }
        afterName = c == '.' && operandEnds;
        out += c;
        ++at;
    }

    std::string_view text, unit;
    const LengthUnit& lengths;
    double grown;  ///< all units are so many times as long
    std::size_t at = 0;
    std::string out;
    std::vector<Term> terms{1};
    bool operandEnds = false;  ///< what stands before can have a unit
    bool afterName = false;    ///< it is a name, of a number or a function
};

Result<double> grownBy(double times, std::string_view text, std::string_view unit, const LengthUnit& lengths,
                       bool& any) {
    Units units(text, unit, lengths, times);
    const Result<std::string> plain = units.replaced();
    if (!plain) return plain.error();
    any = units.any;
    return constantOf(*plain);
}

}  // namespace

Result<double> constantOf(std::string_view text) {
    language::Lowering state;
    const Result<language::Value> value =
        language::lowerText(state, "return float(" + std::string(text) + ");");
    if (!value) return value.error();
    const IrId id = value->id();
    if (!state.ir.isConstant(id)) return Error{.message = "this depends on the position or the time"};
    if (!std::isfinite(state.ir.number(id))) return Error{.message = "this is no finite number"};
    return state.ir.number(id);
}

Result<double> typedNumber(std::string_view text, std::string_view unit, const LengthUnit& lengths) {
    bool any = false;
    const Result<double> number = grownBy(1, text, unit, lengths, any);
    if (!number || !any) return number;
    const Result<double> twice = grownBy(2, text, unit, lengths, any),
                         thrice = grownBy(3, text, unit, lengths, any);
    const double most =
        twice && thrice ? std::max({std::abs(*number), std::abs(*twice), std::abs(*thrice)}) : 0;
    if (!twice || !thrice || std::abs(*number - 2 * *twice + *thrice) > 1e-9 * most)
        return Error{.message = inQuotes(text) +
                                " comes to no length and no angle: lengths are added, and "
                                "multiplied by plain numbers"};
    return number;
}

}  // namespace fw
