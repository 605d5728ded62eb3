#include "graph/ir/families.h"

#include <algorithm>
#include <optional>
#include <span>

namespace fw {

namespace {

// A loop pays, in the device's time and the compiler's, from so many members and operations of all of them
// on.
constexpr std::size_t kLeastMembers = 6, kLeastOperations = 240;
constexpr std::size_t kLeastSteps = 4;      // of a member: less is not worth a load
constexpr std::size_t kMostSteps = 400;     // bounds the search as well
constexpr std::size_t kLinkSteps = 8;       // what a smooth minimum counts as
constexpr std::size_t kMostFamilies = 256;  // about: each has a list at every place

uint64_t mixed(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 29;
}

bool isFold(Op op) { return op == Op::minimum || op == Op::maximum; }

/// A member walked from its root: what it does, with places in place of ids, and what it does it with.
struct Walk {
    std::vector<uint64_t> key;                      // equal for members that are alike
    std::vector<IrId> steps;                        // by place
    std::vector<std::pair<IrId, int>> constantsOf;  // step and operand of each constant met
    std::vector<double> constants;
};

class Finder {
  public:
    Finder(const Ir& ir_, IrId root_)
        : ir(ir_), root(root_), users(ir.size()), shapes(ir.size()), closed(ir.size()) {
        std::vector<bool> needed(ir.size());
        needed[root] = true;
        for (IrId id = root + 1; id-- > 0;)
            for (int i = 0; needed[id] && i < opInfo(ir[id].op).arity; ++i) {
                needed[ir[id].operands[i]] = true;
                ++users[ir[id].operands[i]];
            }
        for (IrId id = 0; id <= root; ++id)
            if (needed[id]) shapes[id] = shapeOf(id);
        for (IrId id = 0; id <= root; ++id)
            if (needed[id] && (isFold(ir[id].op) || isLink(id))) folds.push_back(id);
    }

    Families run() {
        for (auto fold = folds.rbegin(); fold != folds.rend(); ++fold) {
            if (closed[*fold] || found.all.size() >= kMostFamilies) continue;
            if (isLink(*fold)) {
                chain(*fold);
                continue;
            }
            std::vector<IrId> operands;
            flatten(*fold, ir[*fold].op, operands);
            if (operands.size() >= kLeastMembers) group(*fold, operands);
        }
        return std::move(found);
    }

  private:
    /// Equal for the same operations on any numbers.
    uint64_t shapeOf(IrId id) const {
        const IrNode& node = ir[id];
        uint64_t hash = mixed(0, uint64_t(node.op));
        if (ownsNumber(node.op) && node.op != Op::constant) hash = mixed(hash, uint64_t(node.number));
        uint64_t of[kMaxArity] = {};
        const int arity = opInfo(node.op).arity;
        for (int i = 0; i < arity; ++i) of[i] = shapes[node.operands[i]];
        if (opInfo(node.op).commutative && of[1] < of[0]) std::swap(of[0], of[1]);
        for (int i = 0; i < arity; ++i) hash = mixed(hash, of[i]);
        return hash;
    }

    /// The operands of a minimum of minima, in order. One that something else uses too stays an operand.
    void flatten(IrId fold, Op op, std::vector<IrId>& operands) {
        std::vector<IrId> open{fold};
        while (!open.empty()) {
            const IrId id = open.back();
            open.pop_back();
            if (id == fold || (ir[id].op == op && users[id] == 1)) {
                closed[id] = true;
                open.push_back(ir[id].operands[1]);
                open.push_back(ir[id].operands[0]);
            } else {
                operands.push_back(id);
            }
        }
    }

    /// A smooth minimum of two values that vary, with one width everywhere.
    bool isLink(IrId id) const { return ir[id].op == Op::smoothMinimum && ir.isConstant(ir[id].operands[2]); }

