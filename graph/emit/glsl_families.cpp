#include "graph/emit/glsl_families.h"

#include <algorithm>
#include <limits>

#include "graph/emit/glsl_statements.h"

namespace fw {

namespace {

constexpr int kSamples = 9;  // of a column, which stands for nine samples of a row

/// Picks one of the samples, and begins the function of its value.
constexpr const char* kFieldPick =
    "float fieldPick(uint k, float a, float b, float c, float d, float e, float f, float g, float h, float "
    "i) "
    "{\n"
    "    return k == 0u ? a : k == 1u ? b : k == 2u ? c : k == 3u ? d : k == 4u ? e : k == 5u ? f : "
    "k == 6u ? g : k == 7u ? h : i;\n}\n"
    "float fieldAt(FieldRow row, FieldColumn column, uint k, float at) {\n";

class FamilyEmitter : GlslStatements {
  public:
    explicit FamilyEmitter(const Program& program_)
        : GlslStatements(program_),
          program(program_),
          ir(program_.ir),
          root(program_.distance()),
          needed(neededBy(std::span(&root, 1), true)) {}

    std::string run() {
        tables();
        text += "#ifdef FIELD_VALUE\n";
        valueFunction();
        text += "#endif\n#ifdef FIELD_GRADIENT\n";
        gradientFunction();
        text += "#endif\n#ifdef FIELD_INTERVAL\n#include \"lib/interval.glsl\"\n";
        intervalFunction();
        if (program.families.listed > 0) {
            text += "#ifdef FIELD_PRUNE\n";
            pruneFunction();
            text += "#endif\n";
        }
        text += "#endif\n#ifdef FIELD_ROWS\n" + along();
        rowFunctions();
        text += "#endif\n";
        return std::move(text);
    }

  private:
    bool isListed(uint32_t family) const { return family < program.families.listed; }
    bool isListed(const FamilyGroup& group) const {
        return std::ranges::any_of(group.families, [&](uint32_t f) { return isListed(f); });
    }
    static std::string number(uint32_t n) { return std::to_string(n); }
    static std::string list(uint32_t family) { return "fieldList" + number(family); }
    static bool isLess(const FamilyGroup& group) { return group.op == Op::minimum; }
    static std::string fold(const FamilyGroup& group) { return isLess(group) ? "min" : "max"; }
    static std::string limit(const FamilyGroup& group) {
        const double infinity = std::numeric_limits<double>::infinity();
        return glslLiteral(isLess(group) ? infinity : -infinity);
    }
    /// What a loop over a family begins with: `named` is the name that stands for a value.
    std::string start(const FamilyGroup& group, std::string (GlslStatements::*named)(IrId) const) const {
        return group.chain() ? (this->*named)(group.others[0]) : limit(group);
    }
    /// What `all` becomes with one member more. A minimum takes what a lane that is done repeats, a chain
    /// not.
    std::string with(const FamilyGroup& group, uint32_t family, const std::string& all,
                     const std::string& own, bool isInterval = false) const {
        if (!group.chain()) return fold(group) + "(" + all + ", " + own + ")";
        const IrId blend = program.families.all[family].blend;
        return (isListed(family) ? "i < fieldLength" + number(family) + "() ? " : "") +
               (isInterval ? "iSmoothMin(" : "fieldSmoothMin(") + all + ", " + own + ", " +
               (isInterval ? interval(blend) : value(blend)) + ")" + (isListed(family) ? " : " + all : "");
    }
    const FamilyGroup* groupAt(IrId id) const {
        const auto group = program.families.groups.find(id);
        return group == program.families.groups.end() ? nullptr : &group->second;
    }

    /// Whether the loops over a group's members are for all samples of a column.
    bool isOfColumn(IrId id, const FamilyGroup& group) const {
        return stageOf(ir[id]) == 2 && isListed(group);
    }

