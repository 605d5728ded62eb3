#include "graph/assets/particle_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <optional>
#include <span>

#include "graph/assets/triangle_mesh_text.h"
#include "graph/base/asset_file.h"
#include "graph/base/hash.h"

namespace fw {

namespace {

/// The line's fields: between semicolons, or else commas, or else blanks; without quotes about them.
std::vector<std::string_view> fieldsOf(std::string_view line) {
    std::vector<std::string_view> fields;
    const char mark = line.find(';') != line.npos ? ';' : ',';
    if (line.find(mark) == line.npos) {
        Scanner words{line};
        for (std::string_view word = words.word(); !word.empty(); word = words.word()) fields.push_back(word);
        return fields;
    }
    for (std::size_t end = 0; end != line.npos; line.remove_prefix(end == line.npos ? 0 : end + 1)) {
        end = line.find(mark);
        std::string_view field = Scanner{line.substr(0, end)}.word();
        if (field.size() > 1 && field.front() == '"' && field.back() == '"')
            field = field.substr(1, field.size() - 2);
        fields.push_back(field);
    }
    return fields;
}

bool isFinite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

constexpr std::size_t kNoColumn = std::size_t(-1);
using Columns = std::array<std::size_t, 3>;  ///< of a place, or of a velocity

std::optional<glm::vec3> vectorIn(std::span<const std::string_view> fields, const Columns& columns) {
    glm::vec3 vector;
    for (int k = 0; k < 3; ++k) {
        const std::size_t column = columns[std::size_t(k)];
        const auto number =
            column < fields.size() ? Scanner::numberIn<float>(fields[column]) : std::optional<float>();
        if (!number) return std::nullopt;
        vector[k] = *number;
    }
    return vector;
}

/// Which fields of a line are what.
struct Layout {
    Columns place = {0, 1, 2}, velocity = {kNoColumn, kNoColumn, kNoColumn};
    std::size_t id = kNoColumn;
    bool moves() const { return std::ranges::find(velocity, kNoColumn) == velocity.end(); }
};

/// As a line of names says; the first three are places if it names none of them.
Layout layoutIn(std::span<const std::string_view> names) {
    const auto named = [&](std::string_view wanted) {
        const auto found = std::ranges::find_if(names, [&](std::string_view name) {
            return std::ranges::equal(
                name, wanted, {}, [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); });
        });
        return found == names.end() ? kNoColumn : std::size_t(found - names.begin());
    };
    Layout layout;
    const Columns places = {named("x"), named("y"), named("z")};
    if (std::ranges::find(places, kNoColumn) == places.end()) layout.place = places;
    layout.velocity = {named("vx"), named("vy"), named("vz")};
    layout.id = named("id");
    return layout;
}

/// Those in a text: in each line after one of names, which may be missing, or in an OBJ file in each line of
/// a vertex.
Result<FilePoints> pointsInText(std::string_view bytes, const std::string& path, bool obj) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
    const auto wrong = [&](const std::string& what, int line) {
        return fileProblem(path, kParticleFile, what + " in line " + std::to_string(line));
    };
    FilePoints points;
    Layout layout;
    if (obj) layout.place = {1, 2, 3};
    bool first = !obj;
    Scanner scanner{bytes};
    for (int line = 1; !scanner.atEnd(); ++line) {
        const std::vector<std::string_view> fields = fieldsOf(scanner.line());
        if (fields.empty() || fields[0].starts_with('#') || (obj && fields[0] != "v")) continue;
        if (const std::optional<glm::vec3> place = vectorIn(fields, layout.place)) {
            if (!isFinite(*place)) return wrong("has a place that is not a number", line);
            points.places.push_back(*place);
            if (layout.moves()) {
                const std::optional<glm::vec3> velocity = vectorIn(fields, layout.velocity);
                if (!velocity) return wrong("has no velocity", line);
                points.velocities.push_back(*velocity);
            }
            if (layout.id != kNoColumn) {
                const auto id = layout.id < fields.size() ? Scanner::numberIn<uint32_t>(fields[layout.id])
                                                          : std::optional<uint32_t>();
                if (!id) return wrong("has no id that is a whole number from 0", line);
                points.ids.push_back(*id);
            }
        } else if (first && fields[0].find_first_of("0123456789+-.") != 0) {  // not a number, however large
            layout = layoutIn(fields);
        } else {
            return fileProblem(path, kParticleFile,
                               "has no three numbers in line " + std::to_string(line) + ": write x y z");
        }
        first = false;
    }
    return points;
}

}  // namespace

Result<FilePoints> parseParticlePlaces(const std::string& bytes, const std::string& path) {
    if (!endsAs(kParticleFile, path)) return wrongEnding(path, kParticleFile);
    const std::string ending = endingOf(path);
    Result<FilePoints> points = ending == ".ply"    ? readPlyPoints(bytes, path)
                                : ending == ".vtk"  ? readVtkPoints(bytes, path)
                                : ending == ".bgeo" ? readBgeoPoints(bytes, path)
                                                    : pointsInText(bytes, path, ending == ".obj");
    if (!points) return points;
    if (points->places.empty()) return fileProblem(path, kParticleFile, "has no places of particles");
    if (points->places.size() > kMostFileParticles)
        return fileProblem(path, kParticleFile,
                           "has " + std::to_string(points->places.size()) +
                               " particles: " + std::to_string(kMostFileParticles) + " is the most");
    if (!std::ranges::all_of(points->places, isFinite))
        return fileProblem(path, kParticleFile, "has a place that is not a number");
    if (!std::ranges::all_of(points->velocities, isFinite))
        return fileProblem(path, kParticleFile, "has a velocity that is not a number");
    return points;
}

