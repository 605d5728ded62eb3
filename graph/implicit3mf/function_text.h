// Operations of the IR as the nodes of an implicit function.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "graph/compile/program.h"
#include "graph/implicit3mf/package.h"

namespace fw::threemf {

/// What functions refer to, each with the number of its resource, in their order.
struct FunctionResources {
    std::vector<std::pair<const FieldVolume*, int>> meshes = {};
    std::vector<std::pair<const FieldImage*, int>> pictures = {};  ///< functions from image3d
    int next = 1;                                                  ///< a number that is free
};

class FunctionText {
  public:
    FunctionText(const Program& program, FunctionResources& resources);

    /// The nodes of an operation, and what it needs; "node.output", its value. Empty once there is a problem.
    std::string value(IrId root);

    std::string nodes;  ///< elements
    std::size_t count = 0;
    std::string problem;   ///< why it cannot be written
    std::string troubled;  ///< our node that this comes from; may be empty

  private:
    std::string made(IrId id);
    std::string node(const std::string& kind, const std::vector<std::pair<const char*, std::string>>& inputs,
                     const std::string& attributes = {});
    std::string apply(const char* kind, const std::string& a);
    std::string apply(const char* kind, const std::string& a, const std::string& b);
    std::string select(const std::string& a, const std::string& b, const std::string& less,
                       const std::string& other);
    std::string number(double value);
    std::string place(const std::string& x, const std::string& y, const std::string& z);
    std::string resource(int id);
    std::string sampled(const IrNode& node, IrId id);
    bool neverNegative(IrId id) const;
    void fail(IrId id, const std::string& what);

    const Program& program;
    FunctionResources& resources;
    std::map<IrId, std::string> known;
    std::map<double, std::string> numbers;
    std::map<int, std::string> ids;
};

}  // namespace fw::threemf