    void tables() {
        const std::vector<Family>& all = program.families.all;
        const uint32_t listed = program.families.listed;
        const auto binding = [](int at) { return "layout(set = 0, binding = " + std::to_string(at) + ", "; };
        const std::string ofParameters =
            "vec4 fieldTexel(uint t) {\n    uint at = " + std::to_string(program.live.size()) + "u + " +
            number(kTexel) +
            "u * t;\n    return vec4(fieldParameters[at], fieldParameters[at + 1u], fieldParameters[at + "
            "2u], "
            "fieldParameters[at + 3u]);\n}\n";
        if (listed == 0) {
            text +=
                ofParameters + "#ifdef FIELD_PRUNED\nbool fieldChoose(uint place) { return true; }\n#endif\n";
            return;
        }
        const std::string count = number(listed);
        text += "#define FIELD_FAMILIES " + count + "\n#ifdef FIELD_PRUNED\n" + binding(kFieldHeadsBinding) +
                "std430) buffer FieldHeads { uvec2 fieldHeads[]; };\n" + binding(kFieldListsBinding) +
                "std430) buffer FieldLists { uint fieldLists[]; };\n" + binding(kFieldTablesBinding) +
                "rgba32ui) readonly uniform uimageBuffer fieldTables;\n"
                "vec4 fieldTexel(uint t) { return uintBitsToFloat(imageLoad(fieldTables, int(t))); }\n";
        for (uint32_t f = 0; f < listed; ++f)
            text += "uvec2 " + list(f) + ";\nuint fieldLength" + number(f) + "() { return " + list(f) +
                    ".y; }\nuint fieldEntry" + number(f) + "(uint i) { return fieldLists[" + list(f) +
                    ".x + min(i, " + list(f) + ".y - 1u)]; }\n";
        text += "bool fieldChoose(uint place) {\n";
        for (uint32_t f = 0; f < listed; ++f)
            text += "    " + list(f) + " = fieldHeads[place * " + count + "u + " + number(f) + "u];\n";
        text += "    return " + list(0) + ".y != 0u;\n}\n#else\n" + ofParameters;
        for (uint32_t f = 0; f < listed; ++f)
            text += "uint fieldLength" + number(f) + "() { return " + number(all[f].members) +
                    "u; }\nuint fieldEntry" + number(f) + "(uint i) { return i; }\n";
        text += "#endif\n";
    }

    /// A loop over the list of a family, or all rows. A lane that is done with its own repeats the last.
    template <class Body>
    void loop(uint32_t number_, Body body) {
        const Family& family = program.families.all[number_];
        std::size_t first = 0;
        for (uint32_t f = 0; f < number_; ++f) first += program.families.all[f].table.size() / kTexel;
        text += "    {\n    uint i = 0u;\n    do {\n    uint m = " + std::to_string(first) + "u + " +
                number(family.width / kTexel) + "u * " +
                (isListed(number_) ? "fieldEntry" + number(number_) + "(i)" : "i") + ";\n";
        for (uint32_t t = 0; t < family.width / kTexel; ++t)
            text += "    vec4 t" + number(t) + " = fieldTexel(m + " + number(t) + "u);\n";
        for (uint32_t c = 0; c < family.width; ++c)
            text += "    float c" + number(family.firstColumn + c) + " = t" + number(c / kTexel) + "[" +
                    number(c % kTexel) + "];\n";
        body(family);
        text += "    } while (++i < " +
                (isListed(number_) ? "fieldLength" + number(number_) + "()" : number(family.members) + "u") +
                ");\n    }\n";
    }

    /// Defines a group's value by its families' F0, F1, …, which are there.
    void define(const FamilyGroup& group, const char* type, const std::string& name,
                std::string (GlslStatements::*named)(IrId) const) {
        std::string all;
        for (uint32_t f : group.families)
            all = all.empty() ? "F" + number(f) + suffix
                              : fold(group) + "(" + all + ", F" + number(f) + suffix + ")";
        if (!group.chain())
            for (IrId other : group.others)
                all = fold(group) + "(" + all + ", " + (this->*named)(other) + ")";
        text += std::string("    ") + type + " " + name + " = " + all + ";\n";
    }

