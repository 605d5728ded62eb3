// What a 3MF file of the volumetric and implicit extensions holds, as it is written there.
//
// Specification: 3MF Volumetric and Implicit Extensions 0.8.0 (3MF Consortium, repository spec_volumetric,
// commit 20438638), over the Core Specification 1.3. Files in practice differ from it, and both are read:
// acos, asin, atan and atan2 for arccos, arcsin, arctan and arctan2; `function` for implicitfunction; an
// output before the nodes that it refers to; inputs with an empty ref, which stand for none.
//
// Positions are row vectors: p' = p M, the translation in the last row, also of a constmat and in
// matvecmultiplication, whose text has it the other way but whose files have not.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "graph/base/result.h"
#include "graph/implicit3mf/package.h"

namespace fw::threemf {

inline constexpr std::size_t kMostElements = 2'000'000;  ///< of XML: bounds the memory of reading it

enum class ValueType : unsigned char { scalar, vector, matrix, resource };
const char* nameOf(ValueType type);

/// An input of a function, or an output of a node.
struct Socket {
    std::string name;
    ValueType type = ValueType::scalar;
};

/// What an input is given: the output of a node, or as node `inputs` an input of the function.
struct Reference {
    std::string name;  ///< of the input
    ValueType type = ValueType::scalar;
    std::string node, output;
    bool none() const { return node.empty(); }
};

struct FunctionNode {
    std::string kind;  ///< "addition"
    std::string id, label;
    std::vector<Reference> inputs = {};
    std::vector<Socket> outputs = {};
    std::array<double, 16> numbers{};  ///< of constants; a matrix row by row
    int resource = 0;                  ///< of constresourceid

    const Reference* input(std::string_view name) const;
};

struct Function {
    int id = 0;
    std::string name = {};
    std::vector<Socket> inputs = {};
    std::vector<FunctionNode> nodes = {};  ///< in any order
    std::vector<Reference> outputs = {};
};

struct ImageStack {
    int id = 0;
    int rows = 0, columns = 0;
    std::vector<std::string> sheets = {};  ///< parts, from w = 0 on
};

enum class TileStyle : unsigned char { wrap, mirror, clamp };

struct ImageFunction {
    int id = 0, stack = 0;
    std::string name = {};
    double offset = 0.0, scale = 1.0;
    bool nearest = false;
    std::array<TileStyle, 3> tiles{};
};

/// p -> M * vec4(p, 1); its columns are the rows of the file's matrix.
using Affine = glm::dmat4x3;
inline const Affine kIdentity{1.0};

/// A function's output, of places that are brought to it.
struct FunctionUse {
    int function = 0;
    std::string channel = {};
    Affine transform = kIdentity;
};

struct LevelSet {
    FunctionUse field;
    int mesh = 0;  ///< the object that bounds it
    bool boxOnly = false;
};

struct Component {
    int object = 0;
    Affine transform = kIdentity;
};

struct Object {
    int id = 0;
    std::string name = {};
    std::vector<glm::dvec3> positions = {};  ///< of a mesh
    std::vector<uint32_t> indices = {};
    std::optional<LevelSet> levelSet = {};
    std::vector<Component> components = {};
    std::optional<glm::dvec3> color = {};  ///< linear sRGB
    int volume = 0;                        ///< volumedata; 0: none
    bool hasMesh() const { return !positions.empty(); }
};

struct Model {
    double unit = 0.001;  ///< metres
    // By their ids, which no two resources share.
    std::map<int, Function> functions = {};
    std::map<int, ImageFunction> imageFunctions = {};
    std::map<int, ImageStack> stacks = {};
    std::map<int, Object> objects = {};
    std::map<int, FunctionUse> colors = {};  ///< of volumedata
    std::vector<Component> items = {};       ///< what is built
    std::vector<std::string> left = {};      ///< what was passed over, a sentence each
};

/// The entry of that id, or nullptr.
template <class Entry>
const Entry* entry(const std::map<int, Entry>& entries, int id) {
    const auto found = entries.find(id);
    return found == entries.end() ? nullptr : &found->second;
}

/// The model of the package. The Error has a message only.
Result<Model> readModel(const Package& package);

}  // namespace fw::threemf