    /// The families in a chain of smooth minima that ends with this one.
    void chain(IrId last) {
        std::vector<IrId> links, members;  // in order
        IrId start = last;
        while (isLink(start) && (start == last || users[start] == 1)) {
            const auto goesOn = [&](int i) {
                const IrId operand = ir[start].operands[i];
                return isLink(operand) && users[operand] == 1;
            };
            const int carried = !goesOn(0) && goesOn(1) ? 1 : 0;
            closed[start] = true;
            links.push_back(start);
            members.push_back(ir[start].operands[1 - carried]);
            start = ir[start].operands[carried];
        }
        std::ranges::reverse(links);
        std::ranges::reverse(members);
        for (std::size_t first = 0, end; first < links.size(); first = end) {
            std::vector<std::pair<IrId, Walk>> run;
            for (end = first; end < links.size() && shapes[members[end]] == shapes[members[first]]; ++end) {
                std::optional<Walk> way = walk(members[end]);
                if (!way || (!run.empty() && way->key != run[0].second.key)) break;
                run.emplace_back(members[end], std::move(*way));
            }
            end = std::max(end, first + 1);
            if (run.size() < kLeastMembers) continue;
            std::optional<Family> family = familyOf(run, std::span(links).subspan(first, run.size()));
            if (!family) continue;
            for (const auto& [id, way] : run) close(id);
            const IrId before = first == 0 ? start : links[first - 1];
            found.groups.emplace(links[end - 1],
                                 FamilyGroup{Op::smoothMinimum, {uint32_t(found.all.size())}, {before}});
            found.all.push_back(std::move(*family));
        }
    }

    /// Nothing for a member of too many operations.
    std::optional<Walk> walk(IrId member) const {
        Walk result;
        std::map<IrId, uint64_t> places;
        struct Visit {
            IrId id;
            bool done;
        };
        std::vector<Visit> open{{member, false}};
        while (!open.empty()) {
            const auto [id, operandsDone] = open.back();
            open.pop_back();
            if (places.contains(id)) continue;
            const IrNode& node = ir[id];
            const int arity = opInfo(node.op).arity;
            int order[kMaxArity] = {0, 1, 2, 3};
            if (opInfo(node.op).commutative && shapes[node.operands[1]] < shapes[node.operands[0]])
                std::swap(order[0], order[1]);
            if (!operandsDone && arity > 0) {
                open.push_back({id, true});
                for (int i = arity; i-- > 0;)
                    if (!ir.isConstant(node.operands[order[i]]))
                        open.push_back({node.operands[order[i]], false});
                continue;
            }
            if (result.steps.size() == kMostSteps) return std::nullopt;
            result.key.push_back(uint64_t(node.op));
            if (ownsNumber(node.op) && node.op != Op::constant) result.key.push_back(uint64_t(node.number));
            for (int i = 0; i < arity; ++i) {
                const IrId operand = node.operands[order[i]];
                if (ir.isConstant(operand)) {
                    result.key.push_back(~uint64_t(0));
                    result.constantsOf.emplace_back(id, order[i]);
                    result.constants.push_back(ir.number(operand));
                } else {
                    result.key.push_back(places[operand]);
                }
            }
            places.emplace(id, result.steps.size());
            result.steps.push_back(id);
        }
        return result;
    }

    void group(IrId fold, const std::vector<IrId>& operands) {
        std::map<uint64_t, std::size_t> alike;
        for (IrId id : operands) ++alike[shapes[id]];
        std::map<std::vector<uint64_t>, std::vector<std::pair<IrId, Walk>>> walks;
        for (IrId id : operands) {
            if (alike[shapes[id]] < kLeastMembers) continue;
            if (std::optional<Walk> way = walk(id)) walks[way->key].emplace_back(id, std::move(*way));
        }
        std::vector<bool> member(ir.size());
        FamilyGroup result{ir[fold].op, {}, {}};
        // In the order of their first members, so that equal graphs give equal code.
        std::vector<const std::vector<std::pair<IrId, Walk>>*> inOrder;
        for (const auto& [key, of] : walks) inOrder.push_back(&of);
        std::ranges::sort(inOrder, {}, [](const auto* of) { return of->front().first; });
        for (const auto* of : inOrder) {
            if (of->size() < kLeastMembers) continue;
            std::optional<Family> family = familyOf(*of);
            if (!family) continue;
            for (const auto& [id, way] : *of) member[id] = true, close(id);
            result.families.push_back(uint32_t(found.all.size()));
            found.all.push_back(std::move(*family));
        }
        if (result.families.empty()) return;
        for (IrId id : operands)
            if (!member[id]) result.others.push_back(id);
        found.groups.emplace(fold, std::move(result));
    }

