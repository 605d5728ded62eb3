#include "graph/compile/compile.h"

#include "graph/base/words.h"
#include "graph/compile/particle_recipe.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "graph/document/input_value.h"
#include "graph/document/named_parameters.h"
#include "graph/evaluate/region.h"
#include "graph/language/lower.h"
#include "graph/library/node_type.h"
#include "graph/rules/structure.h"

namespace fw {

namespace {

using language::Value;

/// What a node gives: its outputs in order, and the class of its surface.
struct Lowered {
    std::vector<OutputSpec> outputs;
    std::vector<Value> values;
    Exactness exactness = distorted();
    std::string spoiler;
    bool failed = false;
};
using LoweredNodes = std::unordered_map<std::string, Lowered>;

/// How many cells a particle should reach at least, and reaches at most where the grid is found.
constexpr double kFewRadiusCells = 1.7, kManyRadiusCells = 8.0;

bool isSurface(const OutputSpec& output) { return output.type == Type::surface; }

/// A mesh is known by the surface that it is made from.
Type flowsAs(Type type) { return type == Type::mesh ? Type::surface : type; }

Type literalType(const InputValue& input) {
    if (std::holds_alternative<bool>(input.value)) return Type::boolean;
    if (std::holds_alternative<std::string>(input.value)) return Type::string;
    if (const auto* numbers = std::get_if<std::vector<double>>(&input.value))
        return input.pairs || numbers->size() > 3 ? Type::points
               : numbers->size() == 2             ? Type::vec2
                                                  : Type::vec3;
    return Type::scalar;
}

class Compiler {
  public:
    Compiler(const Graph& graph_, const CompileOptions& options_) : graph(graph_), options(options_) {
        state.graphPath = graph.path;
        if (options.live.contains("time")) {
            state.time = state.ir.parameter(0);
            live.push_back({"time", 0, options.time});
        } else {
            state.time = state.ir.constant(options.time);
        }
    }

    /// Lowers `targets` and what they need among `nodes`, in dependency order.
    LoweredNodes lowerAll(const std::vector<Node>& nodes, const std::string& prefix,
                          const Lowered* groupInput, const std::vector<const Node*>& targets) {
        std::unordered_map<std::string_view, const Node*> byId;
        for (const Node& node : nodes) byId[node.id] = &node;
        LoweredNodes done;
        std::vector<const Node*> pending(targets);
        while (!pending.empty()) {
            const Node* node = pending.back();
            bool ready = true;
            if (!done.contains(node->id))
                for (const auto& [name, input] : node->inputs)
                    if (const Link* link = std::get_if<Link>(&input.value))
                        if (const auto source = byId.find(link->node);
                            source != byId.end() && !done.contains(link->node))
                            pending.push_back(source->second), ready = false;
            if (!ready) continue;
            pending.pop_back();
            if (!done.contains(node->id)) {
                Lowered lowered = lower(*node, prefix, groupInput, done);
                if (std::any_of(lowered.outputs.begin(), lowered.outputs.end(), isSurface))
                    exactness[prefix + node->id] = {lowered.exactness, lowered.spoiler};
                done.emplace(node->id, std::move(lowered));
            }
        }
        return done;
    }

    /// What a group receives from an instance that gives nothing.
    Lowered defaultsOf(const Group& group) {
        Lowered inputs;
        inputs.exactness = kExact;
        for (const GroupInput& input : group.inputs) {
            inputs.outputs.push_back({input.name, flowsAs(typeNamed(input.type).value_or(Type::scalar))});
            inputs.values.push_back(
                language::defaultValue(state, {input.name, inputs.outputs.back().type, {}}));
        }
        return inputs;
    }

    const Ir& ir() const { return state.ir; }
    std::vector<Error> errors, notes;
    std::vector<LiveParameter> live;
    std::map<std::string, NodeExactness, std::less<>> exactness;
    std::vector<std::string>* canBeLive = nullptr;  ///< gets the name of every input that can be, if not null
    std::set<std::string, std::less<>> nearFields = {};  ///< particles_to_field without true distances

  private:
    void report(const Node& node, const std::string& prefix, const std::string& input, Error error) {
        errors.push_back(located(node, prefix, input, std::move(error)));
    }
    Error located(const Node& node, const std::string& prefix, const std::string& input, Error error) const {
        error.file = graph.path;
        error.node = prefix + node.id;
        error.input = input;
        const InputValue* value = input.empty() ? nullptr : node.input(input);
        const TextPosition at = error.codeLine > 0 ? node.codePlace : value ? value->at : node.place;
        error.line = at.line, error.column = at.column;
        return error;
    }

    Lowered failure(std::vector<OutputSpec> outputs) {
        Lowered result{std::move(outputs), {}, distorted(), {}, true};
        for (const OutputSpec& output : result.outputs) {
            InputSpec none{"", output.type, {}};
            result.values.push_back(language::defaultValue(state, none));
        }
        if (result.outputs.empty()) {
            result.outputs = {{"value", Type::scalar}};
            result.values = {language::constantValue(state, Type::scalar, {})};
        }
        return result;
    }

