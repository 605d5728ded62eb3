#include "editor/viewport/pick.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "editor/document/edits.h"
#include "editor/document/paths.h"
#include "editor/preview/pinned.h"
#include "graph/bounds/region.h"
#include "graph/compile/compile.h"
#include "graph/document/sockets.h"
#include "graph/document/timeline.h"
#include "graph/evaluate/tape.h"
#include "runtime/particles/particle_fields.h"
#include "runtime/render/view.h"

namespace fw::editor {

namespace {

constexpr int kHalvings = 13;  // of the ray's way through the region: finer than a pixel sees it
constexpr int kRefinings = 30;

/// Behind the nodes that begin a surface, offsets.
class Probes {
  public:
    explicit Probes(Graph graph_) : probed(std::move(graph_)) {
        const Graph plain = probed;
        const Groups groups(plain);
        probe(Scope(groups, plain.nodes, nullptr), probed.nodes, "");
        for (std::size_t i = 0; i < plain.groups.size(); ++i)
            probe(Scope(groups, plain.groups[i].nodes, &groups.list[i]), probed.groups[i].nodes,
                  plain.groups[i].id);
        for (const auto& [scope, offsets] : inner)
            for (const auto& [offset, node] : offsets) {
                const std::vector<std::string> live = instancesOf(probed, scope, offset + ".distance"),
                                               nodes = instancesOf(probed, scope, node);
                for (std::size_t i = 0; i < live.size(); ++i) paths[live[i]] = nodes[i];
            }
    }

    const Graph& graph() const { return probed; }
    std::set<std::string> live() const {
        std::set<std::string> names;
        for (const auto& [parameter, path] : paths) names.insert(parameter);
        return names;
    }
    /// Of the node whose offset this live parameter is.
    const std::string& path(const std::string& parameter) const { return paths.at(parameter); }

  private:
    static bool isSurface(const std::optional<Socket>& socket) {
        return socket && (socket->type == Type::surface || socket->type == Type::mesh);
    }

    /// The output that feeds an input, reroutes passed over.
    static const Link* source(const Scope& scope, const InputValue& value) {
        const Link* link = std::get_if<Link>(&value.value);
        while (link) {
            const auto found = scope.byId.find(link->node);
            if (found == scope.byId.end()) return nullptr;
            if (!scope.is(found->second, NodeRole::reroute)) return link;
            const InputValue* fed = scope.nodes[found->second].input("value");
            link = fed ? std::get_if<Link>(&fed->value) : nullptr;
        }
        return nullptr;
    }

    /// Whether a surface passes through this link into this input.
    static bool carriesSurface(const Scope& scope, uint32_t into, const std::string& name, const Link& link) {
        return isSurface(outputSocket(scope, scope.byId.at(link.node), link.output)) ||
               isSurface(inputSocket(scope, into, name));
    }

    void probe(const Scope& scope, std::vector<Node>& nodes, const std::string& inScope) {
        std::set<std::string> fed;  // with a surface
        const auto eachSurface = [&](auto visit) {
            for (uint32_t i = 0; i < scope.nodes.size(); ++i) {
                if (!hasKnownSockets(scope, i) || scope.is(i, NodeRole::reroute)) continue;
                for (const auto& [name, value] : scope.nodes[i].inputs)
                    if (const Link* link = source(scope, value);
                        link && hasKnownSockets(scope, scope.byId.at(link->node)) &&
                        carriesSurface(scope, i, name, *link))
                        visit(i, name, *link);
            }
        };
        eachSurface([&](uint32_t i, const std::string&, const Link&) { fed.insert(scope.nodes[i].id); });
        FreshIds fresh(scope.nodes);
        std::map<std::pair<std::string, std::string>, std::string> offsets;  // by output
        eachSurface([&](uint32_t i, const std::string& name, const Link& link) {
            const uint32_t from = scope.byId.at(link.node);
            if (fed.contains(link.node) || scope.is(from, NodeRole::group) ||
                scope.is(from, NodeRole::groupInput))
                return;
            std::string& offset = offsets[{link.node, link.output}];
            if (offset.empty()) {
                offset = fresh.next("probe");
                Node node;
                node.id = offset, node.type = "offset";
                node.set("surface", {.value = link});
                node.set("distance", {.value = 0.0});
                nodes.push_back(std::move(node));
                inner[inScope].emplace_back(offset, link.node);
            }
            nodes[i].set(name, {.value = Link{offset, ""}});
        });
    }

