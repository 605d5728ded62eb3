// The JSON Schema of graph files, generated from the node library, for editors that complete and check JSON.
//
// It says what the reader (json.h) accepts and of check() what a schema can: node types, input names, the
// kind and range of values. Names that must exist, types that must meet and cycles are beyond it.
#pragma once

#include <string>

namespace fw {

/// The schema (draft 2020-12) as the text of graph/field.schema.json.
std::string fileSchema();

}  // namespace fw