    /// The output that a link names, with the class of the node it comes from; nullptr where the source
    /// failed.
    static const Value* linked(const Link& link, const LoweredNodes& done, const Lowered** source = nullptr) {
        const auto found = done.find(link.node);
        if (found == done.end()) return nullptr;
        if (source) *source = &found->second;
        for (std::size_t i = 0; i < found->second.outputs.size(); ++i)
            if (link.output.empty() || found->second.outputs[i].name == link.output)
                return &found->second.values[i];
        return nullptr;
    }

    /// The slot of a live input's component, made at its first use.
    IrId liveComponent(const std::string& name, int component, double value) {
        for (std::size_t slot = 0; slot < live.size(); ++slot)
            if (live[slot].name == name && live[slot].component == component)
                return state.ir.parameter(static_cast<uint32_t>(slot));
        live.push_back({name, component, value});
        return state.ir.parameter(static_cast<uint32_t>(live.size() - 1));
    }

    /// The name under which this input is live; empty if it is folded.
    std::string liveName(const Node& node, const std::string& prefix, const std::string& input) const {
        if (options.live.contains(prefix + node.id + "." + input)) return prefix + node.id + "." + input;
        if (!options.liveExposed) return {};
        if (prefix.empty())
            for (const ExposedParameter& parameter : graph.parameters)
                if (parameter.node == node.id && parameter.input == input) return parameter.name;
        if (node.type == "parameter" && input == "value") {
            const InputValue* name = node.input("name");
            if (name && std::holds_alternative<std::string>(name->value))
                return std::get<std::string>(name->value);
        }
        return {};
    }

    /// The value that the file or the library gives for an input that is not linked.
    Value literal(const Node& node, const std::string& prefix, const InputSpec& spec, const InputValue* given,
                  bool folded = false) {
        Value value = language::defaultValue(state, spec);
        std::vector<double> numbers;
        if (spec.value.kind == InputDefault::Kind::numbers) numbers = spec.value.numbers;
        if (given) {
            if (const auto* number = std::get_if<double>(&given->value)) numbers = {*number};
            if (const auto* flag = std::get_if<bool>(&given->value)) numbers = {*flag ? 1.0 : 0.0};
            if (const auto* list = std::get_if<std::vector<double>>(&given->value)) numbers = *list;
        }
        const bool mayBeLive =
            (spec.type == Type::scalar || spec.type == Type::vec2 || spec.type == Type::vec3) &&
            !numbers.empty() && !folded;
        if (mayBeLive && canBeLive) canBeLive->push_back(prefix + node.id + "." + spec.name);
        const std::string name = mayBeLive ? liveName(node, prefix, spec.name) : std::string();
        if (!name.empty()) {
            // Its numbers are no constants of the program: the code is the same whatever they are.
            language::Lowering apart;
            const Value now = language::constantValue(apart, spec.type, numbers);
            for (int i = 0; i < componentCount(spec.type); ++i)
                value.ids[i] = liveComponent(name, i, apart.ir.number(now.ids[i]));
            return value;
        }
        if (given) {
            if (const auto* words = std::get_if<std::string>(&given->value)) {
                value.text = *words;
                if (spec.type == Type::image) {
                    Value path{Type::string};
                    path.text = *words;
                    if (const Result<Value> image = language::convert(state, path, Type::image))
                        value = *image;
                    else
                        report(node, prefix, spec.name, image.error());
                }
            }
            if (spec.type == Type::points)
                value.points = std::make_shared<const std::vector<double>>(numbers);
            else if (componentCount(spec.type) > 0 && !numbers.empty())
                value = spec.type == Type::surface
                            ? *language::convert(state, language::constantValue(state, Type::scalar, numbers),
                                                 Type::surface)
                            : language::constantValue(state, spec.type, numbers);
        }
        return value;
    }