    Graph probed;
    std::map<std::string, std::vector<std::pair<std::string, std::string>>> inner;  // by scope: offset, node
    std::map<std::string, std::string> paths;  // of nodes, by live parameter
};

struct Ray {
    glm::dvec3 origin, direction;
    glm::dvec3 at(double t) const { return origin + t * direction; }
};

Ray rayThrough(const Seen& seen, double x, double y) {
    const gpu::View view = cameraView(seen.camera, {}, float(seen.aspect));
    return {view.eye, glm::dvec3(view.forward) + x * glm::dvec3(view.right) + y * glm::dvec3(view.up)};
}

/// Where the ray goes through the box; none if it misses it.
std::optional<std::pair<double, double>> within(const Box& box, const Ray& ray) {
    double from = 0.0, to = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t i = std::size_t(axis);
        const double a = (box.lo[i] - ray.origin[axis]) / ray.direction[axis],
                     b = (box.hi[i] - ray.origin[axis]) / ray.direction[axis];
        if (std::isnan(a) || std::isnan(b)) return std::nullopt;
        from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
    }
    if (from >= to) return std::nullopt;
    return std::pair(from, to);
}

/// The field along a ray.
class Along {
  public:
    explicit Along(const Ray& ray_) : ray(ray_) {}

    /// Where between the two the field is negative first.
    std::optional<double> hit(const Tape& tape, double from, double to, int halvings = kHalvings) {
        const glm::dvec3 a = ray.at(from), b = ray.at(to), lo = glm::min(a, b), hi = glm::max(a, b);
        const Interval range = machine.interval(tape, {{lo.x, lo.y, lo.z}, {hi.x, hi.y, hi.z}});
        if (range.lo >= 0.0) return std::nullopt;
        const Tape shorter = machine.shortens() ? machine.shortenedForSigns(tape) : Tape();
        const Tape& inside = machine.shortens() ? shorter : tape;
        if (halvings == 0) {
            if (value(inside, to) >= 0.0) return std::nullopt;
            for (int i = 0; i < kRefinings; ++i) {
                const double middle = 0.5 * (from + to);
                (value(inside, middle) < 0.0 ? to : from) = middle;
            }
            return to;
        }
        const double middle = 0.5 * (from + to);
        const std::optional<double> first = hit(inside, from, middle, halvings - 1);
        return first ? first : hit(inside, middle, to, halvings - 1);
    }

  private:
    double value(const Tape& tape, double t) {
        const glm::dvec3 p = ray.at(t);
        for (int axis = 0; axis < 3; ++axis) *machine.position(axis) = p[axis];
        return *machine.value(tape, 1);
    }

    TapeMachine<double> machine;
    const Ray& ray;
};

/// The derivatives of the root at a point by each parameter, backwards from the root.
std::vector<double> slopesByParameter(const Ir& ir, IrId root, std::span<const double> parameters,
                                      const glm::dvec3& point) {
    std::vector<double> values(root + 1), slopes(root + 1), byParameter(parameters.size());
    for (IrId id = 0; id <= root; ++id) {
        const IrNode& node = ir[id];
        const OpInfo& info = opInfo(node.op);
        double operands[kMaxArity];
        for (int i = 0; i < info.arity; ++i) operands[i] = values[node.operands[std::size_t(i)]];
        values[id] = id < 3                     ? point[int(id)]
                     : node.op == Op::parameter ? parameters[std::size_t(node.number)]
                     : info.arity == 0          ? node.number
                                                : info.value(operands, ir.layer(node));
    }
    slopes[root] = 1.0;
    for (IrId id = root + 1; id-- > 0;) {
        const IrNode& node = ir[id];
        const OpInfo& info = opInfo(node.op);
        if (node.op == Op::parameter) byParameter[std::size_t(node.number)] += slopes[id];
        if (slopes[id] == 0.0 || info.arity == 0) continue;
        // A batch of directions, each along one operand, gives the partial derivatives.
        double operands[kMaxArity][kMaxArity] = {}, directions[kMaxArity][kMaxArity] = {}, results[kMaxArity],
               partial[kMaxArity];
        const double *values_[kMaxArity], *directions_[kMaxArity];
        for (int i = 0; i < kMaxArity; ++i) {
            const std::size_t operand = std::size_t(i < info.arity ? i : 0);
            std::fill_n(operands[i], kMaxArity, values[node.operands[operand]]);
            directions[i][i] = i < info.arity ? 1.0 : 0.0;
            values_[i] = operands[i], directions_[i] = directions[i], results[i] = values[id];
        }
        opKernels<double>()[std::size_t(node.op)]->slopes[0](values_, results, directions_, partial,
                                                             std::size_t(info.arity), ir.layer(node));
        for (int i = 0; i < info.arity; ++i)
            if (partial[i] != 0.0 && std::isfinite(partial[i]))
                slopes[node.operands[std::size_t(i)]] += slopes[id] * partial[i];
    }
    return byParameter;
}

}  // namespace

