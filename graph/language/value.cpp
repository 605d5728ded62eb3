#include "graph/language/value.h"

namespace fw::language {

Value constantValue(Lowering& state, Type type, std::span<const double> numbers) {
    Value value{type};
    for (int i = 0; i < componentCount(type); ++i)
        value.ids[i] = state.ir.constant(i < static_cast<int>(numbers.size()) ? numbers[i]
                                         : numbers.empty()                    ? 0.0
                                                                              : numbers.back());
    return value;
}

Value emptySurface(Lowering& state) {
    Value value{Type::surface};
    value.ids[0] = state.ir.constant(kEmptyDistance);
    for (std::size_t i = 0; i < kDefaultMaterial.size(); ++i)
        value.ids[i + 1] = state.ir.constant(kDefaultMaterial[i]);
    return value;
}

void leaveOpaquePart(Lowering& state, Value& surface) {
    if (surface.type != Type::surface) return;
    const IrId transmission = surface.ids[transmissionComponent];
    if (state.ir.isConstant(transmission, 0.0)) return;
    const IrId nothing = state.ir.constant(kEmptyDistance);
    IrId& distance = surface.ids[distanceComponent];
    distance = state.ir.isConstant(transmission)
                   ? nothing
                   : state.ir.add(Op::select, state.ir.add(Op::less, state.ir.constant(0.0), transmission),
                                  nothing, distance);
}

Value defaultValue(Lowering& state, const InputSpec& input) {
    Value value{input.type};
    switch (input.value.kind) {
        case InputDefault::Kind::position:
            for (int i = 0; i < componentCount(input.type); ++i) value.ids[i] = state.ir.position(i);
            return value;
        case InputDefault::Kind::text:
            value.text = input.value.text;
            if (input.type == Type::image) value.image = state.ir.addImage(plainImage());
            return value;
        case InputDefault::Kind::numbers:
            if (entrySize(input.type) > 0) {
                value.points = std::make_shared<const std::vector<double>>(input.value.numbers);
                return value;
            }
            return constantValue(state, input.type, input.value.numbers);
        case InputDefault::Kind::none: break;
    }
    if (input.type == Type::surface) return emptySurface(state);
    if (entrySize(input.type) > 0) value.points = std::make_shared<const std::vector<double>>();
    return componentCount(input.type) > 0 ? constantValue(state, input.type, {}) : value;
}

namespace {

/// The image of a path, read at its first use.
Result<uint32_t> imageAt(Lowering& state, const std::string& path) {
    if (path.empty()) return state.ir.addImage(plainImage());
    const auto known = state.images.find(path);
    if (known != state.images.end()) return state.ir.addImage(known->second);
    const Result<FieldImagePtr> image = readImage(state.graphPath, path);
    if (!image) return image.error();
    std::size_t texels = (*image)->texels.size();
    for (const FieldImagePtr& held : state.ir.images())
        if (held != *image) texels += held->texels.size();
    if (texels * sizeof(uint32_t) >= kMaxImageBytes) {
        return Error{.message = "the pictures of the graph together take " +
                                std::to_string(kMaxImageBytes >> 20) +
                                " MiB or more (4 bytes a pixel): use smaller ones"};
    }
    state.images.emplace(path, *image);
    return state.ir.addImage(*image);
}

}  // namespace

bool standsFor(Type from, Type to) {
    if (from == to) return true;
    if (from == Type::boolean) return false;
    if (to == Type::integer) return from == Type::scalar;
    if (to == Type::image) return from == Type::string;
    return converts(from, to);
}

Result<Value> convert(Lowering& state, const Value& value, Type type) {
    if (value.type == type) return value;
    Value result{type};
    if (value.type == Type::string && type == Type::image) {
        const Result<uint32_t> image = imageAt(state, value.text);
        if (!image) return image.error();
        result.text = value.text;
        result.image = *image;
        return result;
    }
    if (!converts(value.type, type) && !standsFor(value.type, type)) {
        const auto named = [](Type t) {
            const std::string name(typeName(t));
            return (name[0] == 'i' ? "an " : "a ") + name;
        };
        return Error{.message = named(value.type) + " cannot stand for " + named(type)};
    }
    IrId id = value.ids[0];
    if (value.type == Type::boolean)
        id = state.ir.add(Op::select, id, state.ir.constant(1.0), state.ir.constant(0.0));
    if (type == Type::surface) result = emptySurface(state);
    const int count = type == Type::surface ? 1 : componentCount(type);
    for (int i = 0; i < count; ++i) result.ids[i] = id;
    return result;
}

}  // namespace fw::language