    Lowered lower(const Node& node, const std::string& prefix, const Lowered* groupInput,
                  const LoweredNodes& done) {
        if (state.ir.size() > 2 * kMaxIrOperations) return failure({});
        const NodeType* type = findNodeType(node.type);
        if (!type) return failure({});
        if (type->id == "group_input") return groupInput ? *groupInput : failure({});
        if (type->id == "reroute") return passOn(node, done, nullptr);
        if (type->id == "group") return group(node, prefix, done);
        if (type->id == "expression")
            return node.muted ? passOn(node, done, nullptr) : expression(node, prefix, done);
        if (node.muted && !type->outputs.empty()) return passOn(node, done, &type->outputs);
        if (type->id == "group_output") return groupOutput(node, done);

        // A node of the library.
        Lowered result;
        result.outputs = type->outputs;
        std::vector<Value> inputs;
        bool plain = true;  // the position is the context's and no number varies over space
        bool fine = true;
        std::size_t shown = 0;  // the input that a stage passes on
        std::unordered_map<std::string_view, Exactness> classes;
        for (const InputSpec& spec : type->inputs) {
            const InputValue* given = node.input(spec.name);
            const Link* link = given ? std::get_if<Link>(&given->value) : nullptr;
            const Lowered* source = nullptr;
            const Value* from = link ? linked(*link, done, &source) : nullptr;
            const bool shape = flowsAs(spec.type) == Type::surface;
            Value value = shape ? language::emptySurface(state) : language::defaultValue(state, spec);
            if (from) {
                fine &= !source->failed;
                const Result<Value> converted = language::convert(state, *from, flowsAs(spec.type));
                if (converted) {
                    value = *converted;
                } else {
                    report(node, prefix, spec.name, converted.error());
                    fine = false;
                }
            } else if (spec.type != Type::mesh) {
                // What a simulation reads is read anew at each step.
                const bool stepped =
                    type->category == Category::particles && spec.value.kind == InputDefault::Kind::numbers;
                value = literal(node, prefix, spec, given, type->body.empty() && !stepped);
            }
            if (shape) {
                if (from) shown = inputs.size();
                classes[spec.name] = !from                         ? kExact
                                     : from->type == Type::surface ? source->exactness
                                                                   : distorted();
                if (from && result.spoiler.empty()) result.spoiler = source->spoiler;
            } else {
                const bool isPosition = spec.value.kind == InputDefault::Kind::position;
                for (int i = 0; i < componentCount(spec.type); ++i)
                    plain &= isPosition ? value.ids[i] == state.ir.position(i)
                                        : state.ir[value.ids[i]].positions == 0;
            }
            inputs.push_back(std::move(value));
        }
        if (!fine) return failure(type->outputs);

        if (type->exactness) {
            ExactnessArguments arguments;
            arguments.surface = [&](std::string_view name) {
                return classes.contains(name) ? classes[name] : kExact;
            };
            arguments.varies = [&](std::string_view name, int axis) {
                const IrId distance = inputs[inputIndex(*type, name)].ids[distanceComponent];
                return (state.ir[distance].positions >> axis & 1) != 0;
            };
            arguments.constant = [&](std::string_view name, int component) -> std::optional<double> {
                const int index = inputIndex(*type, name);
                if (index < 0 || component >= componentCount(inputs[index].type)) return std::nullopt;
                const IrId id = inputs[index].ids[component];
                return state.ir.isConstant(id) ? std::optional(state.ir.number(id)) : std::nullopt;
            };
            arguments.option = [&](std::string_view name) {
                const int index = inputIndex(*type, name);
                return index < 0 ? std::string() : inputs[index].text;
            };
            result.exactness = plain ? type->exactness(arguments) : distorted();
            const bool inputsExact = std::all_of(classes.begin(), classes.end(),
                                                 [](const auto& entry) { return entry.second.exact(); });
            if (result.exactness.exact())
                result.spoiler.clear();
            else if (inputsExact || result.spoiler.empty())
                result.spoiler = prefix + node.id;
        }
        if (type->id == "offset" && nearFields.contains(result.spoiler))
            notes.push_back(located(node, prefix, "surface",
                                    {.message = "the particles of node '" + result.spoiler +
                                                "' have distances near their surface alone, so this grows by "
                                                "more than it should: set that node's distance to true",
                                     .severity = Error::Severity::warning}));
        if (type->id == "mesh_file") return meshFile(node, prefix, *type, inputs);
        if (type->id == "mesh_to_field") return meshToField(node, prefix, *type, inputs);
        if (type->id == "particles_to_field") return particlesToField(node, prefix, *type, inputs);
        if (type->category == Category::particles) return particles(node, prefix, *type, inputs);
        if (type->body.empty()) {  // stages
            result.outputs = {{type->outputs.empty() ? "surface" : type->outputs[0].name, Type::surface}};
            result.values = {inputs.empty() ? language::emptySurface(state) : inputs[shown]};
            if (!inputs.empty() && classes.contains(type->inputs[shown].name))
                result.exactness = classes[type->inputs[shown].name];
            if (type->outputs.empty() && result.values[0].mesh && result.values[0].mesh->read)
                reportNoField(node, prefix, type->inputs[shown].name);
            if (type->outputs.empty() || type->outputs[0].type != Type::mesh) return result;
            std::optional<MeshRecipe> recipe = meshRecipe(node, prefix, *type, inputs, result.values[0]);
            if (!recipe) return failure(type->outputs);
            result.values[0].mesh = std::make_shared<const MeshRecipe>(std::move(*recipe));
            return result;
        }
        Result<std::vector<Value>> values = language::lowerNode(state, *type, std::move(inputs));
        if (!values) {
            Error error = values.error();
            error.codeLine = error.codeColumn = 0;
            report(node, prefix, "", error);
            return failure(type->outputs);
        }
        result.values = std::move(*values);
        return result;
    }

    const Value& inputOf(const NodeType& type, const std::vector<Value>& inputs,
                         std::string_view name) const {
        return inputs[static_cast<std::size_t>(inputIndex(type, name))];
    }
    /// A number that must be known when the graph is compiled. Reported, and none, if it is not.
    std::optional<double> knownNumber(const Node& node, const std::string& prefix, const NodeType& type,
                                      const std::vector<Value>& inputs, std::string_view name,
                                      int component = 0) {
        const IrId id = inputOf(type, inputs, name).ids[static_cast<std::size_t>(component)];
        if (state.ir.isConstant(id)) {
            // One that is written was checked where it stands; here one may come from a wire.
            const InputSpec& spec = type.inputs[static_cast<std::size_t>(inputIndex(type, name))];
            const double number = state.ir.number(id);
            if (spec.type != Type::integer && spec.type != Type::scalar) return number;
            const auto problem = valueProblem(spec.type, &spec, {number});
            if (!problem) return number;
            report(node, prefix, std::string(name), {.message = *problem});
            return std::nullopt;
        }
        report(node, prefix, std::string(name),
               {.message = "takes one number, known when the graph is compiled: it cannot depend on the "
                           "place, nor be live"});
        return std::nullopt;
    }

