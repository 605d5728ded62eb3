// A program as a 3MF file: its distance, and its colour if that varies, as one implicit function each output,
// in the box that the standard asks for about a level set.
//
// Each operation of the IR is one node or a few: all loops are unrolled there. What differs between the two
// languages is written out, so that the function read again has the same values: a condition is a number, 0
// or 1, that a select compares; halves are rounded up by floor(a + 0.5); roots and logarithms take what is
// below their range for its edge. The distance to a mesh becomes a mesh node, which is the distance itself
// and not a sampled one. Pictures, in grey, become image stacks of one sheet.
//
// What no node can do is refused, with the name of our node that it comes from: random numbers (noise, hash),
// whose hashes are whole numbers of 32 bits, outlines, pictures in colour, particles.
//
// The names of nodes are those of lib3mf and of the files that there are, acos and atan2, not arccos and
// arctan2: no program is known that reads the latter. All else is as the schemas have it, where these agree
// with the specification's own examples.
//
// The model's unit is the document's. Its z axis points up: our y becomes z, and our z becomes -y.
#pragma once

#include <string>
#include <vector>

#include "graph/base/box.h"
#include "graph/compile/program.h"
#include "graph/document/unit.h"

namespace fw {

struct Exported3mf {
    std::string bytes;
    std::vector<Error> warnings;  ///< what of the solid the file lacks
    std::size_t nodes = 0;        ///< of the function
};

/// The solid of a program without live parameters. `bounds` has all of it, in the document's coordinates.
/// Errors name the node.
Result<Exported3mf> export3mf(const Program& program, const Box& bounds, const LengthUnit& unit,
                              const std::string& name);

}  // namespace fw
