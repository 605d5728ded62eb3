#include "graph/nodes/node_types.h"

#include <iterator>

namespace fw {
namespace {

std::vector<NodeType> gatherNodeTypes() {
    std::vector<NodeType> all;
    for (auto family :
         {shapeNodes, shape2dNodes, partNodes, latticeNodes, splineNodes, combineNodes, domainNodes,
          fieldNodes, mathsNodes, materialNodes, meshNodes, stageNodes, particleNodes}) {
        std::vector<NodeType> nodes = family();
        std::move(nodes.begin(), nodes.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace

const std::vector<NodeType>& nodeTypes() {
    static const std::vector<NodeType> types = gatherNodeTypes();
    return types;
}

}  // namespace fw