namespace {

uint64_t hashOf(const FilePoints& points) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (const auto* list : {&points.places, &points.velocities})
        for (const glm::vec3& p : *list)
            for (int k = 0; k < 3; ++k) hash = mixed(hash, std::bit_cast<uint32_t>(p[k]));
    for (const uint32_t id : points.ids) hash = mixed(hash, id);
    return hash;
}

}  // namespace

Result<ParticlePlacesPtr> readParticlePlaces(const std::string& graphPath, const std::string& path) {
    return readAsset<ParticlePlaces>(
        graphPath, path, kParticleFile,
        [&](const std::string& bytes, const std::string& file) -> Result<ParticlePlacesPtr> {
            Result<FilePoints> points = parseParticlePlaces(bytes, path);
            if (!points) return points.error();
            const uint64_t hash = hashOf(*points);
            return std::make_shared<const ParticlePlaces>(ParticlePlaces{std::move(*points), file, hash});
        });
}

// ---- sequences

namespace {

struct NumberedName {
    std::string before, after;
    std::size_t digits = 1;
};

/// The path's parts about the number in its file's name; none without a number.
std::optional<NumberedName> partsOfSequence(std::string_view path) {
    const std::size_t name = path.rfind('/') + 1;  // npos + 1 is 0
    const auto parts = [&](std::size_t at, std::size_t length, std::size_t digits) {
        return NumberedName{std::string(path.substr(0, at)), std::string(path.substr(at + length)), digits};
    };
    if (const std::size_t at = path.find('#', name); at != path.npos) {
        const std::size_t end = std::min(path.find_first_not_of('#', at), path.size());
        return parts(at, end - at, end - at);
    }
    const std::size_t at = path.find('%', name);
    if (at == path.npos) return std::nullopt;
    const std::size_t end = path.find_first_not_of("0123456789", at + 1);
    if (end == path.npos || path[end] != 'd') return std::nullopt;
    const auto digits = Scanner::numberIn<uint32_t>(path.substr(at + 1, end - at - 1)).value_or(1);
    return parts(at, end + 1 - at, std::clamp<std::size_t>(digits, 1, 18));
}

}  // namespace

bool namesSequence(std::string_view path) { return partsOfSequence(path).has_value(); }

std::string ParticleSequence::path(long number) const {
    const std::string text = std::to_string(number);
    return before + std::string(digits - std::min(text.size(), digits), '0') + text + after;
}

long ParticleSequence::numberAt(double seconds, double framesPerSecond) const {
    const double wanted = std::floor(seconds * framesPerSecond + 1e-6);
    const auto behind =
        std::ranges::upper_bound(numbers, wanted, {}, [](long number) { return double(number); });
    return behind == numbers.begin() ? numbers.front() : *(behind - 1);
}

Result<ParticleSequencePtr> readParticleSequence(const std::string& graphPath, const std::string& path) {
    namespace fs = std::filesystem;
    constexpr std::size_t kLookedInto = 16;
    const std::optional<NumberedName> parts = partsOfSequence(path);
    if (!parts) return fileProblem(path, kParticleFile, "is no sequence: write #### where its number is");
    if (!endsAs(kParticleFile, path)) return wrongEnding(path, kParticleFile);
    if (const Done inside = checkAssetPlace(graphPath, path, kParticleFile); !inside) return inside.error();
    ParticleSequence made{
        .graphPath = graphPath, .before = parts->before, .after = parts->after, .digits = parts->digits};
    const fs::path within = parts->before.ends_with('/') || parts->before.empty()
                                ? fs::path(graphPath).parent_path() / parts->before
                                : (fs::path(graphPath).parent_path() / parts->before).parent_path();
    const std::string stem = parts->before.substr(parts->before.rfind('/') + 1);
    std::error_code failure;
    fs::directory_iterator each(within.empty() ? fs::path(".") : within, failure);
    for (; !failure && each != fs::directory_iterator(); each.increment(failure)) {
        const std::string name = each->path().filename().string();
        if (name.size() <= stem.size() + parts->after.size() || !name.starts_with(stem) ||
            !name.ends_with(parts->after))
            continue;
        const std::string_view digits =
            std::string_view(name).substr(stem.size(), name.size() - stem.size() - parts->after.size());
        if (digits.find_first_not_of("0123456789") != digits.npos || digits.size() > 18) continue;
        const long number = Scanner::numberIn<long>(digits).value_or(0);
        if (fs::path(made.path(number)).filename() == name) made.numbers.push_back(number);
    }
    if (made.numbers.empty())
        return fileProblem(path, kParticleFile,
                           "has no files: check the path, and write as many # as its numbers have digits");
    std::ranges::sort(made.numbers);
    const std::size_t looked = std::min(made.numbers.size(), kLookedInto);
    glm::vec3 lo(INFINITY), hi(-INFINITY);
    for (const char c : path) made.hash = mixed(made.hash, static_cast<unsigned char>(c));
    for (const long number : made.numbers) made.hash = mixed(made.hash, uint64_t(number));
    for (std::size_t i = 0; i < looked; ++i) {
        const std::size_t at = looked == 1 ? 0 : i * (made.numbers.size() - 1) / (looked - 1);
        const Result<ParticlePlacesPtr> places = readParticlePlaces(graphPath, made.path(made.numbers[at]));
        if (!places) return places.error();
        if (i == 0) made.file = (*places)->file;
        for (const glm::vec3& p : (*places)->places) lo = glm::min(lo, p), hi = glm::max(hi, p);
        made.hash = mixed(made.hash, (*places)->hash);
    }
    made.bounds = {{lo.x, lo.y, lo.z}, {hi.x, hi.y, hi.z}};
    return std::make_shared<const ParticleSequence>(std::move(made));
}

}  // namespace fw