    // ---- Value

    void valueFunction() {
        text += "float fieldValue(vec3 p) {\n";
        for (IrId id = 0; id < ir.size(); ++id) {
            if (!needed[id] || isInline(ir[id])) continue;
            if (const FamilyGroup* group = groupAt(id))
                groupValue(id, *group);
            else
                valueStatement(id);
        }
        text += "    return " + value(root) + ";\n}\n";
    }

    void groupValue(IrId id, const FamilyGroup& group) {
        for (uint32_t f : group.families) {
            const std::string best = "F" + number(f) + suffix;
            text += "    float " + best + " = " + start(group, &GlslStatements::value) + ";\n";
            loop(f, [&](const Family& family) {
                for (IrId step : family.steps) valueStatement(step);
                text += "    " + best + " = " + with(group, f, best, value(family.value)) + ";\n";
            });
        }
        define(group, "float", value(id), &GlslStatements::value);
    }

    // ---- Value with gradient

    void gradientFunction() {
        Derivatives known = noDerivatives();
        text += "vec4 fieldGradient(vec3 p) {\n";
        for (IrId id = 0; id < ir.size(); ++id) {
            if (!needed[id] || isInline(ir[id])) continue;
            if (const FamilyGroup* group = groupAt(id))
                groupGradient(id, *group, known);
            else
                gradientStatement(id, known);
        }
        text += "    return vec4(" + slopes(root, known) + ", " + value(root) + ");\n}\n";
    }

    static std::string slopes(IrId id, const Derivatives& known) {
        std::string all;
        for (int axis = 0; axis < 3; ++axis)
            all += (axis > 0 ? ", " : "") + (known[axis][id].empty() ? "0.0" : known[axis][id]);
        return all;
    }

    /// Best so far: derivatives and value, of which the first of several equal ones stays.
    void groupGradient(IrId id, const FamilyGroup& group, Derivatives& known) {
        const std::string best = "G" + std::to_string(id), closer = isLess(group) ? " < " : " > ";
        const auto whole = [&](IrId from) {
            return "vec4(" + slopes(from, known) + ", " + value(from) + ")";
        };
        const auto offer = [&](IrId from) {
            text += "    " + best + " = " + value(from) + closer + best + ".w ? " + whole(from) + " : " +
                    best + ";\n";
        };
        text += "    vec4 " + best + " = " +
                (group.chain() ? whole(group.others[0]) : "vec4(0.0, 0.0, 0.0, " + limit(group) + ")") +
                ";\n";
        for (uint32_t f : group.families)
            loop(f, [&](const Family& family) {
                for (IrId step : family.steps) gradientStatement(step, known);
                if (group.chain())
                    text += "    " + best + " = " + with(group, f, best, whole(family.value)) + ";\n";
                else
                    offer(family.value);
            });
        if (!group.chain())
            for (IrId other : group.others) offer(other);
        text += "    float " + value(id) + " = " + best + ".w;\n";
        for (int axis = 0; axis < 3; ++axis)
            if (ir[id].positions >> axis & 1) known[axis][id] = best + "." + "xyz"[axis];
    }

    // ---- Interval

    void intervalStatements() {
        for (IrId id = 0; id < ir.size(); ++id) {
            if (!needed[id] || isInline(ir[id])) continue;
            const FamilyGroup* group = groupAt(id);
            if (!group) {
                intervalStatement(id);
                continue;
            }
            for (uint32_t f : group->families) {
                const std::string all = "F" + number(f);
                text += "    vec2 " + all + " = vec2(" + start(*group, &GlslStatements::interval) + ");\n";
                loop(f, [&](const Family& family) {
                    for (IrId step : family.steps) intervalStatement(step);
                    text += "    " + all + " = " + with(*group, f, all, interval(family.value), true) + ";\n";
                });
            }
            define(*group, "vec2", interval(id), &GlslStatements::interval);
        }
    }