    /// A mesh from a file where one of a field is wanted.
    void reportNoField(const Node& node, const std::string& prefix, const std::string& input) {
        report(
            node, prefix, input,
            {.message = "takes a mesh that was made of a field: put mesh_to_field and polygonize behind the "
                        "mesh_file"});
    }

    Lowered meshFile(const Node& node, const std::string& prefix, const NodeType& type,
                     const std::vector<Value>& inputs) {
        const std::string& path = inputOf(type, inputs, "path").text;
        const Result<TriangleMeshPtr> mesh =
            path.empty()
                ? Error{.message =
                            "no file is named: write the path of a .glb, .gltf, .obj, .stl or .ply file"}
                : readTriangleMesh(state.graphPath, path);
        if (!mesh) {
            report(node, prefix, "path", mesh.error());
            return failure({{"mesh", Type::surface}});
        }
        Lowered result;
        result.outputs = {{"mesh", Type::surface}};
        result.values = {language::emptySurface(state)};
        result.values[0].mesh = std::make_shared<const MeshRecipe>(MeshRecipe{.read = *mesh});
        return result;
    }

    Lowered meshToField(const Node& node, const std::string& prefix, const NodeType& type,
                        const std::vector<Value>& inputs) {
        const std::shared_ptr<const MeshRecipe>& mesh = inputOf(type, inputs, "mesh").mesh;
        if (!mesh || !mesh->read) {
            report(
                node, prefix, "mesh",
                {.message = "takes a mesh from a file: connect a mesh_file node (what polygonize makes has a "
                            "field already: use that)"});
            return failure(type.outputs);
        }
        const auto resolution = knownNumber(node, prefix, type, inputs, "resolution");
        const auto margin = knownNumber(node, prefix, type, inputs, "margin");
        if (!resolution || !margin) return failure(type.outputs);
        const auto inside = std::ranges::find(kMeshInsideNames, inputOf(type, inputs, "inside").text);
        const MeshFieldRecipe recipe{.mesh = mesh->read,
                                     .resolution = static_cast<int>(*resolution),
                                     .margin = *margin,
                                     .inside = MeshInside(inside - kMeshInsideNames)};
        const Result<FieldVolumePtr> volume = meshField(recipe, options.bake);
        if (!volume) {
            report(node, prefix, "mesh", volume.error());
            return failure(type.outputs);
        }
        for (const std::string& what : (*volume)->notes)
            notes.push_back(located(
                node, prefix, "mesh",
                {.message = meshName(*mesh->read) + " " + what, .severity = Error::Severity::warning}));
        const bool flat = inputOf(type, inputs, "sampling").text == "trilinear";
        return sampled(node, prefix, type, inputs, *volume, flat ? trilinearChannel : tricubicChannel);
    }

    /// The surface of a volume at the node's input "p".
    Lowered sampled(const Node& node, const std::string& prefix, const NodeType& type,
                    const std::vector<Value>& inputs, const FieldVolumePtr& volume, VolumeChannel distance) {
        std::size_t bytes = kTexelBytes * texelCount(*volume);
        for (const FieldVolumePtr& held : state.ir.volumes())
            if (held != volume) bytes += kTexelBytes * texelCount(*held);
        if (bytes > kMostVolumeBytes) {
            report(node, prefix, "resolution",
                   {.message = "the graph's meshes and particles would take more than " +
                               std::to_string(kMostVolumeBytes >> 20) +
                               " MiB as fields: lower a resolution or take fewer"});
            return failure(type.outputs);
        }
        const uint32_t number = state.ir.addVolume(volume);
        const Value& p = inputOf(type, inputs, "p");
        const std::array<IrId, 3> place{p.ids[0], p.ids[1], p.ids[2]};
        Lowered result;
        result.outputs = type.outputs;
        result.values = {
            *language::convert(state, language::constantValue(state, Type::scalar, {}), Type::surface)};
        Value& surface = result.values[0];
        surface.ids[distanceComponent] = state.ir.sample(number, distance, place);
        if (volume->colored())
            for (int i = 0; i < 3; ++i)
                surface.ids[static_cast<std::size_t>(baseColorComponent + i)] =
                    state.ir.sample(number, VolumeChannel(redChannel + i), place);
        const bool here = place == std::array<IrId, 3>{0, 1, 2};
        result.exactness = here ? distorted(kSampledLipschitz) : distorted();
        result.spoiler = prefix + node.id;
        return result;
    }

    /// A field of its own, of the distance of a surface.
    std::shared_ptr<const Program> fieldOf(const Value& surface) {
        auto field = std::make_shared<Program>();
        field->surface =
            language::convert(state, language::constantValue(state, Type::scalar, {}), Type::surface)->ids;
        field->surface[distanceComponent] = surface.ids[distanceComponent];
        field->ir = state.ir.compact(field->surface);
        field->live = live;
        field->families = findFamilies(field->ir, field->distance());
        field->structureHash = field->ir.hash(field->surface);
        return field;
    }

