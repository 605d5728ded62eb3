#include "runtime/measure/mesh_requirements.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "graph/language/typed_number.h"

namespace fw {

namespace {

using Reason = std::string;  // empty: it is as required

std::string text(double number) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.6g", number);
    return digits;
}

Reason none(uint64_t count, const char* what) {
    return count > 0 ? "it has " + std::to_string(count) + " " + what : Reason();
}

Reason closed(const Report& report, double) {
    return none(report.boundaryEdges, "open edges (edges of one triangle)");
}

Reason complete(const Report& report, double) {
    if (!report.completeness)
        return "it was not checked against its field: give --overwrite if the file was there before";
    if (report.completeness->complete()) return {};
    return describeMissing(*report.completeness) + ": give a larger --region";
}

Reason manifold(const Report& report, double) {
    if (report.nonManifoldEdges > 0) return none(report.nonManifoldEdges, "edges of more than two triangles");
    if (report.nonManifoldVertices > 0) return none(report.nonManifoldVertices, "vertices where parts touch");
    return none(report.flippedEdges, "edges between triangles that face opposite ways");
}

Reason uncut(const Report& report, double) {
    return none(report.selfIntersections.value_or(0), "pairs of triangles that cut each other");
}

Reason nondegenerate(const Report& report, double) {
    return none(report.degenerateTriangles, "triangles without area");
}

Reason count(uint64_t there, double wanted, const char* one, const char* many) {
    return double(there) == wanted ? Reason()
                                   : "it has " + std::to_string(there) + " " + (there == 1 ? one : many);
}

Reason bodies(const Report& report, double wanted) {
    return count(report.bodies(), wanted, "body (piece that hangs together)",
                 "bodies (pieces that hang together)");
}

Reason cavities(const Report& report, double wanted) {
    return count(report.cavities, wanted, "cavity (hollow that nothing leads out of)",
                 "cavities (hollows that nothing leads out of)");
}

Reason triangles(const Report& report, double most) {
    return double(report.triangles) <= most ? Reason()
                                            : "it has " + std::to_string(report.triangles) + " triangles";
}

Reason angle(const Report& report, double least) {
    return report.smallestAngle >= least ? Reason()
                                         : "its smallest angle is " + text(report.smallestAngle) + " degrees";
}

Reason tooNarrow(const std::optional<LeastWidth>& there, const char* what, const Report& report,
                 double least) {
    if (!there || there->width >= least) return {};
    std::string place;
    for (const double at : there->place) place += (place.empty() ? "" : ", ") + text(at);
    return std::string(what) + " of " + withSign(there->width, "m", report.lengths()) + " at (" + place + ")";
}

Reason wall(const Report& report, double least) {
    return tooNarrow(report.widths ? report.widths->wall : std::nullopt, "it has a wall", report, least);
}

Reason gap(const Report& report, double least) {
    return tooNarrow(report.widths ? report.widths->gap : std::nullopt, "it has a gap", report, least);
}

Reason error(const Report& report, double most) {
    const auto far = [&](const std::optional<SampledDistance>& distance) {
        return distance && !(distance->max <= most);
    };
    if (far(report.meshToSurface))
        return "a point of it is " + withSign(report.meshToSurface->max, "m", report.lengths()) +
               " from the surface";
    if (far(report.surfaceToMesh))
        return "a point of the surface is " + withSign(report.surfaceToMesh->max, "m", report.lengths()) +
               " from it";
    return {};
}

struct Rule {
    std::string_view name;
    const char* number;  ///< what its number is; null: it takes none
    Reason (*broken)(const Report& report, double number);
    bool whole = false;   ///< only whole numbers make sense
    bool length = false;  ///< it may have a unit
};

constexpr Rule kRules[] = {{"closed", nullptr, closed},
                           {"complete", nullptr, complete},
                           {"manifold", nullptr, manifold},
                           {"uncut", nullptr, uncut},
                           {"nondegenerate", nullptr, nondegenerate},
                           {"bodies", "COUNT", bodies, true},
                           {"cavities", "COUNT", cavities, true},
                           {"triangles", "COUNT", triangles, true},
                           {"angle", "DEGREES", angle},
                           {"wall", "LENGTH", wall, false, true},
                           {"gap", "LENGTH", gap, false, true},
                           {"error", "LENGTH", error, false, true}};

Result<double> numberIn(std::string_view words, const Rule& rule, const LengthUnit& lengths) {
    double number = 0.0;
    if (rule.length) {
        const Result<double> typed = typedNumber(words, "m", lengths);
        if (!typed)
            return Error{.message = "needs a number that is not negative" +
                                    (words.empty() ? "" : ": " + typed.error().message)};
        number = *typed;
    } else {
        const auto [end, problem] = std::from_chars(words.data(), words.data() + words.size(), number);
        if (problem != std::errc() || end != words.data() + words.size()) number = NAN;
    }
    if (!(std::isfinite(number) && number >= 0.0))
        return Error{.message = "needs a number that is not negative"};
    if (rule.whole && number != std::floor(number)) return Error{.message = "needs a whole number"};
    return number;
}

bool asks(const std::vector<Requirement>& requirements, decltype(Rule::broken) what) {
    return std::ranges::any_of(requirements,
                               [&](const Requirement& each) { return kRules[each.rule].broken == what; });
}

Error refused(std::string_view word, const std::string& why) {
    return {.message = "\"" + std::string(word) + "\" " + why + ": a mesh can be required to be " +
                       requirementNames()};
}

}  // namespace

