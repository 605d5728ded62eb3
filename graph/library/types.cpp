#include "graph/library/types.h"

#include <cassert>

namespace fw {

std::string_view typeName(Type type) {
    switch (type) {
        case Type::boolean: return "bool";
        case Type::integer: return "int";
        case Type::scalar: return "float";
        case Type::vec2: return "vec2";
        case Type::vec3: return "vec3";
        case Type::surface: return "surface";
        case Type::string: return "string";
        case Type::points: return "points";
        case Type::stops: return "stops";
        case Type::knots: return "knots";
        case Type::image: return "image";
        case Type::mesh: return "mesh";
        case Type::particles: return "particles";
        case Type::spline: return "spline";
    }
    assert(!"every type has a name");
    return "";
}

std::optional<Type> typeNamed(std::string_view name) {
    for (int i = 0; i < kTypes; ++i)
        if (typeName(static_cast<Type>(i)) == name) return static_cast<Type>(i);
    return {};
}

bool converts(Type from, Type to) {
    if (from == to) return true;
    switch (to) {
        case Type::scalar: return from == Type::surface || from == Type::integer || from == Type::boolean;
        case Type::surface:
        case Type::vec2:
        case Type::vec3: return from == Type::scalar || from == Type::integer;
        default: return false;
    }
}

}  // namespace fw
