// A document's field at points, as `fieldwright eval` has it.
#include <cmath>
#include <cstring>

#include "graph/base/parallel.h"
#include "runtime/serve/document.h"

namespace fw::serve {

namespace {

constexpr std::size_t kEvalPoints = 4096;     // at once, on one thread
constexpr std::size_t kMostListed = 100'000;  // points in an array rather than a blob

/// Points of an array of arrays; false if it is none.
bool readPoints(const Json* list, std::vector<Point>& points) {
    if (!list || !list->is_array() || list->size() > kMostListed) return false;
    for (const Json& entry : *list) {
        if (!entry.is_array() || entry.size() != 3) return false;
        Point& point = points.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!entry[axis].is_number()) return false;
            point[axis] = entry[axis].get<double>();
        }
    }
    return true;
}

template <class Number>
bool takePoints(const std::string& bytes, std::vector<Point>& points) {
    if (bytes.size() % (3 * sizeof(Number)) != 0) return false;
    points.resize(bytes.size() / (3 * sizeof(Number)));
    const char* at = bytes.data();
    for (Point& point : points)
        for (double& coordinate : point) {
            Number number = 0;
            std::memcpy(&number, at, sizeof number);
            at += sizeof number;
            coordinate = double(number);
        }
    return true;
}

/// Those of the request's one blob, whose shape, if it is given, is that of a list of points.
bool readPoints(const Request& request, std::vector<Point>& points) {
    if (request.blobs.size() != 1 || request.coming[0].name != "points") return false;
    const auto& [name, type, shape, bytes] = request.coming[0];
    const std::size_t size = type == "f32" ? 4 : 8;
    if (!shape.is_null() && shape != Json::array({bytes / (3 * size), 3})) return false;
    return type == "f32" ? takePoints<float>(request.blobs[0], points)
                         : type == "f64" && takePoints<double>(request.blobs[0], points);
}

/// JSON has no infinity.
Json finiteJson(double number) { return std::isfinite(number) ? Json(number + 0.0) : Json(nullptr); }

/// Distances, and gradients unless those are null, of up to `count` points.
void evaluateSome(const Tape& tape, const double* points, std::size_t count, double* distances,
                  double* gradients) {
    TapeMachine<double> machine;
    const std::size_t batch = gradients ? machine.kGradientPoints : machine.kPoints;
    for (std::size_t first = 0; first < count; first += batch) {
        const std::size_t some = std::min(batch, count - first);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double* const position = machine.position(int(axis));
            for (std::size_t k = 0; k < some; ++k) position[k] = points[3 * (first + k) + axis];
        }
        if (!gradients) {
            std::copy_n(machine.value(tape, some), some, distances + first);
            continue;
        }
        const auto [values, slopes] = machine.gradient(tape, some);
        for (std::size_t k = 0; k < some; ++k) {
            distances[first + k] = values[k];
            for (std::size_t axis = 0; axis < 3; ++axis) gradients[3 * (first + k) + axis] = slopes[axis][k];
        }
    }
}

}  // namespace

void evaluateAll(const Tape& tape, const double* points, std::size_t count, double* distances,
                 double* gradients, const std::atomic<bool>& cancelled) {
    forBlocks(count, kEvalPoints, [&](std::size_t, std::size_t first, std::size_t last) {
        if (!cancelled)
            evaluateSome(tape, points + 3 * first, last - first, distances + first,
                         gradients ? gradients + 3 * first : nullptr);
    });
}

std::variant<const Tape*, Fault> Document::field(Task& task) {
    now = &task;
    if (!tape) {
        const Result<Program> program = folded(task);
        if (task.cancelled) return cancelledFault();
        if (!program) return Fault(program.error());
        tape = makeTape(program->ir, program->distance(), program->parameters());
    }
    return &*tape;
}

Answer Document::eval(Params& params, Task& task) {
    const bool gradient = params.flag("gradient", false);
    std::vector<Point> points;
    const bool blob = params.any("blobs");
    const Json* const given = params.any("points");
    if (blob && given)
        params.refuse("points", "is given twice, as an array and as a blob: leave one out");
    else if (blob ? !readPoints(task.request, points) : !readPoints(given, points))
        params.refuse("points", "is an array of [x, y, z], " + std::to_string(kMostListed) +
                                    " at most, or a blob of that name of f32 or f64, of the shape [n, 3]");
    if (std::optional<Fault> fault = params.fault()) return *fault;
    const std::variant<const Tape*, Fault> found = field(task);
    if (const Fault* fault = std::get_if<Fault>(&found)) return *fault;
    struct Values {
        std::vector<double> distances, gradients;
    };
    const auto values = std::make_shared<Values>();
    values->distances.resize(points.size());
    if (gradient) values->gradients.resize(3 * points.size());
    evaluateAll(*std::get<const Tape*>(found), points.empty() ? nullptr : points[0].data(), points.size(),
                values->distances.data(), gradient ? values->gradients.data() : nullptr, task.cancelled);
    if (task.cancelled) return cancelledFault();
    Reply reply;
    if (!blob) {
        Json& distances = reply.result["distance"] = Json::array();
        for (const double distance : values->distances) distances.push_back(finiteJson(distance));
        if (!gradient) return reply;
        Json& list = reply.result["gradient"] = Json::array();
        for (std::size_t i = 0; i < values->gradients.size(); i += 3)
            list.push_back(
                Json::array({finiteJson(values->gradients[i]), finiteJson(values->gradients[i + 1]),
                             finiteJson(values->gradients[i + 2])}));
        return reply;
    }
    reply.blobs.push_back({"distance", "f64", {points.size()}, bytesOf(values->distances)});
    if (gradient) reply.blobs.push_back({"gradient", "f64", {points.size(), 3}, bytesOf(values->gradients)});
    reply.keeps = values;
    return reply;
}

}  // namespace fw::serve
