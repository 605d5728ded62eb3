#include "graph/document/input_value.h"

#include <algorithm>
#include <cmath>

#include "graph/base/result.h"
#include "graph/base/words.h"

namespace fw {

namespace {

std::string plural(std::size_t count, std::string_view word) {
    return std::to_string(count) + " " + std::string(word) + (count == 1 ? "" : "s");
}

bool isKind(Type type, const InputValue& value) {
    const double* number = std::get_if<double>(&value.value);
    const auto* array = std::get_if<std::vector<double>>(&value.value);
    switch (type) {
        case Type::boolean: return std::holds_alternative<bool>(value.value);
        case Type::integer: return number && (!std::isfinite(*number) || *number == std::round(*number));
        case Type::scalar: return number;
        case Type::vec2: return array && value.entry == 0 && array->size() == 2;
        case Type::vec3: return array && value.entry == 0 && array->size() == 3;
        case Type::string:
        case Type::image: return std::holds_alternative<std::string>(value.value);
        case Type::points:
        case Type::stops:
        case Type::knots: return array && value.entry == entrySize(type);
        case Type::surface:
        case Type::mesh:
        case Type::particles:
        case Type::spline: return false;
    }
    return false;
}

/// What is wrong with the radii of knots.
std::optional<std::string> radiusProblem(std::span<const double> knots) {
    const auto size = std::size_t(entrySize(Type::knots));
    for (std::size_t i = 0; i < knots.size(); i += size)
        if (knots[i + 3] < 0)
            return "the radius of knot " + std::to_string(i / size + 1) + " is " + shortNumber(knots[i + 3]) +
                   ": it must be at least 0";
    return {};
}

std::optional<std::string> optionProblem(const InputSpec& spec, const std::string& word) {
    if (spec.options.empty() ||
        std::find(spec.options.begin(), spec.options.end(), word) != spec.options.end())
        return {};
    const std::string near = nearestName(std::string_view(word).substr(0, 64), spec.options);
    return inQuotes(word) + " is none of its options" +
           (near.empty() ? "" : "; did you mean '" + near + "'?") + "; they are " + listed(spec.options);
}

}  // namespace

InputValue numbersValue(std::span<const double> numbers) {
    InputValue value;
    if (numbers.size() == 1)
        value.value = numbers[0];
    else
        value.value = std::vector<double>(numbers.begin(), numbers.end());
    return value;
}

InputValue listValue(Type type, std::vector<double> numbers) {
    InputValue value{.value = std::move(numbers)};
    value.entry = entrySize(type);
    return value;
}

std::optional<std::string> valueProblem(Type type, const InputSpec* spec, const InputValue& value) {
    if (!isKind(type, value)) return "expected " + std::string(expectedOf(type)) + ", not " + describe(value);
    if (const auto* word = std::get_if<std::string>(&value.value))
        return spec ? optionProblem(*spec, *word) : std::nullopt;
    std::vector<double> numbers;
    if (const double* number = std::get_if<double>(&value.value)) numbers.assign(1, *number);
    if (const auto* several = std::get_if<std::vector<double>>(&value.value)) numbers = *several;
    for (const double number : numbers) {
        if (!std::isfinite(number)) return "the value is not a finite number: give it a number";
        if (type == Type::integer && std::abs(number) > 2147483647.0)
            return "the whole number " + shortNumber(number) + " is beyond 32 bits: make it smaller";
        if (!spec) continue;
        if (auto problem = rangeProblem(*spec, number)) return problem;
    }
    if (type == Type::stops || (spec && spec->ordered)) return orderProblem(type, numbers);
    if (type == Type::knots) return radiusProblem(numbers);
    return {};
}

std::string_view expectedOf(Type type) {
    switch (type) {
        case Type::boolean: return "true or false";
        case Type::integer: return "a whole number";
        case Type::scalar: return "a number or a link";
        case Type::vec2: return "two numbers [x, y] or a link";
        case Type::vec3: return "three numbers [x, y, z] or a link";
        case Type::surface: return "a link to a node with a surface, {\"from\": \"node\"}";
        case Type::string: return "a string";
        case Type::points: return "an array of [x, y] pairs";
        case Type::stops: return "an array of stops [position, red, green, blue]";
        case Type::knots: return "an array of knots [x, y, z, radius, twist]";
        case Type::image: return "the path of a picture, a string";
        case Type::mesh: return "a link to a node with a mesh, {\"from\": \"node\"}";
        case Type::particles: return "a link to a node with particles, {\"from\": \"node\"}";
        case Type::spline: return "a link to a node with a spline, {\"from\": \"node\"}";
    }
    return "";
}

std::string describe(const InputValue& input) {
    const struct {
        const InputValue& input;
        std::string operator()(double value) const { return "the number " + shortNumber(value); }
        std::string operator()(bool value) const { return value ? "true" : "false"; }
        std::string operator()(const std::string& value) const { return "the string " + inQuotes(value); }
        std::string operator()(const std::vector<double>& numbers) const {
            if (numbers.empty()) return "an empty array";
            if (input.entry == 0) return "an array of " + plural(numbers.size(), "number");
            return "an array of " + plural(numbers.size() / std::size_t(input.entry),
                                           input.entry == entrySize(Type::points)  ? "pair"
                                           : input.entry == entrySize(Type::stops) ? "stop"
                                                                                   : "knot");
        }
        std::string operator()(const Link& link) const { return "a link to " + inQuotes(link.node); }
    } text{input};
    return std::visit(text, input.value);
}

}  // namespace fw