    /// The inputs of a particle node as a stage of a recipe; none, reported, where a number depends on the
    /// place.
    std::optional<ParticleStage> particleStage(const Node& node, const std::string& prefix,
                                               const NodeType& type, const std::vector<Value>& inputs) {
        ParticleStage stage{.node = prefix + node.id};
        bool fine = true;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const InputSpec& spec = type.inputs[i];
            const Value& value = inputs[i];
            if (spec.value.kind == InputDefault::Kind::position) continue;
            if (spec.type == Type::surface) {
                if (state.ir.isConstant(value.id(), language::kEmptyDistance)) continue;
                const std::shared_ptr<const Program> field = fieldOf(value);
                if (std::ranges::any_of(field->ir.volumes(), [](const FieldVolumePtr& volume) {
                        return bool(volume->particles);
                    })) {
                    report(node, prefix, spec.name,
                           {.message = "cannot be a surface that particles make, for those are not known "
                                       "before: take what the particles collide with themselves"});
                    fine = false;
                }
                stage.fields[spec.name] = field;
            } else if (spec.value.kind == InputDefault::Kind::numbers) {
                std::array<IrId, 3>& ids = stage.numbers[spec.name];
                for (int k = 0; k < componentCount(spec.type); ++k) {
                    ids[std::size_t(k)] = value.ids[std::size_t(k)];
                    if (state.ir[ids[std::size_t(k)]].positions == 0) continue;
                    report(node, prefix, spec.name,
                           {.message = "takes one number for all of space: it cannot depend on the place"});
                    fine = false;
                    break;
                }
            } else if (spec.value.kind == InputDefault::Kind::text) {
                stage.words[spec.name] = value.text;
            }
        }
        return fine ? std::optional(std::move(stage)) : std::nullopt;
    }

    /// A node that gives particles: one stage more.
    Lowered particles(const Node& node, const std::string& prefix, const NodeType& type,
                      const std::vector<Value>& inputs) {
        using Kind = ParticleStage::Kind;
        std::optional<ParticleStage> stage = particleStage(node, prefix, type, inputs);
        if (!stage) return failure(type.outputs);
        ParticleRecipe recipe;
        stage->kind = type.id == "emitter"         ? Kind::emitter
                      : type.id == "particle_file" ? Kind::file
                      : type.id == "sph_fluid"     ? Kind::fluid
                                                   : Kind::dynamics;
        if (stage->kind == Kind::dynamics) {
            const Value& from = inputOf(type, inputs, "particles");
            if (!from.particles) return failure(type.outputs);
            recipe = *from.particles;
            if (recipe.stages.front().kind == Kind::fluid) {
                report(node, prefix, "particles",
                       {.message = "a fluid moves itself: give the sph_fluid its gravity and what it "
                                   "collides with"});
                return failure(type.outputs);
            }
        } else if (stage->kind == Kind::fluid) {
            if (!stage->fields.contains("source")) {
                report(node, prefix, "source",
                       {.message = "nothing is fluid: link the surface that is full of it at the start"});
                return failure(type.outputs);
            }
            std::vector<double> values;
            for (const LiveParameter& parameter : live) values.push_back(parameter.value);
            const StageNumbers numbers(state.ir, *stage, values);
            const glm::dvec3 lo = numbers.vector("tank_min"), hi = numbers.vector("tank_max");
            for (int axis = 0; axis < 3; ++axis)
                if (!(lo[axis] < hi[axis])) {
                    report(node, prefix, "tank_max",
                           {.message = "must be above tank_min along " + std::string(1, "xyz"[axis])});
                    return failure(type.outputs);
                }
        } else if (stage->kind == Kind::file) {
            const std::string& path = stage->words["path"];
            const Result<ParticlePlacesPtr> places =
                path.empty() ? Error{.message =
                                         "no file is named: write the path of a .ply, .obj, .csv, .txt "
                                         "or .xyz file"}
                             : readParticlePlaces(state.graphPath, path);
            if (!places) {
                report(node, prefix, "path", places.error());
                return failure(type.outputs);
            }
            stage->places = *places;
        }
        recipe.stages.push_back(std::move(*stage));
        Lowered result;
        result.outputs = type.outputs;
        result.values = {Value{Type::particles}};
        result.values[0].particles = std::make_shared<const ParticleRecipe>(std::move(recipe));
        return result;
    }

