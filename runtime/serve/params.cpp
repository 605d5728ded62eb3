#include "runtime/serve/params.h"

#include <algorithm>
#include <cmath>

#include "graph/base/words.h"

namespace fw::serve {

std::string meant(std::string_view name, std::span<const std::string> names, const std::string& otherwise) {
    const std::string near = nearestName(name, names);
    return near.empty() ? otherwise : ": did you mean " + inQuotes(near) + "?";
}

const Json* Params::any(const char* name) {
    known.emplace_back(name);
    const auto found = object.find(name);
    return found == object.end() || found->is_null() ? nullptr : &*found;
}

void Params::refuse(const char* name, const std::string& why) {
    if (!first) first = Fault(kWrongParameters, "\"" + std::string(name) + "\" of " + method + " " + why);
}

void Params::need(const char* name) {
    if (!any(name)) refuse(name, "is missing: give it");
}

double Params::number(const char* name, double otherwise, double least, double greatest) {
    const Json* value = any(name);
    if (!value) return otherwise;
    const double number = value->is_number() ? value->get<double>() : NAN;
    if (number >= least && number <= greatest) return number;
    refuse(name, "is a number from " + shortNumber(least) + " to " + shortNumber(greatest));
    return otherwise;
}

int Params::whole(const char* name, int otherwise, int least, int greatest) {
    const double value = number(name, otherwise, least, greatest);
    if (value == std::floor(value)) return int(value);
    refuse(name, "is a whole number from " + std::to_string(least) + " to " + std::to_string(greatest));
    return otherwise;
}

bool Params::flag(const char* name, bool otherwise) {
    const Json* value = any(name);
    if (!value) return otherwise;
    if (value->is_boolean()) return value->get<bool>();
    refuse(name, "is true or false");
    return otherwise;
}

std::string Params::text(const char* name, std::string otherwise) {
    const Json* value = any(name);
    if (!value) return otherwise;
    if (value->is_string() && value->get_ref<const std::string&>().find('\0') == std::string::npos)
        return value->get<std::string>();
    refuse(name, value->is_string() ? "has a NUL character in it: leave that out" : "is a text");
    return otherwise;
}

std::string Params::oneOf(const char* name, std::span<const std::string> words, std::string otherwise) {
    const Json* value = any(name);
    if (!value) return otherwise;
    const std::string word = value->is_string() ? value->get<std::string>() : std::string();
    if (std::ranges::find(words, word) != words.end()) return word;
    refuse(name, "is one of " + listed({words.begin(), words.end()}) + meant(word, words));
    return otherwise;
}

std::optional<Fault> Params::fault() {
    for (const auto& [name, value] : object.items()) {
        if (std::ranges::find(known, name) != known.end()) continue;
        return Fault(kWrongParameters, method + " has no parameter " + inQuotes(name) + meant(name, known));
    }
    return first;
}

}  // namespace fw::serve
