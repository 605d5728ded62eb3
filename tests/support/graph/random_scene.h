// Random everyday scenes: JSON text of graphs that a user could have built, the same for the same seed.
//
// A scene has two to five solids. Each is a shape of the node library, or two shapes in a local boolean, with
// up to three domain operations (transforms, repetitions, deformations, offsets). The solids are placed
// metres apart and joined by booleans, sharp or blended. Every solid is bounded by construction.
//
// Each solid has an anchor: the ball that should contain it. Anchors are estimates. Distorted distances can
// make an offset or a blend reach farther, so a search that starts from an anchor must not end there.
//
// The generator has its own random distributions and number formatting, and uses only arithmetic that IEEE
// 754 rounds correctly. So a seed gives the same text with every compiler and standard library.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "graph/base/box.h"

namespace fw::test {

/// The ball around one placed solid.
struct SceneAnchor {
    Point centre{};
    double radius = 0.0;
    std::string placement = {};  ///< the node whose `offset` is the centre
};

struct RandomScene {
    uint32_t seed = 0;
    double unit = 1.0;  ///< document units per metre: 1, or 1000 in a document in millimetres
    std::string json;
    std::vector<SceneAnchor> anchors;
};

/// A scene at rest.
RandomScene randomScene(uint32_t seed);

/// A scene with a timeline of 4 s that moves a solid and changes other inputs: twist rates, angles.
RandomScene randomMovingScene(uint32_t seed);

/// The length of a vector.
double norm(const Point& p);
/// A number as JSON text: at most seven decimals.
std::string sceneNumber(double value);
std::string sceneVector(const Point& value);

/// A random engine with portable distributions.
class SceneRandom {
  public:
    explicit SceneRandom(uint32_t seed) : engine(seed) {}
    /// A whole number from 0 to `count` - 1.
    int below(int count) { return int(engine() % uint32_t(count)); }
    double between(double low, double high) { return low + (high - low) * (engine() / 4294967296.0); }
    bool chance(double probability) { return between(0.0, 1.0) < probability; }
    /// A unit vector.
    Point direction();

  private:
    std::mt19937 engine;
};

/// A surface node of the scene, and where its solid can be.
struct ScenePart {
    std::string id;
    double reach = 0.0;  ///< farthest distance of the solid from the local origin, estimated
    /// Whether the field grows like a distance in all directions. If not, an offset or a shell could make the
    /// solid unbounded or give it parts far away.
    bool distanceLike = true;
};

/// Collects the nodes of a scene as text.
class SceneWriter {
  public:
    using Inputs = std::vector<std::pair<const char*, std::string>>;

    SceneWriter(uint32_t seed, double unitsPerMeter) : random(seed), unit(unitsPerMeter) {}

    /// Adds a node and returns its id.
    std::string add(const char* type, const Inputs& inputs, const std::string& code = "");
    static std::string link(const std::string& id) { return "{\"from\": \"" + id + "\"}"; }
    /// A random length, in metres, as text in the document's unit.
    std::string length(double low, double high) { return sceneNumber(metres(low, high)); }
    double metres(double low, double high) { return unit * random.between(low, high); }

    /// A random bounded shape about the origin.
    ScenePart shape();
    /// A random solid of revolution or polyhedron, whose distance is exact or a bound.
    ScenePart plainShape() { return random.chance(0.5) ? solidOfRevolution() : polyhedron(); }
    /// A random flat shape in the xy plane.
    ScenePart flatShape();
    /// The part after a random domain operation.
    ScenePart operation(const ScenePart& part);
    /// Two parts in a random boolean: `union` and so on, or `morph`.
    std::string combine(const std::string& type, const std::string& a, const std::string& b);

    /// Inputs that a timeline can change without making the solid larger, with two values.
    struct Animated {
        std::string node, input;
        double from, to;
    };

    SceneRandom random;
    const double unit;
    std::vector<Animated> animated;
    std::string nodes;

  private:
    ScenePart solidOfRevolution();
    ScenePart polyhedron();
    ScenePart alongSpline();
    ScenePart codeShape();
    ScenePart fromFlatShape();
    ScenePart placed(const ScenePart& part);
    ScenePart repeated(const ScenePart& part);
    ScenePart deformed(const ScenePart& part);
    ScenePart offsetPart(const ScenePart& part);
    ScenePart cut(const ScenePart& part);

    int count = 0;
};

}  // namespace fw::test