    Lowered particlesToField(const Node& node, const std::string& prefix, const NodeType& type,
                             const std::vector<Value>& inputs) {
        const std::optional<ParticleStage> own = particleStage(node, prefix, type, inputs);
        const Value& from = inputOf(type, inputs, "particles");
        auto resolution = knownNumber(node, prefix, type, inputs, "resolution");
        const auto margin = knownNumber(node, prefix, type, inputs, "margin");
        if (!own || !from.particles || !resolution || !margin) return failure(type.outputs);
        std::vector<double> values;
        for (const LiveParameter& parameter : live) values.push_back(parameter.value);
        Box region;
        double least = std::numeric_limits<double>::infinity(), most = 0.0;  // of the radius
        const auto lookAt = [&](bool first) {
            const double radius = StageNumbers(state.ir, *own, values).scalar("radius");
            const Box then = particleBounds(state.ir, *from.particles, values, radius);
            region = first ? then : joined(region, then);
            least = std::min(least, radius), most = std::max(most, radius);
        };
        if (options.moments.empty()) lookAt(true);
        for (std::size_t i = 0; i < options.moments.size(); ++i) {
            for (std::size_t slot = 0; slot < live.size(); ++slot) {
                const auto moving = options.moments[i].find(live[slot].name);
                if (moving != options.moments[i].end())
                    values[slot] = moving->second.at(std::size_t(live[slot].component));
            }
            lookAt(i == 0);
        }
        bool found = true;
        for (const auto& [name, corner] :
             {std::pair("region_min", &region.lo), std::pair("region_max", &region.hi)}) {
            if (!node.input(name)) continue;
            found = false;
            for (int i = 0; i < 3; ++i) {
                const auto given = knownNumber(node, prefix, type, inputs, name, i);
                if (!given) return failure(type.outputs);
                (*corner)[std::size_t(i)] = *given;
            }
        }
        for (std::size_t axis = 0; axis < 3; ++axis) region.lo[axis] -= *margin, region.hi[axis] += *margin;
        if (found)
            resolution = std::min(*resolution, std::floor(kManyRadiusCells * longestSide(region) / most));
        const Result<FieldVolumePtr> volume =
            particleVolume(state.ir, *from.particles, *own, region, static_cast<int>(*resolution));
        if (!volume) {
            report(node, prefix, found ? "particles" : "region_min", volume.error());
            return failure(type.outputs);
        }
        const double cell = (*volume)->grid.cell;
        const double enough = std::ceil(*resolution * cell * kFewRadiusCells / least);
        if (enough > *resolution)
            notes.push_back(located(
                node, prefix, "resolution",
                {.message =
                     "cells of " + shortNumber(cell) + " m are wide for particles that reach " +
                     shortNumber(least) + " m: " +
                     (enough <= kMostParticleResolution ? "raise the resolution to " + shortNumber(enough)
                                                        : "raise the radius") +
                     ", or give the grid a smaller region",
                 .severity = Error::Severity::warning}));
        if (inputOf(type, inputs, "distance").text == "near") nearFields.insert(prefix + node.id);
        return sampled(node, prefix, type, inputs, *volume, tricubicChannel);
    }

    /// How the mesh is made that a node gives which takes `from` and other `inputs`. Reported, and none, if a
    /// number is not known when the graph is compiled.
    std::optional<MeshRecipe> meshRecipe(const Node& node, const std::string& prefix, const NodeType& type,
                                         const std::vector<Value>& inputs, const Value& from) {
        bool known = true;
        const auto number = [&](std::string_view name, int component = 0) {
            const std::optional<double> found = knownNumber(node, prefix, type, inputs, name, component);
            known &= found.has_value();
            return found.value_or(0.0);
        };
        if (from.mesh && from.mesh->read && type.id != "polygonize") {
            reportNoField(node, prefix, type.inputs[0].name);
            return std::nullopt;
        }
        MeshRecipe recipe = from.mesh ? *from.mesh : MeshRecipe{};
        if (type.id == "polygonize") {
            recipe = MeshRecipe{};
            recipe.resolution = static_cast<int>(number("resolution"));
            recipe.method = meshMethod(inputOf(type, inputs, "method").text);
            if (node.input("region_min") && node.input("region_max")) {
                Box& box = recipe.region.emplace();
                for (int i = 0; i < 3; ++i)
                    box.lo[i] = number("region_min", i), box.hi[i] = number("region_max", i);
            }
        } else if (type.id == "smooth") {
            recipe.stages.push_back(
                {.kind = MeshStage::Kind::smooth, .times = static_cast<int>(number("iterations"))});
        } else if (type.id == "subdivide") {
            recipe.stages.push_back({.kind = MeshStage::Kind::subdivide,
                                     .times = static_cast<int>(number("levels")),
                                     .project = number("project") != 0.0});
        } else {
            recipe.stages.push_back({.kind = MeshStage::Kind::decimate, .error = number("error")});
        }
        return known ? std::optional(std::move(recipe)) : std::nullopt;
    }

    /// A muted node or a reroute: the first linked input that gives the first output's type, else the first
    /// input.
    Lowered passOn(const Node& node, const LoweredNodes& done, const std::vector<OutputSpec>* outputs) {
        const Lowered* source = nullptr;
        const Value* value = nullptr;
        for (const auto& [name, input] : node.inputs) {
            const Link* link = std::get_if<Link>(&input.value);
            const Lowered* candidateSource = nullptr;
            const Value* candidate = link ? linked(*link, done, &candidateSource) : nullptr;
            if (candidate &&
                (!outputs || language::convert(state, *candidate, flowsAs((*outputs)[0].type)))) {
                value = candidate, source = candidateSource;
                break;
            }
        }
        if (!value) return failure(outputs ? *outputs : std::vector<OutputSpec>{});
        Lowered result = *source;
        const Type type = outputs ? flowsAs((*outputs)[0].type) : value->type;
        result.outputs = {{outputs ? (*outputs)[0].name : "value", type}};
        result.values = {*language::convert(state, *value, type)};
        if (outputs)
            for (std::size_t i = 1; i < outputs->size(); ++i) {
                const Result<Value> other = language::convert(state, *value, flowsAs((*outputs)[i].type));
                result.outputs.push_back((*outputs)[i]);
                result.values.push_back(other ? *other
                                              : language::defaultValue(state, {"", (*outputs)[i].type, {}}));
            }
        return result;
    }