std::string requirementNames() {
    std::string names;
    for (const Rule& rule : kRules)
        names += (names.empty() ? "" : " ") + std::string(rule.name) +
                 (rule.number ? "=" + std::string(rule.number) : std::string());
    return names;
}

Result<std::vector<Requirement>> parseRequirements(std::string_view list) {
    std::vector<Requirement> requirements;
    for (bool more = true; more;) {
        const std::size_t comma = list.find(',');
        more = comma != list.npos;
        const std::string_view word = list.substr(0, comma), name = word.substr(0, word.find('='));
        if (more) list.remove_prefix(comma + 1);
        const auto rule = std::ranges::find(kRules, name, &Rule::name);
        if (rule == std::end(kRules)) return refused(word, "is no requirement");
        Requirement required{std::size_t(rule - kRules), {}};
        const bool given = name.size() < word.size();
        if (given != (rule->number != nullptr))
            return refused(word, given ? "takes no number" : "needs a number");
        if (given) {
            required.number = word.substr(name.size() + 1);
            const Result<double> number = numberIn(required.number, *rule, *lengthUnit("m"));
            if (!number) return refused(word, number.error().message);
        }
        requirements.push_back(required);
    }
    return requirements;
}

bool needField(const std::vector<Requirement>& requirements) {
    return needDistances(requirements) || asks(requirements, complete);
}

bool needDistances(const std::vector<Requirement>& requirements) { return asks(requirements, error); }

std::vector<std::string> unmet(const std::vector<Requirement>& requirements, const Report& report) {
    std::vector<std::string> reasons;
    std::vector<Requirement> all = requirements;
    if (report.completeness && report.regionFound && asks(all, closed) && !asks(all, complete)) {
        const auto rule = std::ranges::find(kRules, &complete, &Rule::broken);
        all.push_back({std::size_t(rule - kRules), {}});
    }
    for (const auto& [at, number] : all) {
        const Rule& rule = kRules[at];
        const double of = rule.number ? *numberIn(number, rule, report.lengths()) : 0.0;
        const Reason reason = rule.broken(report, of);
        if (reason.empty()) continue;
        reasons.push_back("not " + std::string(rule.name) + (rule.number ? "=" + number : "") + ": " +
                          reason);
    }
    return reasons;
}

}  // namespace fw