    void intervalFunction() {
        text += "vec2 fieldInterval(vec3 lo, vec3 hi) {\n";
        intervalStatements();
        text += "    vec3 reach = max(abs(lo), abs(hi));\n    return iMargin(" + interval(root) +
                ", reach.x + reach.y + reach.z);\n}\n";
    }

    /// The lists of a place, out of those chosen: empty ones where there is no surface, else of at least one
    /// entry, since loops run at least once.
    void pruneFunction() {
        text +=
            "void fieldPrune(vec3 lo, vec3 hi, uint place) {\n"
            "    vec3 far = max(abs(lo), abs(hi));\n    float reach = far.x + far.y + far.z;\n";
        intervalStatements();
        text += "    bool open = " + list(0) + ".y != 0u && fieldMayHold(iMargin(" + interval(root) +
                ", reach));\n";
        for (uint32_t f = 0; f < program.families.listed; ++f)
            text += "    if (!open) " + list(f) + ".y = 0u;\n";
        for (const auto& [id, group] : program.families.groups) {
            if (!isListed(group)) continue;
            if (group.chain()) {
                pruneChain(group);
                continue;
            }
            const bool less = isLess(group);
            for (uint32_t f : group.families) {
                if (!isListed(f)) continue;
                text += "    {\n    float limit = iMargin(" + interval(id) + ", reach)." +
                        (less ? "y" : "x") + ";\n    uint at = open ? fieldAllocate(" + list(f) +
                        ".y) : 0u, kept = 0u;\n";
                loop(f, [&](const Family& family) {
                    for (IrId step : family.steps) intervalStatement(step);
                    text += "    bool apart = iMargin(" + interval(family.value) + ", reach)." +
                            (less ? "x > limit" : "y < limit") + " || i >= " + list(f) + ".y;\n" +
                            "    if (!apart && at != 0u) fieldLists[at + kept] = fieldEntry" + number(f) +
                            "(i);\n    kept += apart ? 0u : 1u;\n";
                });
                endList(f);
            }
        }
        text += "}\n";
    }

    /// Members are left out that the chain up to them is below, and those before one that is below them all;
    /// the first of a list of none is one of those.
    void pruneChain(const FamilyGroup& group) {
        const uint32_t f = group.families[0];
        text += "    {\n    vec2 start = " + interval(group.others[0]) +
                ", chain = start;\n    uint at = open ? fieldAllocate(" + list(f) + ".y) : 0u, kept = 0u;\n";
        loop(f, [&](const Family& family) {
            for (IrId step : family.steps) intervalStatement(step);
            text += "    vec2 width = " + interval(family.blend) +
                    ";\n    vec2 own = " + interval(family.value) +
                    ", wide = iMargin(own, reach), before = iMargin(chain, reach);\n    bool listed = i < " +
                    list(f) +
                    ".y, apart = !listed || before.y + width.y < wide.x;\n    bool over = listed && wide.y + "
                    "width.y < min(before.x, iMargin(start, reach).x);\n    kept = over ? 0u : kept;\n    if "
                    "(!apart && at != 0u) fieldLists[at + kept] = fieldEntry" +
                    number(f) +
                    "(i);\n    kept += apart ? 0u : 1u;\n    chain = apart ? chain : over ? own : "
                    "iSmoothMin(chain, own, width);\n";
        });
        endList(f);
    }

    /// The list is what was kept, or the one it was chosen from where there was no place for it.
    void endList(uint32_t f) {
        text += "    if (kept == 0u && at != 0u) fieldLists[at] = fieldEntry" + number(f) +
                "(0u);\n    fieldHeads[place * FIELD_FAMILIES + " + number(f) +
                "u] = at != 0u ? uvec2(at, max(kept, 1u)) : " + list(f) + ";\n    }\n";
    }

    // ---- Rows

