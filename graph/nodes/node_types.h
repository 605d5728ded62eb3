// The families of the node table, one file each of this folder.
#pragma once

#include "graph/library/node_type.h"

namespace fw {

std::vector<NodeType> shapeNodes();
std::vector<NodeType> shape2dNodes();
std::vector<NodeType> splineNodes();
std::vector<NodeType> partNodes();
std::vector<NodeType> latticeNodes();
std::vector<NodeType> combineNodes();
std::vector<NodeType> domainNodes();
std::vector<NodeType> fieldNodes();
std::vector<NodeType> mathsNodes();
std::vector<NodeType> materialNodes();
std::vector<NodeType> meshNodes();
std::vector<NodeType> stageNodes();
std::vector<NodeType> particleNodes();

}  // namespace fw