    Lowered expression(const Node& node, const std::string& prefix, const LoweredNodes& done) {
        language::Scope scope;
        scope.anyResult = true;
        scope.refusesZeroDivision = true;
        bool fine = true;
        for (const auto& [name, input] : node.inputs) {
            if (const Link* link = std::get_if<Link>(&input.value)) {
                const Lowered* source = nullptr;
                const Value* value = linked(*link, done, &source);
                fine &= value && !source->failed;
                if (value) scope.inputs.emplace_back(name, *value);
            } else {
                const InputSpec spec{name, literalType(input), {}};
                scope.inputs.emplace_back(name, literal(node, prefix, spec, &input));
            }
        }
        if (!fine) return failure({});
        Result<std::shared_ptr<const language::Tree>> tree = language::parse(node.code);
        Result<std::vector<Value>> values =
            tree ? language::lower(state, **tree, scope) : Result<std::vector<Value>>(tree.error());
        if (!values) {
            report(node, prefix, "", values.error());
            return failure({});
        }
        Lowered result;
        const Type type = values->front().type == Type::integer ? Type::scalar : values->front().type;
        values->front().type = type;
        result.outputs = {{"value", type}};
        result.values = std::move(*values);
        result.spoiler = prefix + node.id;
        return result;
    }

    Lowered group(const Node& node, const std::string& prefix, const LoweredNodes& done) {
        const Group* definition = graph.group(node.group);
        if (!definition) return failure({});
        std::vector<OutputSpec> outputs;
        for (const GroupOutput& output : definition->outputs)
            outputs.push_back({output.name, flowsAs(typeNamed(output.type).value_or(Type::scalar))});
        if (node.muted) return passOn(node, done, &outputs);

        Lowered inputs;
        inputs.exactness = kExact;
        for (const GroupInput& input : definition->inputs) {
            InputSpec spec{input.name, flowsAs(typeNamed(input.type).value_or(Type::scalar)), {}};
            const InputValue* given = node.input(input.name);
            if (!given && input.value) given = &*input.value;
            const Link* link = given ? std::get_if<Link>(&given->value) : nullptr;
            const Lowered* source = nullptr;
            Value value = language::defaultValue(state, spec);
            if (const Value* from = link ? linked(*link, done, &source) : nullptr) {
                if (source->failed) return failure(outputs);
                const Result<Value> converted = language::convert(state, *from, spec.type);
                if (!converted) {
                    report(node, prefix, input.name, converted.error());
                    return failure(outputs);
                }
                value = *converted;
                if (spec.type == Type::surface && !source->exactness.exact())
                    inputs.exactness = source->exactness, inputs.spoiler = source->spoiler;
            } else if (!link) {
                value = literal(node, prefix, spec, given);
            }
            inputs.outputs.push_back({input.name, spec.type});
            inputs.values.push_back(std::move(value));
        }
        const auto end = std::find_if(definition->nodes.begin(), definition->nodes.end(),
                                      [](const Node& n) { return n.type == "group_output"; });
        if (end == definition->nodes.end()) return failure(outputs);
        const std::string inner = prefix + node.id + "/";
        if (std::count(inner.begin(), inner.end(), '/') > kMaxNesting) return failure(outputs);
        const LoweredNodes nodes = lowerAll(definition->nodes, inner, &inputs, {&*end});
        const Lowered& last = nodes.at(end->id);

        Lowered result{outputs, {}, last.exactness, last.spoiler, last.failed};
        for (const OutputSpec& output : outputs) {
            const auto found = std::find_if(last.outputs.begin(), last.outputs.end(),
                                            [&](const OutputSpec& o) { return o.name == output.name; });
            Value value = language::defaultValue(state, {"", output.type, {}});
            if (found != last.outputs.end()) {
                const Result<Value> converted =
                    language::convert(state, last.values[found - last.outputs.begin()], output.type);
                if (converted)
                    value = *converted;
                else
                    report(node, prefix, "", converted.error());
            }
            result.values.push_back(std::move(value));
        }
        return result;
    }

    /// Gathers a group's results under the names of its outputs.
    Lowered groupOutput(const Node& node, const LoweredNodes& done) {
        Lowered result;
        result.exactness = kExact;
        for (const auto& [name, input] : node.inputs) {
            const Link* link = std::get_if<Link>(&input.value);
            const Lowered* source = nullptr;
            if (const Value* value = link ? linked(*link, done, &source) : nullptr) {
                result.outputs.push_back({name, value->type});
                result.values.push_back(*value);
                result.failed |= source->failed;
                if (value->type == Type::surface)
                    result.exactness = source->exactness, result.spoiler = source->spoiler;
            } else if (!link) {
                const InputSpec spec{name, literalType(input), {}};
                result.outputs.push_back({name, spec.type});
                result.values.push_back(literal(node, "", spec, &input));
            }
        }
        return result;
    }

    const Graph& graph;
    const CompileOptions& options;
    language::Lowering state;
};

const Node* outputNode(const Graph& graph) {
    const auto found = std::find_if(graph.nodes.begin(), graph.nodes.end(), [](const Node& node) {
        const NodeType* type = findNodeType(node.type);
        return type && type->id == "output";
    });
    return found == graph.nodes.end() ? nullptr : &*found;
}

/// How the mesh is made: by the polygonize node that it comes from, else by the output node.
void readSettings(const Node& output, const MeshRecipe& recipe, Program& program) {
    program.stages = recipe.stages;
    if (recipe.resolution > 0) {
        program.resolution = recipe.resolution;
        program.method = recipe.method;
        program.region = recipe.region;
        return;
    }
    if (const auto resolution = inputNumbers(output, "resolution"); !resolution.empty())
        program.resolution = static_cast<int>(resolution[0]);
    if (const InputValue* method = output.input("method"))
        if (const auto* name = std::get_if<std::string>(&method->value)) program.method = meshMethod(*name);
}

}  // namespace

