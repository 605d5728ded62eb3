#include "graph/ir/ir.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdio>

namespace fw {

namespace {

constexpr IrId kNone = ~IrId{0};

uint64_t mix(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * 0x9E3779B97F4A7C15ull;
    return hash ^ (hash >> 32);
}

}  // namespace

std::size_t Ir::KeyHash::operator()(const Key& key) const {
    uint64_t hash = mix(static_cast<uint64_t>(key.op) + 1, key.bits);
    for (IrId operand : key.operands) hash = mix(hash, operand);
    return key.origin == 0 ? hash : mix(hash, key.origin);
}

Ir::Ir() {
    for (Op op : {Op::positionX, Op::positionY, Op::positionZ}) {
        const auto axis = static_cast<uint8_t>(op) - static_cast<uint8_t>(Op::positionX);
        intern({op, static_cast<uint8_t>(1 << axis), true, {}, 0.0});
    }
}

IrId Ir::intern(const IrNode& node) {
    const Key key{node.op, node.operands, std::bit_cast<uint64_t>(node.number),
                  apart && opInfo(node.op).arity > 0 ? origin_ : 0};
    const auto [entry, isNew] = known.try_emplace(key, static_cast<IrId>(nodes.size()));
    if (isNew) nodes.push_back(node), origins.push_back(origin_);
    return entry->second;
}

IrId Ir::constant(double value) {
    return intern({Op::constant, 0, false, {}, value == 0.0 ? 0.0 : value});  // -0 and 0 are one constant
}

IrId Ir::parameter(uint32_t slot) { return intern({Op::parameter, 0, true, {}, static_cast<double>(slot)}); }

IrId Ir::collect(Op op, IrId a, IrId b) {
    struct Multiple {
        IrId of;
        double factor;
    };
    const auto multiple = [&](IrId x) -> Multiple {
        const IrNode& node = nodes[x];
        if (node.op == Op::negate) return {node.operands[0], -1.0};
        if (node.op == Op::multiply)
            for (int i : {0, 1})
                if (isConstant(node.operands[i])) return {node.operands[1 - i], number(node.operands[i])};
        return {x, 1.0};
    };
    const auto times = [&](IrId x, double factor) {
        const bool isFloat =
            factor == 0.0 || (std::abs(factor) > 1.0 / kMaxFactor && std::abs(factor) < kMaxFactor);
        return isFloat ? add(Op::multiply, x, constant(factor)) : kNone;
    };
    const Multiple x = multiple(a), y = multiple(b);
    if (op == Op::multiply) {
        if (isConstant(b))
            return x.of != a && x.factor * number(b) != 0.0 ? times(x.of, x.factor * number(b)) : kNone;
        if (isConstant(a)) return collect(op, b, a);
        return x.factor == -1.0 && y.factor == -1.0 ? add(op, x.of, y.of) : kNone;
    }
    if (x.of == y.of) return times(x.of, op == Op::add ? x.factor + y.factor : x.factor - y.factor);
    const IrNode sum = nodes[b];  // of c - (d + z), c - (z - d), c - (d - z)
    if (op == Op::add || !isConstant(a) || (sum.op != Op::add && sum.op != Op::subtract)) return kNone;
    for (int i : {0, 1}) {
        const IrId other = sum.operands[1 - i];
        if (!isConstant(sum.operands[i])) continue;
        const bool back = sum.op == Op::subtract && i == 0;
        const double rest =
            number(a) + (sum.op == Op::subtract && i == 1 ? 1.0 : -1.0) * number(sum.operands[i]);
        if (!std::isfinite(rest)) return kNone;
        return back ? add(Op::add, other, constant(rest)) : add(Op::subtract, constant(rest), other);
    }
    return kNone;
}

IrId Ir::simplify(Op op, std::span<const IrId> operands) {
    const auto is = [&](int i, double value) { return isConstant(operands[i], value); };
    const auto made = [&](int i, Op by) { return nodes[operands[i]].op == by; };
    const auto inner = [&](int i, int j) { return nodes[operands[i]].operands[j]; };
    const auto opposite = [&](IrId x, IrId y) {
        return (nodes[x].op == Op::logicalNot && nodes[x].operands[0] == y) ||
               (nodes[y].op == Op::logicalNot && nodes[y].operands[0] == x);
    };
    const IrId a = operands[0], b = operands.size() > 1 ? operands[1] : 0;
    // x + c, where x is itself a sum with a constant, as one sum: chains of translations stay short.
    const auto shifted = [&](IrId x, double by) -> IrId {
        const IrNode node = nodes[x];
        if (node.op != Op::add && node.op != Op::subtract) return kNone;
        const double sign = node.op == Op::add ? 1.0 : -1.0;
        for (int i : {0, 1}) {
            if (!isConstant(node.operands[i]) || (i == 0 && node.op == Op::subtract)) continue;
            const double sum = sign * number(node.operands[i]) + by;
            if (!std::isfinite(sum)) return kNone;
            return sum < 0.0 ? add(Op::subtract, node.operands[1 - i], constant(-sum))
                             : add(Op::add, node.operands[1 - i], constant(sum));
        }
        return kNone;
    };
    switch (op) {
        case Op::negate:
            if (made(0, Op::negate)) return inner(0, 0);
            if (made(0, Op::subtract)) return add(Op::subtract, inner(0, 1), inner(0, 0));
            if (made(0, Op::multiply)) return collect(Op::multiply, a, constant(-1.0));
            break;
        case Op::absolute:
            if (made(0, Op::absolute) || made(0, Op::square) || made(0, Op::squareRoot)) return a;
            if (made(0, Op::negate)) return add(Op::absolute, inner(0, 0));
            break;
        case Op::square:
            if (made(0, Op::absolute) || made(0, Op::negate)) return add(Op::square, inner(0, 0));
            break;
        case Op::squareRoot:
            if (made(0, Op::square)) return add(Op::absolute, inner(0, 0));
            break;
        case Op::logicalNot:
            if (made(0, Op::logicalNot)) return inner(0, 0);
            break;
        case Op::add:
            if (is(0, 0.0)) return b;
            if (is(1, 0.0)) return a;
            if (made(1, Op::negate)) return add(Op::subtract, a, inner(1, 0));
            if (made(0, Op::negate)) return add(Op::subtract, b, inner(0, 0));
            for (int i : {0, 1})
                if (isConstant(operands[i]))
                    if (const IrId moved = shifted(operands[1 - i], number(operands[i])); moved != kNone)
                        return moved;
            return collect(op, a, b);
        case Op::subtract:
            if (a == b) return constant(0.0);
            if (is(1, 0.0)) return a;
            if (is(0, 0.0)) return add(Op::negate, b);
            if (made(1, Op::negate)) return add(Op::add, a, inner(1, 0));
            if (isConstant(b))
                if (const IrId moved = shifted(a, -number(b)); moved != kNone) return moved;
            return collect(op, a, b);
        case Op::multiply:
            if (a == b) return add(Op::square, a);
            for (int i : {0, 1}) {
                const IrId other = operands[1 - i];
                // (x y) y as x y^2: an even power is known to be positive.
                for (int j : {0, 1})
                    if (made(i, Op::multiply) && inner(i, j) == other && !isConstant(other))
                        return add(Op::multiply, inner(i, 1 - j), add(Op::square, other));
                if (is(i, 0.0)) return constant(0.0);
                if (is(i, 1.0)) return other;
                if (is(i, -1.0)) return add(Op::negate, other);
            }
            return collect(op, a, b);
        case Op::divide:
            if (is(1, 1.0)) return a;
            if (is(1, -1.0)) return add(Op::negate, a);
            if (isConstant(b) && std::isfinite(1.0 / number(b)))
                return add(Op::multiply, a, constant(1.0 / number(b)));
            if (is(0, 0.0)) return a;
            break;
        case Op::minimum:
        case Op::maximum: {
            if (a == b) return a;
            const Op dual = op == Op::minimum ? Op::maximum : Op::minimum;
            for (int i : {0, 1}) {
                const IrId other = operands[1 - i];
                if (made(i, Op::negate) && inner(i, 0) == other) {
                    const IrId size = add(Op::absolute, other);
                    return op == Op::maximum ? size : add(Op::negate, size);
                }
                if (made(i, dual) && (inner(i, 0) == other || inner(i, 1) == other)) return other;
                if (made(i, op) && (inner(i, 0) == other || inner(i, 1) == other)) return operands[i];
            }
            break;
        }
        case Op::power:
            if (is(1, 1.0) && (made(0, Op::absolute) || made(0, Op::square))) return a;
            if (is(1, 0.0)) return constant(1.0);
            break;
        case Op::less:
            if (a == b) return constant(0.0);
            break;
        case Op::lessEqual:
        case Op::equal:
            if (a == b) return constant(1.0);
            break;
        case Op::logicalAnd:
            if (opposite(a, b)) return constant(0.0);
            if (a == b || is(1, 1.0) || is(0, 0.0)) return a;
            if (is(0, 1.0) || is(1, 0.0)) return b;
            break;
        case Op::logicalOr:
            if (opposite(a, b)) return constant(1.0);
            if (made(0, Op::logicalAnd) && made(1, Op::logicalAnd))  // (c and x) or (c and not x)
                for (int i : {0, 1})
                    for (int j : {0, 1})
                        if (inner(0, i) == inner(1, j) && opposite(inner(0, 1 - i), inner(1, 1 - j)))
                            return inner(0, i);
            if (a == b || is(1, 0.0) || is(0, 1.0)) return a;
            if (is(0, 0.0) || is(1, 1.0)) return b;
            break;
        case Op::smoothMinimum:
            if (isConstant(operands[2]) && number(operands[2]) <= 0.0) return add(Op::minimum, a, b);
            break;
        case Op::select: {
            const IrId c = operands[2];
            if (isConstant(a)) return number(a) != 0.0 ? b : c;
            if (b == c) return b;
            if (made(0, Op::logicalNot)) return add(Op::select, inner(0, 0), c, b);
            if (made(1, Op::select) && inner(1, 0) == a) return add(Op::select, a, inner(1, 1), c);
            if (made(2, Op::select) && inner(2, 0) == a) return add(Op::select, a, b, inner(2, 2));
            break;
        }
        default: break;
    }
    return kNone;
}

namespace {

/// The number of `item` in the list, which it joins if it is new.
template <class Item>
uint32_t placeIn(std::vector<Item>& list, const Item& item) {
    const auto found = std::ranges::find(list, item);
    if (found != list.end()) return static_cast<uint32_t>(found - list.begin());
    list.push_back(item);
    return static_cast<uint32_t>(list.size() - 1);
}

}  // namespace

uint32_t Ir::addImage(const FieldImagePtr& image) { return placeIn(pictures, image); }

IrId Ir::sample(uint32_t image, int channel, IrId u, IrId v) {
    assert(image < pictures.size() && channel >= 0 && channel < kImageLayers);
    return make(Op::image, double(image) * kImageLayers + channel, std::array{u, v});
}

uint32_t Ir::addVolume(const FieldVolumePtr& volume) { return placeIn(grids, volume); }

void Ir::replaceVolume(std::size_t number, FieldVolumePtr volume) {
    assert(volume->particles && grids[number]->particles);
    grids[number] = std::move(volume);
}

IrId Ir::sample(uint32_t volume, VolumeChannel channel, std::array<IrId, 3> place) {
    assert(volume < grids.size());
    return make(Op::volume, double(volume * kVolumeLayers + uint32_t(channel)), place);
}

uint32_t Ir::addOutline(const OutlinePtr& outline) { return placeIn(polygons, outline); }

IrId Ir::sample(uint32_t outline, IrId x, IrId y) {
    assert(outline < polygons.size());
    return make(Op::outline, double(outline), std::array{x, y});
}

uint32_t Ir::addSpline(const SplineTablePtr& spline) { return placeIn(curves, spline); }

IrId Ir::sample(uint32_t spline, SplineChannel channel, std::array<IrId, 3> place) {
    assert(spline < curves.size());
    return make(Op::spline, double(spline * kSplineChannels + uint32_t(channel)), place);
}

SampledLayer Ir::layer(const IrNode& node) const {
    const auto number = static_cast<std::size_t>(node.number);
    SampledLayer layer;
    if (node.op == Op::image) layer.image = &pictures[number / kImageLayers]->layers[number % kImageLayers];
    if (node.op == Op::volume) layer.volume = &grids[number / kVolumeLayers]->layers[number % kVolumeLayers];
    if (node.op == Op::outline) layer.outline = polygons[number].get();
    if (node.op == Op::spline) {
        layer.spline = curves[number / kSplineChannels].get();
        layer.channel = SplineChannel(number % kSplineChannels);
    }
    return layer;
}

IrId Ir::add(Op op, std::span<const IrId> operands) {
    assert(!samplesLayer(op));  // sample() knows of which
    return make(op, 0.0, operands);
}

IrId Ir::make(Op op, double own, std::span<const IrId> operands) {
    const OpInfo& info = opInfo(op);
    assert(static_cast<int>(operands.size()) == info.arity);

    bool allConstant = true;
    double values[kMaxArity] = {};
    for (std::size_t i = 0; i < operands.size(); ++i) {
        allConstant &= isConstant(operands[i]);
        values[i] = number(operands[i]);
    }
    if (allConstant) return constant(info.value(values, layer({op, 0, false, {}, own})));
    if (const IrId simpler = simplify(op, operands); simpler != kNone) return simpler;
    std::array<IrId, kMaxArity> ordered{};
    std::ranges::copy(operands, ordered.begin());
    if (info.commutative && ordered[0] > ordered[1]) std::swap(ordered[0], ordered[1]);
    return addAsIs(op, own, std::span(ordered).first(operands.size()));
}

IrId Ir::addAsIs(Op op, double own, std::span<const IrId> operands) {
    IrNode node{op, 0, op == Op::column, {}, own};
    std::ranges::copy(operands, node.operands.begin());
    for (const IrId operand : operands) {
        node.positions |= nodes[operand].positions;
        node.varies |= nodes[operand].varies;
    }
    return intern(node);
}

IrId Ir::substitute(IrId root, std::array<IrId, 3> position) {
    if (position == std::array<IrId, 3>{0, 1, 2} || nodes[root].positions == 0) return root;
    // What is remembered saves work, not correctness: it may go when it takes tens of megabytes.
    if (remembered > 500'000) substitutions.clear(), remembered = 0;
    auto& done = substitutions[Key{Op::count, {position[0], position[1], position[2], 0}, 0}];
    const auto find = [&](IrId id) -> IrId {
        if (id < 3) return position[id];
        if (nodes[id].positions == 0) return id;
        const auto known_ = done.find(id);
        return known_ == done.end() ? kNone : known_->second;
    };
    const uint32_t asker = origin_;
    std::vector<IrId> pending{root};
    while (!pending.empty()) {
        const IrId id = pending.back();
        if (find(id) != kNone) {
            pending.pop_back();
            continue;
        }
        const IrNode node = nodes[id];
        const int arity = opInfo(node.op).arity;
        std::array<IrId, kMaxArity> operands{};
        bool ready = true;
        for (int i = 0; i < arity; ++i) {
            operands[i] = find(node.operands[i]);
            if (operands[i] == kNone) pending.push_back(node.operands[i]), ready = false;
        }
        if (!ready) continue;
        pending.pop_back();
        setOrigin(origins[id]);
        done[id] = make(node.op, node.number, std::span<const IrId>(operands.data(), arity));
        ++remembered, ++visited;
    }
    setOrigin(asker);
    return find(root);
}

Ir Ir::compact(std::span<IrId> roots) const {
    std::vector<bool> needed(nodes.size(), false);
    for (IrId root : roots) needed[root] = true;
    for (IrId id = static_cast<IrId>(nodes.size()); id-- > 0;)
        if (needed[id])
            for (int i = 0; i < opInfo(nodes[id].op).arity; ++i) needed[nodes[id].operands[i]] = true;

    Ir result;
    std::vector<IrId> renumbered(nodes.size(), kNone);
    for (IrId id = 0; id < nodes.size(); ++id) {
        if (id >= 3 && !needed[id]) continue;
        IrNode node = nodes[id];
        if (node.op == Op::image) {
            const auto number_ = static_cast<std::size_t>(node.number);
            const uint32_t image = result.addImage(pictures[number_ / kImageLayers]);
            node.number = double(image) * kImageLayers + double(number_ % kImageLayers);
        }
        if (node.op == Op::volume) {
            const auto number_ = static_cast<std::size_t>(node.number);
            const uint32_t volume = result.addVolume(grids[number_ / kVolumeLayers]);
            node.number = double(volume) * kVolumeLayers + double(number_ % kVolumeLayers);
        }
        if (node.op == Op::outline)
            node.number = double(result.addOutline(polygons[static_cast<std::size_t>(node.number)]));
        if (node.op == Op::spline) {
            const auto number_ = static_cast<std::size_t>(node.number);
            const uint32_t spline = result.addSpline(curves[number_ / kSplineChannels]);
            node.number = double(spline) * kSplineChannels + double(number_ % kSplineChannels);
        }
        for (int i = 0; i < opInfo(node.op).arity; ++i) node.operands[i] = renumbered[node.operands[i]];
        result.setOrigin(origins[id]);
        renumbered[id] = result.intern(node);
        if (apart && result.origins[renumbered[id]] != origins[id])
            result.further[renumbered[id]].push_back(origins[id]);
    }
    for (IrId& root : roots) root = renumbered[root];
    return result;
}

uint64_t Ir::hash(std::span<const IrId> roots) const {
    uint64_t hash = 0xF1E1D;
    for (const IrNode& node : nodes) {
        hash = mix(mix(hash, static_cast<uint64_t>(node.op)), std::bit_cast<uint64_t>(node.number));
        for (int i = 0; i < opInfo(node.op).arity; ++i) hash = mix(hash, node.operands[i]);
    }
    for (const FieldImagePtr& image : pictures) hash = mix(hash, image->hash);
    for (const FieldVolumePtr& volume : grids) hash = mix(hash, volume->hash);
    for (const OutlinePtr& outline : polygons) hash = mix(hash, outline->hash);
    for (const SplineTablePtr& spline : curves) hash = mix(hash, spline->hash);
    for (IrId root : roots) hash = mix(hash, root);
    return hash;
}

std::string Ir::text(std::span<const IrId> roots) const {
    std::string text;
    char number[32];
    for (IrId id = 0; id < nodes.size(); ++id) {
        const IrNode& node = nodes[id];
        text += "%" + std::to_string(id) + " = " + opInfo(node.op).name;
        if (ownsNumber(node.op)) {
            std::snprintf(number, sizeof number, " %.17g", node.number);
            text += number;
        }
        for (int i = 0; i < opInfo(node.op).arity; ++i) text += " %" + std::to_string(node.operands[i]);
        text += '\n';
    }
    text += "return";
    for (IrId root : roots) text += " %" + std::to_string(root);
    return text + '\n';
}

}  // namespace fw
