#include "graph/ir/families.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>

#include "graph/ir/common_form.h"

namespace fw {

namespace {

// From so many members on they are listed; a loop over them pays from so many operations of all of them on.
constexpr std::size_t kListedMembers = 17, kLeastOperations = 240;
// A loop over fewer makes a sample slower, and pays where it keeps code of so much weight from a compiler.
constexpr std::size_t kLeastSaved = 900;
constexpr std::size_t kLeastSteps = 4;      // of a member: less is not worth a load
constexpr std::size_t kMostSteps = 1000;    // bounds the search as well
constexpr std::size_t kLinkSteps = 8;       // what a smooth minimum counts as
constexpr std::size_t kMostFamilies = 256;  // about: each has a list at every place

bool isFold(Op op) { return op == Op::minimum || op == Op::maximum; }

class Finder {
  public:
    Finder(Ir& ir_, IrId root) : ir(ir_), users(ir.size()), closed(ir.size()) {
        std::vector<bool> needed(ir.size());
        needed[root] = true;
        for (IrId id = root + 1; id-- > 0;)
            for (int i = 0; needed[id] && i < opInfo(ir[id].op).arity; ++i) {
                needed[ir[id].operands[i]] = true;
                ++users[ir[id].operands[i]];
            }
        likeness = likenesses(ir, needed);
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
            if (operands.size() > 1) group(*fold, operands);
        }
        sortListed();
        return std::move(found);
    }

  private:
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
    bool isLink(IrId id) const {
        return ir[id].op == Op::smoothMinimum && ir[ir[id].operands[2]].positions == 0;
    }

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
            for (end = first + 1; end < links.size() && alike(members[first], members[end]);) ++end;
            std::vector<IrId> widths;
            for (std::size_t i = first; i < end; ++i) widths.push_back(ir[links[i]].operands[2]);
            const IrId before = first == 0 ? start : links[first - 1];
            if (const std::optional<uint32_t> family =
                    familyOf({members.begin() + first, members.begin() + end}, widths))
                found.groups.emplace(links[end - 1], FamilyGroup{Op::smoothMinimum, {*family}, {before}});
        }
    }

    bool alike(IrId a, IrId b) const { return likeness[a].strict == likeness[b].strict; }

    /// Families of operands that are alike if coordinates are exchanged; of those without a form, of the
    /// operands that are more alike. In the order of their first members, so that equal graphs give equal
    /// code.
    void group(IrId fold, const std::vector<IrId>& operands) {
        FamilyGroup result{ir[fold].op, {}, {}};
        std::vector<bool> member(ir.size());
        const auto taken = [&](const std::vector<IrId>& some) {
            const std::optional<uint32_t> family = familyOf(some, {});
            if (!family) return false;
            result.families.push_back(*family);
            for (const IrId id : some) member[id] = true;
            return true;
        };
        for (const std::vector<IrId>& some : parted(operands, &Likeness::loose)) {
            if (taken(some)) continue;
            const auto parts = parted(some, &Likeness::strict);
            if (parts.size() > 1) std::ranges::for_each(parts, taken);
        }
        if (result.families.empty()) return;
        for (IrId id : operands)
            if (!member[id]) result.others.push_back(id);
        found.groups.emplace(fold, std::move(result));
    }

    /// Values of equal likeness together, in order.
    std::vector<std::vector<IrId>> parted(const std::vector<IrId>& values, uint64_t Likeness::*by) const {
        std::map<uint64_t, std::size_t> places;
        std::vector<std::vector<IrId>> parts;
        for (const IrId id : values) {
            const auto [place, isNew] = places.try_emplace(likeness[id].*by, parts.size());
            if (isNew) parts.emplace_back();
            parts[place->second].push_back(id);
        }
        return parts;
    }

    /// Adds a family of these, which are then closed; nothing if there is none that pays. `widths` are those
    /// of a chain's smooth minima.
    std::optional<uint32_t> familyOf(const std::vector<IrId>& members, const std::vector<IrId>& widths) {
        if (members.size() < 2) return std::nullopt;
        CommonFormFinder finder(ir, likeness, kMostSteps);
        if (!finder.find(members) || (!widths.empty() && !finder.find(widths))) return std::nullopt;
        const std::size_t steps = finder.size(), ofMember = steps + (widths.empty() ? 0 : kLinkSteps);
        const bool pays = members.size() >= kListedMembers
                              ? ofMember * members.size() >= kLeastOperations
                              : finder.weight() * (members.size() - 1) >= kLeastSaved;
        if (steps < kLeastSteps || !pays) return std::nullopt;
        Family family;
        family.firstColumn = columns;
        CommonForm form = finder.addTo(ir, columns);
        columns += uint32_t(form.columns.size());
        family.steps = std::move(form.steps);
        family.inputs = std::move(form.inputs);
        family.value = form.values[0];
        if (!widths.empty()) family.blend = form.values[1];
        family.members = uint32_t(members.size());
        while (form.columns.size() % kTexel > 0) form.columns.emplace_back(members.size());
        family.width = uint32_t(form.columns.size());
        for (std::size_t row = 0; row < members.size(); ++row)
            for (const std::vector<float>& column : form.columns) family.table.push_back(column[row]);
        for (const IrId member : members) close(member, family.inputs);
        found.all.push_back(std::move(family));
        return uint32_t(found.all.size() - 1);
    }

    /// Puts those families first whose members can be left out by lists.
    void sortListed() {
        std::vector<uint32_t> order(found.all.size()), place(order.size());
        std::iota(order.begin(), order.end(), 0u);
        const auto isListed = [&](uint32_t f) { return found.all[f].members >= kListedMembers; };
        const auto rest = std::stable_partition(order.begin(), order.end(), isListed);
        found.listed = uint32_t(rest - order.begin());
        std::vector<Family> all;
        for (const uint32_t f : order) {
            place[f] = uint32_t(all.size());
            all.push_back(std::move(found.all[f]));
        }
        found.all = std::move(all);
        for (auto& [id, group] : found.groups)
            for (uint32_t& f : group.families) f = place[f];
    }

    /// Loops are not nested: what a member is made from, its inputs aside, has no families of its own.
    void close(IrId member, const std::vector<IrId>& inputs) {
        std::vector<IrId> open{member};
        while (!open.empty()) {
            const IrId id = open.back();
            open.pop_back();
            if (closed[id] || std::ranges::find(inputs, id) != inputs.end()) continue;
            closed[id] = true;
            for (int i = 0; i < opInfo(ir[id].op).arity; ++i) open.push_back(ir[id].operands[i]);
        }
    }

    Ir& ir;
    std::vector<uint32_t> users;
    std::vector<Likeness> likeness;
    std::vector<IrId> folds;
    std::vector<bool> closed;  // minima and links that are part of a larger one, and what members need
    uint32_t columns = 0;      // of all families
    Families found;
};

}  // namespace

Families findFamilies(Ir& ir, IrId root) { return Finder(ir, root).run(); }

}  // namespace fw