MeshMethod meshMethod(std::string_view name) {
    return MeshMethod(std::ranges::find(kMeshMethodNames, name) - kMeshMethodNames);
}

bool Program::hasMaterial() const {
    for (int i = 0; i < 8; ++i)
        if (!ir.isConstant(surface[i + 1], kDefaultMaterial[i])) return true;
    return false;
}

std::vector<double> Program::parameters() const {
    std::vector<double> values;
    for (const LiveParameter& parameter : live) values.push_back(parameter.value);
    return values;
}

std::vector<float> Program::numbers() const {
    std::vector<float> all;
    for (const LiveParameter& parameter : live) all.push_back(static_cast<float>(parameter.value));
    for (const Family& family : families.all) all.insert(all.end(), family.table.begin(), family.table.end());
    all.resize(std::max<std::size_t>(all.size(), 1));
    return all;
}

std::optional<Type> compiledType(const Graph& graph, std::string_view group, const Link& link) {
    const Group* inside = group.empty() ? nullptr : graph.group(group);
    const std::vector<Node>& nodes = inside ? inside->nodes : graph.nodes;
    const Node* node = findNode(nodes, link.node);
    if (!node) return {};
    CompileOptions options;
    options.bake = boxInPlace;
    Compiler compiler(graph, options);
    const Lowered inputs = inside ? compiler.defaultsOf(*inside) : Lowered{};
    const LoweredNodes lowered = compiler.lowerAll(nodes, "", inside ? &inputs : nullptr, {node});
    const Lowered& made = lowered.at(node->id);
    if (made.failed) return {};
    for (const OutputSpec& output : made.outputs)
        if (link.output.empty() || output.name == link.output) return output.type;
    return {};
}

Result<Program> compile(const Graph& graph, const CompileOptions& options) {
    for (const Error& error : checkStructure(graph))
        if (error.severity == Error::Severity::error) return error;
    const Node* output = outputNode(graph);
    if (!output)
        return errorAt(graph, nullptr, "the graph has no output node: add one and connect the surface to it");

    Compiler compiler(graph, options);
    LoweredNodes lowered = compiler.lowerAll(graph.nodes, "", nullptr, {output});
    if (!compiler.errors.empty()) return compiler.errors.front();

    const Lowered& result = lowered.at(output->id);
    Program program;
    std::copy_n(result.values[0].ids.begin(), 9, program.surface.begin());
    program.ir = compiler.ir().compact(program.surface);
    program.live = std::move(compiler.live);
    if (program.ir.size() > kMaxIrOperations)
        return errorAt(graph, output,
                       "the field has more than " + std::to_string(kMaxIrOperations) +
                           " operations: use fewer nodes, copies or loops");
    if (program.ir.isConstant(program.distance()) && !std::isfinite(program.ir.number(program.distance())))
        return errorAt(graph, output, "the field is not a number anywhere: look for a division by zero");
    program.structureHash = program.ir.hash(program.surface);
    program.families = findFamilies(program.ir, program.distance());
    program.exactness = result.exactness;
    program.spoiledBy = result.spoiler;
    program.nodeExactness = std::move(compiler.exactness);
    program.notes = std::move(compiler.notes);
    readSettings(*output, result.values[0].mesh ? *result.values[0].mesh : MeshRecipe{}, program);
    return program;
}

std::vector<Error> compileErrors(const Graph& graph, const CompileOptions& options) {
    CompileOptions unmeasured = options;
    unmeasured.bake = boxInPlace;  // what it would be is of no matter
    Compiler compiler(graph, unmeasured);
    std::vector<const Node*> all;
    for (const Node& node : graph.nodes) all.push_back(&node);
    compiler.lowerAll(graph.nodes, "", nullptr, all);
    return std::move(compiler.errors);
}

Done checkLive(const Graph& graph, const CompileOptions& options) {
    std::vector<std::string> names;
    CompileOptions folded;
    folded.bake = boxInPlace;
    Compiler compiler(graph, folded);
    compiler.canBeLive = &names;
    std::vector<const Node*> all;
    for (const Node& node : graph.nodes) all.push_back(&node);
    compiler.lowerAll(graph.nodes, "", nullptr, all);
    names.push_back("time");
    for (const std::string& wish : options.live) {
        if (std::find(names.begin(), names.end(), wish) != names.end()) continue;
        const std::string near = nearestName(std::string_view(wish).substr(0, 64), names);
        std::vector<std::string> ofNode;
        for (const std::string& name : names)
            if (name.starts_with(wish.substr(0, wish.rfind('.')) + ".")) ofNode.push_back(name);
        return errorAt(graph, nullptr,
                       "there is no input " + inQuotes(wish) +
                           " that can be live: write node.input, of a number or vector that is not linked" +
                           (!near.empty()    ? "; did you mean " + inQuotes(near) + "?"
                            : ofNode.empty() ? ""
                                             : "; the node has " + listed(ofNode)));
    }
    return done();
}

}  // namespace fw