    /// `links` are the smooth minima of a chain, a member each.
    std::optional<Family> familyOf(const std::vector<std::pair<IrId, Walk>>& of,
                                   std::span<const IrId> links = {}) const {
        const Walk& first = of.front().second;
        Family family;
        family.members = uint32_t(of.size());
        std::vector<bool> own(ir.size());
        for (std::size_t i = 0; i < first.steps.size(); ++i) {
            const IrId id = first.steps[i];
            const bool shared =
                std::ranges::all_of(of, [&](const auto& m) { return m.second.steps[i] == id; });
            if (shared || opInfo(ir[id].op).arity == 0) continue;
            own[id] = true;
            family.steps.push_back(id);
        }
        const std::size_t operations = family.steps.size() + (links.empty() ? 0 : kLinkSteps);
        if (family.steps.size() < kLeastSteps || operations * of.size() < kLeastOperations)
            return std::nullopt;
        std::vector<std::vector<float>> columns;
        const auto addColumn = [&](std::pair<IrId, int> operand, std::vector<float> column) {
            if (std::ranges::all_of(column, [&](float x) { return x == column[0]; })) return;
            auto same = std::ranges::find(columns, column);
            family.columns.emplace(operand, uint32_t(same - columns.begin()));
            if (same == columns.end()) columns.push_back(std::move(column));
        };
        for (std::size_t i = 0; i < first.constants.size(); ++i) {
            if (!own[first.constantsOf[i].first]) continue;
            std::vector<float> column;
            for (const auto& [id, way] : of) column.push_back(float(way.constants[i]));
            addColumn(first.constantsOf[i], std::move(column));
        }
        if (!links.empty()) {
            family.link = links[0];
            std::vector<float> widths;
            for (IrId link : links) widths.push_back(float(ir.number(ir[link].operands[2])));
            addColumn({family.link, 2}, std::move(widths));
        }
        while (columns.size() % kTexel > 0) columns.emplace_back(of.size());
        family.width = uint32_t(columns.size());
        for (uint32_t row = 0; row < family.members; ++row)
            for (const std::vector<float>& column : columns) family.table.push_back(column[row]);
        for (IrId id : family.steps)
            for (int i = 0; i < opInfo(ir[id].op).arity; ++i) {
                const IrId operand = ir[id].operands[i];
                if (own[operand] || ir.isConstant(operand)) continue;
                if (std::ranges::find(family.inputs, operand) == family.inputs.end())
                    family.inputs.push_back(operand);
            }
        return family;
    }

    /// Loops are not nested: what members need has no families of its own.
    void close(IrId member) {
        std::vector<IrId> open{member};
        while (!open.empty()) {
            const IrId id = open.back();
            open.pop_back();
            if (closed[id]) continue;
            closed[id] = true;
            for (int i = 0; i < opInfo(ir[id].op).arity; ++i) open.push_back(ir[id].operands[i]);
        }
    }

    const Ir& ir;
    const IrId root;
    std::vector<uint32_t> users;
    std::vector<uint64_t> shapes;
    std::vector<IrId> folds;
    std::vector<bool> closed;  // minima and links that are part of a larger one, and what members need
    Families found;
};

}  // namespace

Families findFamilies(const Ir& ir, IrId root) { return Finder(ir, root).run(); }

}  // namespace fw