Graph shownAt(const Graph& graph, const std::string& pinned, double& seconds) {
    Graph shown = showingNode(graph, pinned);
    const Result<Timeline> timeline = readTimeline(shown);
    if (!timeline) return shown;
    seconds = timelineTime(*timeline, seconds);
    return atTime(shown, *timeline, seconds);
}

struct Picker::Probed {
    Probes probes;
    std::optional<Program> program;  ///< none if the graph has errors
    std::vector<double> parameters;
    Tape tape;
};

Picker::Picker() = default;
Picker::~Picker() = default;

const Picker::Probed& Picker::probedOf(const Seen& seen) {
    if (probed && asked.graph == seen.graph && asked.revision == seen.revision &&
        asked.pinned == seen.pinned && asked.seconds == seen.seconds && asked.particles == seen.particles)
        return *probed;
    double seconds = seen.seconds;
    probed = std::make_unique<Probed>(Probes(shownAt(*seen.graph, seen.pinned, seconds)));
    asked = seen;
    CompileOptions options;
    options.live = probed->probes.live();
    options.time = seconds;
    options.bake = boxInPlace;  // what is seen was measured, and is remembered
    options.finest = kLeastFieldResolution;
    Result<Program> program = compile(probed->probes.graph(), options);
    if (!program) return *probed;
    useParticles(*program, seen.particles);
    probed->parameters = program->parameters();
    probed->tape = makeTape(program->ir, program->distance(), probed->parameters);
    probed->program = std::move(*program);
    return *probed;
}

const Tape* Picker::field(const Seen& seen) {
    const Probed& known = probedOf(seen);
    return known.program ? &known.tape : nullptr;
}

std::optional<Point> Picker::hit(const Seen& seen, double x, double y) {
    const Ray ray = rayThrough(seen, x, y);
    const auto part = within(seen.region, ray);
    const Tape* tape = part ? field(seen) : nullptr;
    if (!tape) return std::nullopt;
    const auto t = Along(ray).hit(*tape, part->first, part->second);
    if (!t) return std::nullopt;
    const glm::dvec3 at = ray.at(*t);
    return Point{at.x, at.y, at.z};
}

std::string Picker::pick(const Seen& seen, double x, double y) {
    const std::optional<Point> at = hit(seen, x, y);
    if (!at) return {};
    const auto& [probes, program, parameters, tape] = probedOf(seen);
    const std::vector<double> slopes =
        slopesByParameter(program->ir, program->distance(), parameters, {(*at)[0], (*at)[1], (*at)[2]});
    const auto most = std::ranges::max_element(slopes, {}, [](double slope) { return std::abs(slope); });
    if (most == slopes.end() || *most == 0.0) return {};
    return probes.path(program->live[std::size_t(most - slopes.begin())].name);
}

std::optional<Box> solidOf(const Graph& graph, const std::string& node, double seconds) {
    const Result<Program> program =
        compile(shownAt(graph, node, seconds),
                {.time = seconds, .bake = boxInPlace, .finest = kLeastFieldResolution});
    if (!program) return std::nullopt;
    const Region region = findRegion(*program);
    return region.extent == Extent::bounded ? std::optional(region.box) : std::nullopt;
}

}  // namespace fw::editor