    void rowFunctions() {
        GlslStages stages(*this, program, true, [&](IrId id) {
            const FamilyGroup* group = groupAt(id);
            if (!group) return false;
            if (!isOfColumn(id, *group)) {
                groupValue(id, *group);
                return true;
            }
            for (uint32_t f : group->families) {
                text += "    float F" + number(f) + " = fieldPick(k";
                for (int k = 0; k < kSamples; ++k) text += ", column.F" + number(f) + "_" + std::to_string(k);
                text += ");\n";
            }
            define(*group, "float", value(id), &GlslStatements::value);
            return true;
        });
        stages.planeFunction();
        stages.rowFunction();
        if (program.families.listed == 0) {
            text += "float fieldAt(FieldRow row, float at) {\n";
        } else {
            columnFunction(stages);
            text += kFieldPick;
        }
        stages.unpack(1, "row");
        stages.define(2);
        text += "    return " + value(root) + ";\n}\n";
    }

    /// Nine samples at once, so that a member's numbers are loaded once for all of them.
    void columnFunction(GlslStages& stages) {
        std::vector<IrId> inputs;
        std::string members, values;
        for (const auto& [id, group] : program.families.groups) {
            if (!isOfColumn(id, group)) continue;
            if (group.chain()) inputs.push_back(group.others[0]);
            for (uint32_t f : group.families) {
                const Family& family = program.families.all[f];
                inputs.insert(inputs.end(), family.inputs.begin(), family.inputs.end());
                for (int k = 0; k < kSamples; ++k) {
                    const std::string name = "F" + number(f) + "_" + std::to_string(k);
                    members += " float " + name + ";";
                    values += ", " + name;
                }
            }
        }
        text += "struct FieldColumn { float unused;" + members +
                " };\nFieldColumn fieldColumn(FieldRow row, float at[9]) {\n";
        stages.unpack(1, "row");
        const std::vector<bool> wanted = neededBy(inputs, true);
        for (IrId id = 0; id < ir.size(); ++id) {
            if (stageOf(ir[id]) < 2) continue;
            const FamilyGroup* group = needed[id] ? groupAt(id) : nullptr;
            const bool ofColumn = group && isOfColumn(id, *group);
            if (ofColumn) columnLoops(*group);
            forSamples([&](int k) {
                if (wanted[id] && group && !ofColumn)
                    groupValue(id, *group);
                else if (wanted[id] && group)
                    define(*group, "float", value(id), &GlslStatements::value);
                else if (wanted[id])
                    valueStatement(id, ir[id].op == leafOf(2) ? "at[" + std::to_string(k) + "]"
                                                              : std::string(opInfo(ir[id].op).glsl));
            });
        }
        text += "    return FieldColumn(0.0" + values + ");\n}\n";
    }

    /// `statements` for each sample of a column, in whose names its number stands.
    template <class Statements>
    void forSamples(Statements statements) {
        for (int k = 0; k < kSamples; ++k) {
            suffix = "_" + std::to_string(k);
            statements(k);
        }
        suffix.clear();
    }

    void columnLoops(const FamilyGroup& group) {
        for (uint32_t f : group.families) {
            const auto all = [&] { return "F" + number(f) + suffix; };
            forSamples([&](int) {
                text += "    float " + all() + " = " + start(group, &GlslStatements::value) + ";\n";
            });
            loop(f, [&](const Family& family) {
                for (IrId step : family.steps)
                    if (stageOf(ir[step]) < 2) valueStatement(step);
                forSamples([&](int) {
                    for (IrId step : family.steps)
                        if (stageOf(ir[step]) == 2) valueStatement(step);
                    text += "    " + all() + " = " + with(group, f, all(), value(family.value)) + ";\n";
                });
            });
        }
    }

    const Program& program;
    const Ir& ir;
    const IrId root;
    const std::vector<bool> needed;
};

}  // namespace

std::string emitFamilies(const Program& program) { return FamilyEmitter(program).run(); }

}  // namespace fw
