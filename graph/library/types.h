// The types of sockets and of values in the field language, and the class of a distance ("exactness").
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

namespace fw {

/// What flows through a socket. Those before `string` are functions of position.
enum class Type : unsigned char {
    boolean,
    integer,
    scalar,  ///< "float" in files and code
    vec2,
    vec3,
    surface,    ///< distance and material: fifteen scalars, in the order of `SurfaceComponent`
    string,     ///< an enum choice, a path or a text; known when the graph is compiled
    points,     ///< a list of vec2, known when the graph is compiled
    stops,      ///< a list of positions with a colour each, likewise
    knots,      ///< a list of places in space with a radius and a twist each, likewise
    image,      ///< the path of a picture; read when the graph is compiled (image.h)
    mesh,       ///< triangles: the result of a stage
    particles,  ///< places that move: what a simulation makes
    spline,     ///< a curve in space, known when the graph is compiled (curves/spline.h)
};
inline constexpr int kTypes = int(Type::spline) + 1;

/// Scalars of a surface.
inline constexpr int kSurfaceComponents = 15;

/// Number of scalars that represent a value of this type in the IR; 0 for all that is no function of
/// position.
constexpr int componentCount(Type type) {
    switch (type) {
        case Type::boolean:
        case Type::integer:
        case Type::scalar: return 1;
        case Type::vec2: return 2;
        case Type::vec3: return 3;
        case Type::surface: return kSurfaceComponents;
        default: return 0;
    }
}

/// Numbers of an entry of a list of this type: x and y of points; position, red, green and blue of stops; x,
/// y, z, radius and twist of knots. 0 for all that is no list.
constexpr int entrySize(Type type) {
    return type == Type::points ? 2 : type == Type::stops ? 4 : type == Type::knots ? 5 : 0;
}
/// The list whose entries have so many numbers; empty if there is none.
constexpr std::optional<Type> listOf(int entrySize) {
    if (entrySize == 2) return Type::points;
    if (entrySize == 4) return Type::stops;
    if (entrySize == 5) return Type::knots;
    return {};
}

/// "float", "vec3", "surface", …: as written in files and in code.
std::string_view typeName(Type type);
/// The type with this name; empty if there is none.
std::optional<Type> typeNamed(std::string_view name);

/// Whether what one socket gives may go into another: a surface as its distance, a number as a distance or in
/// all components of a vector, a boolean as 0 or 1.
bool converts(Type from, Type to);

/// Order of a surface's scalars.
enum SurfaceComponent {
    distanceComponent = 0,
    baseColorComponent = 1,
    roughnessComponent = 4,
    metallicComponent = 5,
    emissionComponent = 6,
    transmissionComponent = 9,
    iorComponent = 10,
    absorptionComponent = 11,
    painterComponent = 14  ///< number among Program::painters of the node that gave the material; 0: none did
};

/// The material of a surface that no material node touched: base colour, roughness, metallic, emission,
/// transmission, index of refraction, absorption (1/m); and no painter.
inline constexpr std::array<double, kSurfaceComponents - 1> kDefaultMaterial = {
    0.8, 0.8, 0.8, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 0.0};

/// How a field's value relates to the distance to its zero set (definitions: sdf.md's "exact", "bound",
/// "distorted").
///
/// exact outside/inside: |f| is the distance there. Bound: 1-Lipschitz, so |f| never exceeds the distance.
/// Distorted: the Lipschitz constant is above 1 (infinite where no constant is known).
struct Exactness {
    bool outside = true;     ///< exact where f > 0
    bool inside = true;      ///< exact where f < 0
    double lipschitz = 1.0;  ///< |f(p) - f(q)| <= lipschitz |p - q|

    bool exact() const { return outside && inside && lipschitz <= 1.0; }
    bool bound() const { return lipschitz <= 1.0; }
    bool operator==(const Exactness&) const = default;
};

inline constexpr double kUnknownLipschitz = std::numeric_limits<double>::infinity();
inline constexpr Exactness kExact{};
inline constexpr Exactness kExactOutside{true, false, 1.0};
inline constexpr Exactness kExactInside{false, true, 1.0};
inline constexpr Exactness kBound{false, false, 1.0};
constexpr Exactness distorted(double lipschitz = kUnknownLipschitz) { return {false, false, lipschitz}; }

}  // namespace fw
